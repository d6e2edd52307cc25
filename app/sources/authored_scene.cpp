// Authored scenes.

#include <fmt/format.h>

#include "broadmark/scenes/authored_scene.h"
#include "sources/make_source.h"

namespace broadmark::sources::authored_scene {

SourceKind kind() {
  return {.what = fmt::format("authored scenes (.json, \"{}\")", scenes::kAuthoredSceneSchema),
          .recognises =
              [](NamedSource& source) {
                return source.isJson() && source.schema() == scenes::kAuthoredSceneSchema;
              },
          .open = openScene};
}

}  // namespace broadmark::sources::authored_scene
