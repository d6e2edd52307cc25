// Meshes from files: moving vertices, and triangles and lines that do not change.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "imports/import_summary.h"
#include "request/reading_options.h"

namespace broadmark::imports {

using Point = std::array<float, 3>;
using Triangle = std::array<std::uint32_t, 3>;

/// The part of a mesh that does not change. Vertices are numbered as in the file; polygons are
/// triangulated.
struct MeshTopology {
  static constexpr std::uint32_t kMaxVertices = (std::uint32_t{1} << 31) - 1;

  std::uint32_t vertices = 0;
  std::vector<Triangle> triangles;
  std::vector<std::array<std::uint32_t, 2>> lines = {};  ///< edges of no face: rods, wires
  /// Each face has vertices of its own: those at the same position in all frames are one (STL).
  bool joined_by_position = false;

  /// Adds a polygon as a fan around its first corner, wherever the corners are: it is cut alike in
  /// every frame.
  void addPolygon(std::span<const std::uint32_t> corners) {
    for (std::size_t i = 2; i < corners.size(); ++i) {
      triangles.push_back({corners[0], corners[i - 1], corners[i]});
    }
  }

  friend bool operator==(const MeshTopology&, const MeshTopology&) = default;
};

/// Receives the vertices of each frame, in order.
using PointSink = std::function<void(std::span<const Point>)>;

// Readers of mesh files: they read all frames of an animation, or the only frame. The vertices of
// all triangles and lines exist. They fill an empty summary. A file may
// state that it has no vertices. Throw InputError.

/// Reads a Wavefront OBJ file.
MeshTopology readObj(const std::filesystem::path& file, const PointSink& sink, ImportSummary&);
/// Reads a PLY file, as text or binary.
MeshTopology readPly(const std::filesystem::path& file, const PointSink& sink, ImportSummary&);
/// Reads an STL file, as text or binary.
MeshTopology readStl(const std::filesystem::path& file, const PointSink& sink, ImportSummary&);

/// Reads a glTF 2.0 file, as text or binary: the meshes of its default scene, moved by its
/// animations. Vertices are those that a primitive uses, in the order of nodes, primitives and
/// accessors. `spare_bytes`: memory that the file may take beyond what its size explains. Throws
/// InputError.
MeshTopology readGltf(const std::filesystem::path& file, const ReadingOptions& options,
                      const PointSink& sink, ImportSummary&,
                      std::uint64_t spare_bytes = std::uint64_t{4} << 30);

}  // namespace broadmark::imports
