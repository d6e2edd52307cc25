#include "imports/element_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "imports/files.h"
#include "imports/mesh_sequence.h"

namespace broadmark::imports {
namespace {

namespace fs = std::filesystem;

/// Returns the edges of triangles and the lines without duplicates, sorted by their vertices.
std::vector<std::array<std::uint32_t, 2>> edgesOf(const MeshTopology& mesh) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  const auto add = [&](std::uint32_t first, std::uint32_t second) {
    edges.push_back({std::min(first, second), std::max(first, second)});
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    if (a != b) add(a, b);
    if (b != c) add(b, c);
    if (c != a) add(c, a);
  }
  for (const auto& [a, b] : mesh.lines) add(a, b);
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

/// Text of ascending numbers: "0..4, 8"; of many ranges only the first are shown.
std::string rangesText(std::span<const std::uint32_t> numbers) {
  constexpr int kMaxRanges = 4;
  std::string text;
  int ranges = 0;
  for (std::size_t begin = 0, end = 0; begin < numbers.size(); begin = end) {
    if (++ranges > kMaxRanges) return text + ", …";
    for (end = begin + 1; end < numbers.size() && numbers[end] == numbers[end - 1] + 1;) ++end;
    if (!text.empty()) text += ", ";
    text += fmt::format("{}", numbers[begin]);
    if (end > begin + 1) text += fmt::format("..{}", numbers[end - 1]);
  }
  return text;
}

/// Returns for each vertex of a mesh the first one at the same position in all of its frames.
std::vector<std::uint32_t> joinedVertices(const MeshSequence& sequence, const SequenceMesh& mesh) {
  std::vector<std::uint32_t> joined(mesh.topology.vertices, 0);
  std::vector<std::uint32_t> order(joined.size());
  std::iota(order.begin(), order.end(), 0U);
  const std::vector<std::uint32_t> vertices = order;
  std::vector<Point> points;
  for (const std::uint32_t frame : mesh.frames) {
    sequence.readPoints(frame, points);
    const auto stays = [&](std::uint32_t v) { return points[v] == points[joined[v]]; };
    if (std::ranges::all_of(vertices, stays)) continue;
    // Vertices that were together, and still are, become neighbours.
    const auto places = [&](std::uint32_t v) { return std::tie(joined[v], points[v]); };
    std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
      return places(a) != places(b) ? places(a) < places(b) : a < b;
    });
    std::vector<std::uint32_t> split(joined.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      const bool is_first = i == 0 || places(order[i]) != places(order[i - 1]);
      split[order[i]] = is_first ? order[i] : split[order[i - 1]];
    }
    joined = std::move(split);
  }
  return joined;
}

