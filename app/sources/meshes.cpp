// Meshes, one file a frame or an animation in one file, as boxes of their elements.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "imports/element_frames.h"
#include "parts.h"
#include "sources/source.h"

namespace broadmark::sources::meshes {

SourceKind kind() {
  const std::vector<std::string> extensions = {".ply", ".obj", ".stl", ".gltf", ".glb"};
  // Where assimp is left out, a file that it would read is known, to say so.
  const std::string shown =
      parts::kAssimp.included ? fmt::format("{}", fmt::join(extensions, ", ")) : ".obj";
  return {.what = fmt::format("meshes and animations ({})", shown),
          .import = FileImport{.extensions = extensions,
                               .options = {"elements", "keep", "frame_rate"},
                               .open = imports::openElements}};
}

}  // namespace broadmark::sources::meshes
