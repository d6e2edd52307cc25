// Meshes as boxes of their elements: one file per frame.

#include <algorithm>

#include "imports/element_frames.h"
#include "imports/mesh_format.h"
#include "sources/source.h"

namespace broadmark::sources::meshes {

SourceKind kind() {
  static const std::vector<std::string> formats = {"ply", "obj", "stl"};
  return {.what = "meshes (.ply, .obj, .stl)",
          .import = FileImport{.formats = formats,
                               .extensions = {".ply", ".obj", ".stl"},
                               .options = {"elements", "keep"},
                               .recognises =
                                   [](const imports::FileStart& start) {
                                     return std::ranges::count(formats,
                                                               imports::meshFormat(start)) > 0;
                                   },
                               .open = imports::openElements}};
}

}  // namespace broadmark::sources::meshes
