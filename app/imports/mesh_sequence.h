// The meshes of a sequence of files: which files hold the same mesh, and the vertices of all
// frames.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "broadmark/aabb.h"
#include "broadmark/files.h"
#include "imports/mesh.h"
#include "request/reading_options.h"

namespace broadmark::imports {

/// A mesh that some frames hold.
struct SequenceMesh {
  MeshTopology topology;
  std::filesystem::path file;  ///< the first with this mesh
  /// The earlier mesh that this one only adds to: its vertices, triangles and lines are the first
  /// ones of this mesh.
  std::optional<std::size_t> extends = {};
  std::vector<std::uint32_t> frames = {};  ///< ascending
};

/// Files with the same topology hold the same mesh, wherever they are in the sequence. A mesh that
/// is joined by position extends no other: its vertices have no numbers of their own.
class MeshSequence {
 public:
  /// Reads all files, each with an animation or a single frame. Throws InputError.
  MeshSequence(const std::vector<std::filesystem::path>& files, const ReadingOptions&,
               ImportSummary&);

  [[nodiscard]] const std::vector<SequenceMesh>& meshes() const { return meshes_; }
  [[nodiscard]] std::uint32_t frames() const { return static_cast<std::uint32_t>(frames_.size()); }
  /// Index of the mesh of a frame.
  [[nodiscard]] std::size_t meshOf(std::uint32_t frame) const { return frames_[frame].mesh; }
  [[nodiscard]] const Aabb& world() const { return world_; }
  /// Frees the triangles and lines of all meshes.
  void forgetFaces();
  /// Reads the vertices of a frame. Throws InputError.
  void readPoints(std::uint32_t frame, std::vector<Point>& points) const;

 private:
  struct FrameLocation {
    std::size_t mesh = 0;
    std::uint64_t offset = 0;  ///< in the file of vertices
  };

  void readFile(const std::filesystem::path& file, const ReadingOptions&, ImportSummary&);
  void addFrame(std::span<const Point> points, const std::filesystem::path& file);
  std::size_t addMesh(MeshTopology mesh, const std::filesystem::path& file);

  std::vector<SequenceMesh> meshes_;
  std::size_t last_mesh_ = 0;  ///< of the file read last
  std::vector<FrameLocation> frames_;
  FileDescriptor vertex_file_;  ///< vertices of all frames, concatenated
  std::uint64_t vertex_bytes_ = 0;
  Aabb world_ = kEmptyBox;
};

}  // namespace broadmark::imports