class ElementFrames final : public IndexedFrames {
 public:
  ElementFrames(const std::vector<fs::path>& files, const ReadingOptions& options,
                ImportSummary& summary)
      : sequence_(files, options, summary), which_(options.elements.value) {
    scene_.name = sequenceName(files);
    scene_.object_type = typeName(which_);
    scene_.world = sequence_.world();
    for (const SequenceMesh& mesh : sequence_.meshes()) addBodies(mesh);
    if (bodies_ == 0) throw InputError(fmt::format("{}: no vertices", files.front().string()));
    // Vertices never share a vertex.
    if (which_ != "vertices" && options.keep.value == "none") excludeNeighbours();
    scene_.objects = bodies_;
    scene_.frames = sequence_.frames() - 1;
    scene_.all_present = std::ranges::all_of(
        meshes_, [&](const MeshBodies& mesh) { return mesh.elements.size() == bodies_; });
    if (meshes_.size() > 1) summary.used.push_back(meshesText());
    sequence_.forgetFaces();
    for (MeshBodies& mesh : meshes_) mesh.tags = {};
    boxes_.resize(bodies_);
  }

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }

 private:
  /// Indices of its vertices; repeated for edges and vertices.
  using Element = std::array<std::uint32_t, 3>;

  /// The bodies of a mesh's elements.
  struct MeshBodies {
    std::vector<Element> elements = {};
    std::vector<std::uint32_t> bodies = {};  ///< by element
    std::vector<std::uint32_t> tags = {};    ///< by vertex; freed once the filter is made
  };

  void addBodies(const SequenceMesh& mesh) {
    MeshBodies& added = meshes_.emplace_back(MeshBodies{.elements = elementsOf(mesh)});
    // A mesh without vertices is empty on purpose; one without faces may have lost them.
    if (added.elements.empty() && mesh.topology.vertices > 0) {
      throw InputError(fmt::format("{}: the mesh has no {}: choose other --elements",
                                   mesh.file.string(), which_));
    }
    // The elements of the mesh that this one extends are in the same order among the new ones.
    static const MeshBodies no_elements;
    const MeshBodies& base = mesh.extends ? meshes_[*mesh.extends] : no_elements;
    std::size_t known = 0;
    for (const Element& element : added.elements) {
      if (known < base.elements.size() && base.elements[known] == element) {
        added.bodies.push_back(base.bodies[known++]);
      } else {
        added.bodies.push_back(bodies_++);
      }
      if (bodies_ > std::numeric_limits<std::int32_t>::max()) {
        throw InputError(fmt::format("{}: more than 2^31 - 1 elements", mesh.file.string()));
      }
    }
    added.tags = base.tags;
    while (added.tags.size() < mesh.topology.vertices) added.tags.push_back(tags_++);
    if (tags_ > std::numeric_limits<std::int32_t>::max()) {
      throw InputError(
          fmt::format("{}: more than 2^31 - 1 vertices in all meshes", mesh.file.string()));
    }
  }

  [[nodiscard]] std::vector<Element> elementsOf(const SequenceMesh& mesh) const {
    MeshTopology topology = mesh.topology;
    std::vector<std::uint32_t> vertices(topology.vertices);
    std::iota(vertices.begin(), vertices.end(), 0U);
    if (topology.joined_by_position) {
      const std::vector<std::uint32_t> joined = joinedVertices(sequence_, mesh);
      std::erase_if(vertices, [&](std::uint32_t vertex) { return joined[vertex] != vertex; });
      for (Triangle& triangle : topology.triangles) {
        for (std::uint32_t& vertex : triangle) vertex = joined[vertex];
      }
    }
    std::vector<Element> elements;
    const bool all = which_ == "all";
    if (all || which_ == "vertices") {
      for (const std::uint32_t vertex : vertices) elements.push_back({vertex, vertex, vertex});
    }
    if (all || which_ == "edges") {
      for (const auto& [a, b] : edgesOf(topology)) elements.push_back({a, b, b});
    }
    if (all || which_ == "triangles") {
      elements.insert(elements.end(), topology.triangles.begin(), topology.triangles.end());
    }
    return elements;
  }

  void excludeNeighbours() {
    std::vector<BodyGroups> groups(bodies_);
    for (const MeshBodies& mesh : meshes_) {
      for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
        std::ranges::transform(mesh.elements[i], groups[mesh.bodies[i]].tags.begin(),
                               [&](std::uint32_t vertex) { return mesh.tags[vertex]; });
      }
    }
    scene_.filter = CollisionFilter(groups, LayerMatrix::all());
  }

  [[nodiscard]] std::string meshesText() const {
    constexpr std::size_t kMaxShown = 4;
    std::string text = fmt::format("{} topologies", meshes_.size());
    for (std::size_t i = 0; i < std::min(meshes_.size(), kMaxShown); ++i) {
      std::vector<std::uint32_t> bodies = meshes_[i].bodies;
      std::ranges::sort(bodies);
      text += fmt::format("{} bodies {} in frames {}", i == 0 ? ":" : ";",
                          bodies.empty() ? "none" : rangesText(bodies),
                          rangesText(sequence_.meshes()[i].frames));
    }
    if (meshes_.size() > kMaxShown) text += "; …";
    return text +
           "; a file with the same elements as another file, or with further elements after those "
           "of the previous file, continues its bodies";
  }

  std::span<const Aabb> readBoxes(std::uint32_t index) override {
    sequence_.readPoints(index, points_);
    const std::size_t mesh = sequence_.meshOf(index);
    if (shown_mesh_ != mesh) std::ranges::fill(boxes_, kEmptyBox);
    shown_mesh_ = mesh;
    const auto& [elements, bodies, tags] = meshes_[mesh];
    for (std::size_t i = 0; i < elements.size(); ++i) {
      const auto& [a, b, c] = elements[i];
      Aabb& box = boxes_[bodies[i]];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [min, max] = std::minmax({points_[a][axis], points_[b][axis], points_[c][axis]});
        box.min[axis] = min;
        box.max[axis] = max;
      }
    }
    return boxes_;
  }

  SceneInfo scene_;
  MeshSequence sequence_;
  std::string which_;               ///< --elements
  std::vector<MeshBodies> meshes_;  ///< as MeshSequence::meshes()
  std::uint32_t bodies_ = 0;        ///< number of bodies of all meshes
  std::uint32_t tags_ = 0;          ///< number of vertices of all meshes
  std::vector<Point> points_;
  std::vector<Aabb> boxes_;
  std::optional<std::size_t> shown_mesh_;  ///< mesh of the bodies in boxes_ that are present
};

}  // namespace

std::unique_ptr<IndexedFrames> openElements(const std::vector<fs::path>& files,
                                            const ReadingOptions& options, ImportSummary& summary) {
  return std::make_unique<ElementFrames>(files, options, summary);
}

}  // namespace broadmark::imports
