#include "imports/gltf_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <map>
#include <numeric>
#include <optional>

namespace broadmark::imports::gltf {
namespace {

enum Mode { kPoints, kLines, kLineLoop, kLineStrip, kTriangles, kTriangleStrip, kTriangleFan };

/// Accessors that define the vertices of a primitive.
struct VertexSource {
  const Accessor* positions = nullptr;
  std::vector<const Accessor*> targets;  ///< null: a target without positions
  std::vector<const Accessor*> joints;
  std::vector<const Accessor*> weights;

  friend auto operator<=>(const VertexSource&, const VertexSource&) = default;
};

/// A primitive, with vertices as numbered in its accessors.
struct Primitive {
  std::size_t group = 0;
  std::vector<Triangle> triangles;
  std::vector<std::array<std::uint32_t, 2>> lines;
  std::vector<std::uint32_t> points;
};

class MeshReader {
 public:
  MeshReader(Document& document, std::uint32_t index, std::size_t joints, ImportSummary& summary)
      : document_(document),
        object_(document.item("meshes", index)),
        joints_(joints),
        summary_(summary) {}

  Mesh read() {
    object_.eachObject("primitives", [&](const JsonFields& object) { readPrimitive(object); });
    if (object_.has("weights")) mesh_.weights = numbers(object_, "weights");
    if (mesh_.weights.empty()) mesh_.weights.resize(targets_.value_or(0));
    if (mesh_.weights.size() != targets_.value_or(0)) {
      fail(object_, fmt::format("{} weights, but {} morph targets", mesh_.weights.size(),
                                targets_.value_or(0)));
    }
    std::vector<std::vector<std::uint32_t>> used(sources_.size());
    for (const Primitive& primitive : primitives_) addUsed(primitive, used[primitive.group]);
    std::vector<std::uint32_t> first;
    for (std::size_t group = 0; group < sources_.size(); ++group) {
      std::ranges::sort(used[group]);
      const auto repeated = std::ranges::unique(used[group]);
      used[group].erase(repeated.begin(), repeated.end());
      if (mesh_.topology.vertices + used[group].size() > kMaxVertices) {
        fail(object_, "more than 2^31 - 1 vertices");
      }
      first.push_back(mesh_.topology.vertices);
      mesh_.topology.vertices += static_cast<std::uint32_t>(used[group].size());
      readVertices(*sources_[group], used[group]);
    }
    for (const Primitive& primitive : primitives_) {
      addTopology(primitive, used[primitive.group], first[primitive.group]);
    }
    return std::move(mesh_);
  }

 private:
  void readPrimitive(const JsonFields& object) {
    constexpr const char* kDraco = "KHR_draco_mesh_compression";
    if (extension(object, kDraco)) {
      fail(object, fmt::format("is compressed with {}, which is not supported: export the file "
                               "without compression",
                               kDraco));
    }
    const JsonFields attributes = object.object("attributes");
    if (!attributes.has("POSITION")) {
      addOnce(summary_.left_out, "a primitive without positions");
      return;
    }
    VertexSource source{.positions = &document_.accessor(attributes, "POSITION", "VEC3")};
    readTargets(object, source);
    if (joints_ > 0) readJoints(attributes, source);
    Primitive primitive;
    const auto [group, added] = groups_.emplace(std::move(source), groups_.size());
    if (added) sources_.push_back(&group->first);
    primitive.group = group->second;
    readCorners(object, *group->first.positions, primitive);
    primitives_.push_back(std::move(primitive));
  }

  void readTargets(const JsonFields& object, VertexSource& source) {
    if (object.has("targets")) {
      object.eachObject("targets", [&](const JsonFields& target) {
        source.targets.push_back(
            target.has("POSITION") ? matching(target, "POSITION", "VEC3", source) : nullptr);
      });
    }
    if (targets_.value_or(source.targets.size()) != source.targets.size()) {
      fail(object, fmt::format("{} morph targets, but {} in other primitives of the mesh",
                               source.targets.size(), *targets_));
    }
    targets_ = source.targets.size();
  }

