// The boxes of a mesh's elements: its vertices, its edges, its triangles.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "broadmark/files.h"
#include "broadmark/frame.h"
#include "imports/mesh.h"
#include "request/reading_options.h"

namespace broadmark::imports {

/// A body for each element: vertices in the order of the file, then edges in the order of their
/// vertices, then triangles in the order of the file, as far as they are asked for. Elements that
/// share a vertex are not wanted as a pair, unless they are to be kept: the vertices are tags.
class ElementFrames final : public IndexedFrames {
 public:
  /// All files are the same mesh, each with the frames of its animation or only one. Throws
  /// InputError.
  ElementFrames(const std::vector<std::filesystem::path>& files, const ReadingOptions& options);

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }

 private:
  /// The numbers of its vertices, of which some may be the same one.
  using Element = std::array<std::uint32_t, 3>;

  std::span<const Aabb> readBoxes(std::uint32_t index) override;
  void readFiles(const std::vector<std::filesystem::path>& files, double frame_rate);
  void keep(std::span<const Point> points);
  void readPoints(std::uint32_t index);
  /// For files in which each triangle has vertices of its own: those at one place are one.
  void joinVertices();
  void chooseElements(const std::string& which);
  void leaveOutNeighbours();

  SceneInfo scene_;
  MeshTopology mesh_;
  std::vector<std::uint32_t> vertices_;  ///< those that count, ascending
  std::vector<Element> elements_;        ///< by body
  FileDescriptor kept_;                  ///< the vertices of all frames, one after the other
  std::uint64_t frames_ = 0;
  std::vector<Point> points_;
  std::vector<Aabb> boxes_;
};

}  // namespace broadmark::imports
