// Animated meshes as boxes of their elements: frames of one file.

#include "imports/element_frames.h"
#include "imports/mesh_format.h"
#include "sources/source.h"

namespace broadmark::sources::gltf {

SourceKind kind() {
  return {.what = "animations (.gltf, .glb)",
          .import = FileImport{.formats = {"gltf"},
                               .extensions = {".gltf", ".glb"},
                               .options = {"elements", "keep", "frame_rate", "animation"},
                               .recognises =
                                   [](const imports::FileStart& start) {
                                     return imports::meshFormat(start) == "gltf";
                                   },
                               .open = imports::openElements}};
}

}  // namespace broadmark::sources::gltf