  void readJoints(const JsonFields& attributes, VertexSource& source) {
    for (int set = 0;; ++set) {
      const std::string joints = fmt::format("JOINTS_{}", set);
      const std::string weights = fmt::format("WEIGHTS_{}", set);
      if (set > 0 && !attributes.has(joints.c_str()) && !attributes.has(weights.c_str())) return;
      source.joints.push_back(matching(attributes, joints.c_str(), "VEC4", source));
      source.weights.push_back(matching(attributes, weights.c_str(), "VEC4", source));
    }
  }

  /// An accessor with as many elements as there are positions.
  const Accessor* matching(const JsonFields& object, const char* key, std::string_view type,
                           const VertexSource& source) {
    const Accessor& accessor = document_.accessor(object, key, type);
    if (accessor.count != source.positions->count) {
      throw InputError(fmt::format("{}: {} elements, but {} positions", object.path(key),
                                   accessor.count, source.positions->count));
    }
    return &accessor;
  }

  void readCorners(const JsonFields& object, const Accessor& positions, Primitive& primitive) {
    std::vector<std::uint32_t> corners;
    if (object.has("indices")) {
      const Accessor& indices = document_.vertexIndices(object, "indices");
      document_.charge(indices.count, sizeof(std::uint32_t));
      for (std::uint32_t i = 0; i < indices.count; ++i) {
        corners.push_back(static_cast<std::uint32_t>(indices.number(i)));
        if (corners.back() < positions.count) continue;
        fail(object, fmt::format("index {} is {}, but there are {} vertices: damaged?", i,
                                 corners.back(), positions.count));
      }
    } else {
      document_.charge(positions.count, sizeof(std::uint32_t));
      corners.resize(positions.count);
      std::iota(corners.begin(), corners.end(), 0U);
    }
    document_.charge(corners.size(), sizeof(Triangle) + sizeof(std::uint32_t) * 3);
    addElements(object, corners, primitive);
  }

  void addElements(const JsonFields& object, const std::vector<std::uint32_t>& corners,
                   Primitive& primitive) {
    const std::size_t count = corners.size();
    const auto require_multiple = [&](std::size_t of) {
      if (count % of == 0) return;
      fail(object, fmt::format("{} vertices: a multiple of {} is expected", count, of));
    };
    const auto add_triangle = [&](std::size_t a, std::size_t b, std::size_t c) {
      primitive.triangles.push_back({corners[a], corners[b], corners[c]});
    };
    const auto add_line = [&](std::size_t a, std::size_t b) {
      primitive.lines.push_back({corners[a], corners[b]});
    };
    const std::uint64_t mode = integerOr(object, "mode", kTriangles, kTriangleFan);
    switch (mode) {
      case kPoints:
        primitive.points = corners;
        mesh_.points += count;
        break;
      case kLines:
        require_multiple(2);
        for (std::size_t i = 0; i < count; i += 2) add_line(i, i + 1);
        break;
      case kLineLoop:
      case kLineStrip:
        for (std::size_t i = 0; i + 1 < count; ++i) add_line(i, i + 1);
        if (mode == kLineLoop && count > 2) add_line(count - 1, 0);
        break;
      case kTriangles:
        require_multiple(3);
        for (std::size_t i = 0; i < count; i += 3) add_triangle(i, i + 1, i + 2);
        break;
      case kTriangleStrip:
        for (std::size_t i = 0; i + 2 < count; ++i) {
          add_triangle(i, i + 1 + i % 2, i + 2 - i % 2);
          const auto& [a, b, c] = primitive.triangles.back();
          // A repeated vertex joins two strips.
          if (a == b || b == c || c == a) primitive.triangles.pop_back();
        }
        break;
      default:
        for (std::size_t i = 0; i + 2 < count; ++i) add_triangle(i + 1, i + 2, 0);
    }
  }

