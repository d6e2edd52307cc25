// Meshes from files: moving vertices, and triangles that do not change.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "imports/import_summary.h"

namespace broadmark::imports {

using Point = std::array<float, 3>;
using Triangle = std::array<std::uint32_t, 3>;

/// The part of a mesh that does not change. Vertices are numbered as in the file; polygons are
/// triangulated.
struct MeshTopology {
  std::uint32_t vertices = 0;
  std::vector<Triangle> triangles;
  std::vector<std::array<std::uint32_t, 2>> lines = {};  ///< edges of no face: rods, wires
};

/// Receives the vertices of each frame, in order.
using PointSink = std::function<void(std::span<const Point>)>;

// Readers of mesh files: they read all frames of an animation, or the only frame. The vertices of
// all triangles exist.

/// Reads a Wavefront OBJ file. Does not use assimp, which creates separate vertices for each corner
/// of a face, so that no two faces would share one. Throws InputError.
MeshTopology readObj(const std::filesystem::path& file, const PointSink& sink, ImportSummary&);

/// Reads a file with assimp, at `frame_rate` frames per second, in a child process, as damaged
/// files may crash assimp or exhaust the memory. Throws InputError.
MeshTopology readWithAssimp(const std::filesystem::path& file, double frame_rate,
                            const PointSink& sink, ImportSummary&);

}  // namespace broadmark::imports
