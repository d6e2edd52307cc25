// Files of scene parameters, and the sidecars of baked recordings, which repeat them.

#include <fmt/format.h>

#include "sources/make_source.h"

namespace broadmark::sources::scene_parameters {

SourceKind kind() {
  return {.what = fmt::format("scene parameters (.json, \"{}\", or the .json beside a baked "
                              "recording)",
                              kSceneParametersSchema),
          .recognises =
              [](NamedSource& source) {
                return source.isJson() && (source.schema() == kSceneParametersSchema ||
                                           source.schema() == kBakeSchema);
              },
          .open = openScene};
}

}  // namespace broadmark::sources::scene_parameters