  void addUsed(const Primitive& primitive, std::vector<std::uint32_t>& used) {
    for (const auto& triangle : primitive.triangles) {
      used.insert(used.end(), triangle.begin(), triangle.end());
    }
    for (const auto& line : primitive.lines) used.insert(used.end(), line.begin(), line.end());
    used.insert(used.end(), primitive.points.begin(), primitive.points.end());
  }

  void readVertices(const VertexSource& source, const std::vector<std::uint32_t>& used) {
    VertexGroup& group = mesh_.groups.emplace_back();
    group.positions = vectors(*source.positions, used);
    for (const Accessor* target : source.targets) {
      group.targets.push_back(target == nullptr ? std::vector<Eigen::Vector3d>()
                                                : vectors(*target, used));
    }
    group.influences = 4 * source.joints.size();
    document_.charge(used.size() * group.influences, sizeof(double) + sizeof(std::uint32_t));
    for (const std::uint32_t vertex : used) {
      if (!source.joints.empty()) addInfluences(source, vertex, group);
    }
  }

  std::vector<Eigen::Vector3d> vectors(const Accessor& accessor,
                                       const std::vector<std::uint32_t>& used) {
    document_.charge(used.size(), sizeof(Eigen::Vector3d));
    std::vector<Eigen::Vector3d> all(used.size());
    for (std::size_t i = 0; i < used.size(); ++i) {
      accessor.read(used[i], std::span(all[i].data(), 3));
    }
    return all;
  }

  void addInfluences(const VertexSource& source, std::uint32_t vertex, VertexGroup& group) {
    constexpr double kTolerance = 0.05;
    double sum = 0;
    for (std::size_t set = 0; set < source.joints.size(); ++set) {
      std::array<double, 4> joints{};
      std::array<double, 4> weights{};
      source.joints[set]->read(vertex, joints);
      source.weights[set]->read(vertex, weights);
      for (std::size_t i = 0; i < 4; ++i) {
        sum += weights[i];
        group.weights.push_back(weights[i]);
        const bool exists = joints[i] >= 0 && joints[i] < static_cast<double>(joints_) &&
                            joints[i] == std::floor(joints[i]);
        if (!exists && weights[i] != 0) {
          throw InputError(fmt::format("{}: element {}: joint {:g}, but there are {}",
                                       source.joints[set]->name, vertex, joints[i], joints_));
        }
        group.joints.push_back(exists ? static_cast<std::uint32_t>(joints[i]) : 0);
      }
    }
    if (!(std::abs(sum - 1) <= kTolerance)) {
      throw InputError(fmt::format("{}: element {}: weights whose sum is {:g}: 1 is expected",
                                   source.weights[0]->name, vertex, sum));
    }
    for (double& weight : std::span(group.weights).last(group.influences)) weight /= sum;
  }

  void addTopology(const Primitive& primitive, const std::vector<std::uint32_t>& used,
                   std::uint32_t first) {
    const auto numbered = [&](auto element) {
      for (std::uint32_t& vertex : element) {
        const auto place = std::ranges::lower_bound(used, vertex) - used.begin();
        vertex = first + static_cast<std::uint32_t>(place);
      }
      return element;
    };
    std::ranges::transform(primitive.triangles, std::back_inserter(mesh_.topology.triangles),
                           numbered);
    std::ranges::transform(primitive.lines, std::back_inserter(mesh_.topology.lines), numbered);
  }

  Document& document_;
  JsonFields object_;
  std::size_t joints_;  ///< of the skin
  ImportSummary& summary_;
  std::optional<std::size_t> targets_;  ///< number of morph targets
  std::map<VertexSource, std::size_t> groups_;
  std::vector<const VertexSource*> sources_;  ///< by group
  std::vector<Primitive> primitives_;
  Mesh mesh_;
};

}  // namespace

Mesh readMesh(Document& document, std::uint32_t index, std::size_t joints, ImportSummary& summary) {
  return MeshReader(document, index, joints, summary).read();
}

}  // namespace broadmark::imports::gltf
