// Replaces assimp.cpp in builds without assimp.

#include <fmt/format.h>

#include "broadmark/error.h"
#include "imports/mesh.h"
#include "support/build_parts.h"

namespace broadmark::imports {

MeshTopology readWithAssimp(const std::filesystem::path& file, double, const PointSink&,
                            ImportSummary&) {
  throw InputError(fmt::format("{}: {}: only .ply, .obj and .stl can be read", file.string(),
                               leftOut(parts::kAssimp)));
}

}  // namespace broadmark::imports
