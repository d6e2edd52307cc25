// Meshes as boxes of their elements: one file per frame, or an animation in a single file.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "imports/element_frames.h"
#include "imports/mesh_format.h"
#include "sources/source.h"

namespace broadmark::sources::meshes {

SourceKind kind() {
  const std::vector<std::string> extensions = {".ply", ".obj", ".stl", ".gltf", ".glb"};
  return {.what = fmt::format("meshes and animations ({})", fmt::join(extensions, ", ")),
          .import = FileImport{.formats = {"ply", "obj", "stl", "gltf"},
                               .extensions = extensions,
                               .options = {"elements", "keep", "frame_rate", "animation"},
                               .recognises =
                                   [](const imports::FileStart& start) {
                                     return !imports::meshFormat(start).empty();
                                   },
                               .open = imports::openElements}};
}

}  // namespace broadmark::sources::meshes
