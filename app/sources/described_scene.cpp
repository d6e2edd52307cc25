// Files that describe a scene: authored scenes, scene parameters, and sidecars of baked recordings,
// which contain scene parameters.

#include <fmt/format.h>

#include "broadmark/scenes/authored_scene.h"
#include "sources/make_source.h"

namespace broadmark::sources::described_scene {

SourceKind kind() {
  return {
      .what = fmt::format("authored scenes (.json, \"{}\"), scene parameters (.json, \"{}\", or "
                          "the .json beside a baked recording)",
                          scenes::kAuthoredSceneSchema, kSceneParametersSchema),
      .recognises =
          [](NamedSource& source) { return source.isJson() && describesScene(source.schema()); },
      .open = openScene};
}

}  // namespace broadmark::sources::described_scene
