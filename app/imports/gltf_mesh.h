// Meshes of a glTF file, without their places in the scene.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "imports/gltf_document.h"
#include "imports/mesh.h"

namespace broadmark::imports::gltf {

/// Vertices of the primitives that share their accessors.
struct VertexGroup {
  std::vector<Eigen::Vector3d> positions;
  std::vector<std::vector<Eigen::Vector3d>> targets;  ///< displacements; empty: none of this target
  std::size_t influences = 0;                         ///< joints per vertex
  std::vector<std::uint32_t> joints;                  ///< by vertex and influence
  std::vector<double> weights;                        ///< of the joints; their sum per vertex is 1
};

inline constexpr std::uint64_t kMaxVertices = (std::uint64_t{1} << 31) - 1;

struct Mesh {
  std::vector<VertexGroup> groups;
  MeshTopology topology;  ///< vertices are numbered over all groups
  std::uint64_t points = 0;
  std::vector<double> weights;  ///< of the morph targets, by default
};

/// Reads a mesh. `joints`: how many the skin has that moves it; 0: no skin. Throws InputError.
Mesh readMesh(Document& document, std::uint32_t index, std::size_t joints, ImportSummary& summary);

}  // namespace broadmark::imports::gltf
