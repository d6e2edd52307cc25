#include "imports/element_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/scenes/simulation.h"
#include "imports/files.h"
#include "imports/mesh.h"
#include "imports/mesh_format.h"

namespace broadmark::imports {
namespace {

namespace fs = std::filesystem;

/// Throws InputError unless a file has the same topology as the first one.
void requireSameTopology(const MeshTopology& mesh, const fs::path& file, const MeshTopology& first,
                         const fs::path& first_file) {
  const auto require = [&](std::size_t count, std::size_t expected, const char* what) {
    if (count == expected) return;
    throw InputError(fmt::format("{}: {} {}: {} are expected, as in {}", file.string(), count, what,
                                 expected, first_file.string()));
  };
  require(mesh.vertices, first.vertices, "vertices");
  require(mesh.triangles.size(), first.triangles.size(), "triangles");
  const auto other = std::ranges::mismatch(mesh.triangles, first.triangles).in1;
  if (other == mesh.triangles.end()) return;
  throw InputError(fmt::format("{}: triangle {} has other vertices than in {}", file.string(),
                               other - mesh.triangles.begin(), first_file.string()));
}

/// Returns the edges without duplicates, sorted by their vertices.
std::vector<std::array<std::uint32_t, 2>> edgesOf(const std::vector<Triangle>& triangles) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const Triangle& triangle : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [a, b] = std::minmax(triangle[i], triangle[(i + 1) % 3]);
      if (a != b) edges.push_back({a, b});
    }
  }
  std::ranges::sort(edges);
  const auto repeated = std::ranges::unique(edges);
  edges.erase(repeated.begin(), repeated.end());
  return edges;
}

/// Object type of the bodies in recordings.
std::string typeName(std::string elements) {
  if (elements == "all") elements = "elements";
  elements.front() = static_cast<char>(elements.front() - 'a' + 'A');
  return elements;
}

