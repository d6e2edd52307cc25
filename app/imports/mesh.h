// Meshes from files: vertices that move, and triangles that keep theirs.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace broadmark::imports {

using Point = std::array<float, 3>;
using Triangle = std::array<std::uint32_t, 3>;

/// What does not change in a mesh. Vertices have the numbers that the file gives them; polygons are
/// cut into triangles.
struct MeshTopology {
  std::uint32_t vertices = 0;
  std::vector<Triangle> triangles;
};

/// Gets the vertices of one frame after the other.
using PointSink = std::function<void(std::span<const Point>)>;

// What reads a mesh from a file: the frames of its animation, or its only one. Every triangle has
// vertices that exist.

/// A Wavefront OBJ file. Assimp gives each corner of a face a vertex of its own: then no two faces
/// would share one. Throws InputError.
MeshTopology readObj(const std::filesystem::path& file, const PointSink& sink);

/// A file that assimp reads, at `frame_rate` frames per second. A child process reads it, as
/// damaged files may crash assimp or exhaust the memory. Throws InputError.
MeshTopology readWithAssimp(const std::filesystem::path& file, double frame_rate,
                            const PointSink& sink);

}  // namespace broadmark::imports
