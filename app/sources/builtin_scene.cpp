// Built-in scenes, by id.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "sources/make_source.h"

namespace broadmark::sources::builtin_scene {

SourceKind kind() {
  return {.what = fmt::format("built-in scenes ({})", fmt::join(sceneIds(), ", ")),
          .recognises = [](NamedSource& source) { return isSceneId(source.name()); },
          .open = openScene};
}

}  // namespace broadmark::sources::builtin_scene