class ElementFrames final : public IndexedFrames {
 public:
  ElementFrames(const std::vector<fs::path>& files, const ReadingOptions& options,
                ImportSummary& summary) {
    scene_.name = sequenceName(files);
    scene_.object_type = typeName(options.elements.value);
    scene_.world = kEmptyBox;
    readFiles(files, options, summary);
    vertices_.resize(mesh_.vertices);
    std::iota(vertices_.begin(), vertices_.end(), 0U);
    if (meshFormat(files.front(), options.format.value) == "stl") joinVertices();
    addElements(options.elements.value);
    if (elements_.empty()) {
      throw InputError(fmt::format("{}: the mesh has no {}: choose other --elements",
                                   files.front().string(), options.elements.value));
    }
    if (elements_.size() > std::numeric_limits<std::int32_t>::max()) {
      throw InputError(fmt::format("{}: more than 2^31 - 1 elements", files.front().string()));
    }
    // Vertices never share a vertex.
    const bool has_neighbours = options.elements.value != "vertices";
    if (has_neighbours && options.keep.value == "none") excludeNeighbours();
    scene_.objects = static_cast<std::uint32_t>(elements_.size());
    scene_.frames = static_cast<std::uint32_t>(frames_ - 1);
    boxes_.resize(elements_.size());
  }

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }

 private:
  /// Indices of its vertices; repeated for edges and vertices.
  using Element = std::array<std::uint32_t, 3>;

  void readFiles(const std::vector<fs::path>& files, const ReadingOptions& options,
                 ImportSummary& summary) {
    vertex_file_ = unnamedFile();
    for (const fs::path& file : files) {
      const PointSink sink = [&](auto points) { addFrame(points, file); };
      MeshTopology mesh = meshFormat(file, options.format.value) == "obj"
                              ? readObj(file, sink, summary)
                              : readWithAssimp(file, options.frame_rate, sink, summary);
      if (&file == &files.front()) {
        mesh_ = std::move(mesh);
      } else {
        requireSameTopology(mesh, file, mesh_, files.front());
      }
    }
  }

  void addFrame(std::span<const Point> points, const fs::path& file) {
    const auto invalid = std::ranges::find_if(points, [](const Point& point) {
      return !std::ranges::all_of(point, [](float value) { return std::isfinite(value); });
    });
    if (invalid != points.end()) {
      throw InputError(fmt::format("{}: vertex {} has a coordinate that is no finite 32-bit float",
                                   file.string(), invalid - points.begin()));
    }
    if (frames_ > kMaxFrames) throw InputError(fmt::format("more than {} frames", kMaxFrames));
    ++frames_;
    writeAll(vertex_file_.get(), std::as_bytes(points), "the vertices of a mesh");
    for (const Point& p : points) {
      const Aabb box = {{p[0], p[1], p[2], 0}, {p[0], p[1], p[2], 0}};
      scene_.world = merged(scene_.world, box);
    }
  }

  /// Joins vertices at the same position, for files with separate vertices per triangle.
  void joinVertices() {
    readPoints(0);
    std::map<Point, std::uint32_t> first_at;
    std::vector<std::uint32_t> joined(mesh_.vertices);
    for (const std::uint32_t vertex : vertices_) {
      joined[vertex] = first_at.try_emplace(points_[vertex], vertex).first->second;
    }
    std::erase_if(vertices_, [&](std::uint32_t vertex) { return joined[vertex] != vertex; });
    for (Triangle& triangle : mesh_.triangles) {
      for (std::uint32_t& vertex : triangle) vertex = joined[vertex];
    }
  }

  void addElements(const std::string& which) {
    const bool all = which == "all";
    if (all || which == "vertices") {
      for (const std::uint32_t vertex : vertices_) elements_.push_back({vertex, vertex, vertex});
    }
    if (all || which == "edges") {
      for (const auto& [a, b] : edgesOf(mesh_.triangles)) elements_.push_back({a, b, b});
    }
    if (all || which == "triangles") {
      elements_.insert(elements_.end(), mesh_.triangles.begin(), mesh_.triangles.end());
    }
  }

  void excludeNeighbours() {
    std::vector<BodyGroups> groups;
    groups.reserve(elements_.size());
    for (const Element& element : elements_) {
      BodyGroups& body = groups.emplace_back();
      std::ranges::copy(element, body.tags.begin());
    }
    scene_.filter = CollisionFilter(groups, LayerMatrix::all());
  }

  void readPoints(std::uint32_t index) {
    points_.resize(mesh_.vertices);
    const auto bytes = std::as_writable_bytes(std::span(points_));
    if (readAll(vertex_file_.get(), bytes, std::uint64_t{index} * bytes.size()) < bytes.size()) {
      throw InputError(fmt::format("{}: cannot read frame {}", scene_.name, index));
    }
  }

  std::span<const Aabb> readBoxes(std::uint32_t index) override {
    readPoints(index);
    for (std::size_t body = 0; body < boxes_.size(); ++body) {
      const auto& [a, b, c] = elements_[body];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [min, max] = std::minmax({points_[a][axis], points_[b][axis], points_[c][axis]});
        boxes_[body].min[axis] = min;
        boxes_[body].max[axis] = max;
      }
    }
    return boxes_;
  }

  SceneInfo scene_;
  MeshTopology mesh_;
  std::vector<std::uint32_t> vertices_;  ///< distinct vertices, ascending
  std::vector<Element> elements_;        ///< by body
  FileDescriptor vertex_file_;           ///< vertices of all frames, concatenated
  std::uint64_t frames_ = 0;
  std::vector<Point> points_;
  std::vector<Aabb> boxes_;
};

}  // namespace

std::unique_ptr<IndexedFrames> openElements(const std::vector<fs::path>& files,
                                            const ReadingOptions& options, ImportSummary& summary) {
  return std::make_unique<ElementFrames>(files, options, summary);
}

}  // namespace broadmark::imports
