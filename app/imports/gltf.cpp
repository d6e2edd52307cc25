// glTF 2.0 files: a scene of nodes that place meshes, deformed by morph targets and skins, moved by
// animations. Everything is found by its index, as names need not be unique.

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "broadmark/error.h"
#include "broadmark/scenes/simulation.h"
#include "imports/gltf_animation.h"
#include "imports/gltf_document.h"
#include "imports/gltf_mesh.h"
#include "imports/mesh.h"
#include "support/interrupt.h"
#include "support/words.h"

namespace broadmark::imports {
namespace gltf {
namespace {

using Eigen::Affine3d;
using Eigen::Vector3d;

struct Node {
  std::array<double, 3> translation{};
  std::array<double, 4> rotation = {0, 0, 0, 1};
  std::array<double, 3> scale = {1, 1, 1};
  std::optional<Affine3d> matrix;  ///< replaces these
  std::vector<double> weights;     ///< of the morph targets
  std::optional<std::uint32_t> parent;
  std::vector<std::uint32_t> children;
  Affine3d global;  ///< from the node's space into the scene's
};

struct Skin {
  std::vector<std::uint32_t> joints;  ///< nodes
  std::vector<Affine3d> inverse_bind_matrices;
  std::vector<Affine3d> matrices;  ///< from the mesh's space into the scene's, by joint
};

/// A mesh at a node of the scene.
struct MeshInstance {
  std::uint32_t node = 0;
  const Mesh* mesh = nullptr;
  Skin* skin = nullptr;
  std::vector<Affine3d> copies;  ///< places relative to the node: one, or those of instances
};

Affine3d transformOf(const Node& node) {
  if (node.matrix) return *node.matrix;
  return Eigen::Translation3d(Vector3d(node.translation.data())) *
         Eigen::Quaterniond(node.rotation.data()) * Eigen::Scaling(Vector3d(node.scale.data()));
}

/// A transform from a matrix of 16 numbers, column by column.
Affine3d affineOf(std::span<const double> columns, const std::string& name) {
  constexpr double kTolerance = 1e-3;
  const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix4d>(columns.data());
  const Eigen::RowVector4d last_row(0, 0, 0, 1);
  if (!((matrix.row(3) - last_row).cwiseAbs().maxCoeff() <= kTolerance)) {
    throw InputError(fmt::format("{}: the last row of a matrix must be 0 0 0 1", name));
  }
  Affine3d transform;
  transform.matrix() = matrix;
  transform.matrix().row(3) = last_row;
  return transform;
}

class Scene {
 public:
  Scene(const std::filesystem::path& file, const ReadingOptions& options, ImportSummary& summary,
        std::uint64_t spare_bytes)
      : document_(file, spare_bytes, summary), options_(options), summary_(summary) {
    summary_.units = "m";
    readNodes();
    order_ = withDescendants(roots_);
    requireNoCycle();
    animated_ = readAnimations(document_, options.animation, summary_);
    requireAnimatable();
    placeMeshes();
    noteWhatIsLeftOut();
    if (topology.vertices == 0) {
      throw InputError(
          fmt::format("{}: no vertices: no node of the scene shows a mesh", document_.name()));
    }
  }

  MeshTopology topology;

  [[nodiscard]] std::uint64_t frames() const {
    double end = 0;
    for (const auto& [driven, sampler] : animated_) end = std::max(end, sampler->end());
    constexpr double kTolerance = 0x1p-22;  // the times of keys are rounded to 32-bit floats
    const double frames = end * options_.frame_rate * (1 + kTolerance);
    constexpr double kMaxPlaces = 0x1p33;
    const double places = frames * (static_cast<double>(nodes_.size()) + topology.vertices);
    if (!(frames < kMaxFrames) || places > kMaxPlaces) {
      fail(document_.root(),
           fmt::format("{:.0f} frames of {} nodes and {} vertices: at most {} frames, and {:g} "
                       "nodes and vertices in all of them, are read: choose a lower --frame-rate",
                       std::floor(frames), nodes_.size(), topology.vertices, kMaxFrames,
                       kMaxPlaces));
    }
    return static_cast<std::uint64_t>(frames) + 1;
  }

  /// Vertices of a frame.
  const std::vector<Point>& points(std::uint64_t frame) {
    pose(static_cast<double>(frame) / options_.frame_rate);
    points_.clear();
    points_.reserve(topology.vertices);
    for (const MeshInstance& instance : instances_) {
      for (const Affine3d& copy : instance.copies) addPoints(instance, copy);
    }
    return points_;
  }

 private:
  void readNodes() {
    nodes_.resize(document_.count("nodes"));
    for (std::uint32_t index = 0; index < nodes_.size(); ++index) {
      const JsonFields object = document_.item("nodes", index);
      Node& node = nodes_[index];
      const bool has_parts =
          object.has("translation") || object.has("rotation") || object.has("scale");
      if (object.has("matrix")) {
        if (has_parts) fail(object, "a matrix, or translation, rotation and scale, is expected");
        std::array<double, 16> matrix{};
        readNumbers(object, "matrix", matrix);
        node.matrix = affineOf(matrix, object.name());
      }
      readNumbers(object, "translation", node.translation);
      readNumbers(object, "rotation", node.rotation);
      readNumbers(object, "scale", node.scale);
      normalizeRotation(node.rotation, object.name());
      node.children = document_.indices(object, "children", "nodes");
      for (const std::uint32_t child : node.children) {
        std::optional<std::uint32_t>& parent = nodes_[child].parent;
        if (parent) {
          fail(object,
               fmt::format("nodes[{}] is its child, but also one of nodes[{}]", child, *parent));
        }
        parent = index;
      }
    }
    for (std::uint32_t index = 0; index < nodes_.size(); ++index) {
      if (!nodes_[index].parent) roots_.push_back(index);
    }
  }

  template <std::size_t N>
  static void readNumbers(const JsonFields& object, const char* key, std::array<double, N>& all) {
    if (!object.has(key)) return;
    const std::vector<double> values = numbers(object, key);
    if (values.size() != N) {
      throw InputError(
          fmt::format("{}: {} numbers: {} are expected", object.path(key), values.size(), N));
    }
    std::ranges::copy(values, all.begin());
  }

  /// These nodes and their descendants, depth first.
  [[nodiscard]] std::vector<std::uint32_t> withDescendants(
      const std::vector<std::uint32_t>& roots) const {
    std::vector<std::uint32_t> found;
    std::vector<std::uint32_t> left(roots.rbegin(), roots.rend());
    while (!left.empty()) {
      found.push_back(left.back());
      left.pop_back();
      const std::vector<std::uint32_t>& children = nodes_[found.back()].children;
      left.insert(left.end(), children.rbegin(), children.rend());
    }
    return found;
  }

  /// Each node has one parent at most, so that roots do not reach a cycle.
  void requireNoCycle() const {
    if (order_.size() == nodes_.size()) return;
    std::vector<bool> is_reached(nodes_.size());
    for (const std::uint32_t index : order_) is_reached[index] = true;
    auto index =
        static_cast<std::uint32_t>(std::ranges::find(is_reached, false) - is_reached.begin());
    for (std::size_t i = 0; i < nodes_.size(); ++i) index = *nodes_[index].parent;
    fail(document_.item("nodes", index), "is its own descendant");
  }

  void requireAnimatable() const {
    for (const auto& [driven, sampler] : animated_) {
      if (driven.property == Property::weights || !nodes_[driven.node].matrix) continue;
      fail(document_.item("nodes", driven.node),
           "is animated, but has a matrix: translation, rotation and scale are expected");
    }
  }

  /// Roots of the scene that is shown.
  std::vector<std::uint32_t> sceneRoots() {
    const std::uint32_t count = document_.count("scenes");
    const auto chosen = document_.optionalIndex(document_.root(), "scene", "scenes");
    if (count == 0) return roots_;
    const auto title = [&](std::uint32_t index) {
      const std::string name = textOr(document_.item("scenes", index), "name");
      return name.empty() ? fmt::format("scene {}", index)
                          : fmt::format("scene '{}'", onOneLine(name));
    };
    const std::uint32_t shown = chosen.value_or(0);
    if (count > 1) addOnce(summary_.used, title(shown));
    for (std::uint32_t index = 0; index < count; ++index) {
      if (index != shown) addOnce(summary_.left_out, title(index));
    }
    const JsonFields scene = document_.item("scenes", shown);
    std::vector<std::uint32_t> roots = document_.indices(scene, "nodes", "nodes");
    for (const std::uint32_t root : roots) {
      if (!nodes_[root].parent) continue;
      fail(scene, fmt::format("nodes[{}] is not a root: it is a child of nodes[{}]", root,
                              *nodes_[root].parent));
    }
    std::vector<std::uint32_t> sorted = roots;
    std::ranges::sort(sorted);
    if (const auto twice = std::ranges::adjacent_find(sorted); twice != sorted.end()) {
      fail(scene, fmt::format("lists nodes[{}] twice", *twice));
    }
    return roots;
  }

  void placeMeshes() {
    const std::vector<std::uint32_t> shown = withDescendants(sceneRoots());
    std::vector<bool> is_hidden(nodes_.size());
    for (const std::uint32_t index : shown) {
      const JsonFields object = document_.item("nodes", index);
      const std::optional<std::uint32_t> parent = nodes_[index].parent;
      const auto visibility = extension(object, "KHR_node_visibility");
      is_hidden[index] =
          (parent && is_hidden[*parent]) ||
          (visibility && visibility->has("visible") && !visibility->boolean("visible"));
      const auto mesh = document_.optionalIndex(object, "mesh", "meshes");
      if (mesh && is_hidden[index]) ++hidden_;
      if (mesh && !is_hidden[index]) placeMesh(object, index, *mesh);
    }
  }

  void placeMesh(const JsonFields& object, std::uint32_t index, std::uint32_t mesh_index) {
    MeshInstance instance{.node = index};
    if (const auto skin = document_.optionalIndex(object, "skin", "skins")) {
      instance.skin = &readSkin(*skin);
    }
    const std::size_t joints = instance.skin == nullptr ? 0 : instance.skin->joints.size();
    auto known = meshes_.find({mesh_index, joints});
    if (known == meshes_.end()) {
      known = meshes_
                  .emplace(std::pair(mesh_index, joints),
                           readMesh(document_, mesh_index, joints, summary_))
                  .first;
    }
    instance.mesh = &known->second;
    setWeights(object, instance);
    readCopies(object, instance);
    addTopology(instance);
    instances_.push_back(std::move(instance));
  }

  void setWeights(const JsonFields& object, const MeshInstance& instance) {
    std::vector<double>& weights = nodes_[instance.node].weights;
    const std::size_t targets = instance.mesh->weights.size();
    weights = object.has("weights") ? numbers(object, "weights") : instance.mesh->weights;
    const auto animated = animated_.find({instance.node, Property::weights});
    const bool animation_fits = animated == animated_.end() || animated->second->width() == targets;
    if (weights.size() == targets && animation_fits) return;
    fail(object, fmt::format("{} weights, but {} morph targets",
                             animation_fits ? weights.size() : animated->second->width(), targets));
  }

  Skin& readSkin(std::uint32_t index) {
    const auto [known, added] = skins_.try_emplace(index);
    Skin& skin = known->second;
    if (!added) return skin;
    const JsonFields object = document_.item("skins", index);
    skin.joints = document_.indices(object, "joints", "nodes");
    if (skin.joints.empty()) fail(object, "has no joints");
    document_.charge(skin.joints.size(), 2 * sizeof(Affine3d));
    skin.matrices.resize(skin.joints.size());
    skin.inverse_bind_matrices.resize(skin.joints.size(), Affine3d::Identity());
    if (!object.has("inverseBindMatrices")) return skin;
    const Accessor& matrices = document_.accessor(object, "inverseBindMatrices", "MAT4");
    if (matrices.count < skin.joints.size()) {
      fail(object, fmt::format("{} inverse bind matrices, but {} joints", matrices.count,
                               skin.joints.size()));
    }
    for (std::uint32_t joint = 0; joint < skin.joints.size(); ++joint) {
      std::array<double, 16> columns{};
      matrices.read(joint, columns);
      skin.inverse_bind_matrices[joint] = affineOf(columns, matrices.name);
    }
    return skin;
  }

  /// Sets the places of the mesh relative to its node.
  void readCopies(const JsonFields& object, MeshInstance& instance) {
    constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";
    const auto instancing = extension(object, kInstancing);
    if (!instancing) {
      instance.copies.push_back(Affine3d::Identity());
      return;
    }
    if (instance.skin != nullptr) {
      fail(object, fmt::format("a skin cannot be combined with {}", kInstancing));
    }
    const JsonFields attributes = instancing->object("attributes");
    std::optional<std::uint32_t> count;
    const auto accessor = [&](const char* key, std::string_view type) -> const Accessor* {
      if (!attributes.has(key)) return nullptr;
      const Accessor& found = document_.accessor(attributes, key, type);
      if (count.value_or(found.count) != found.count) {
        fail(attributes, fmt::format("{} and {} instances: all attributes must have the same count",
                                     *count, found.count));
      }
      count = found.count;
      return &found;
    };
    const Accessor* translations = accessor("TRANSLATION", "VEC3");
    const Accessor* rotations = accessor("ROTATION", "VEC4");
    const Accessor* scales = accessor("SCALE", "VEC3");
    if (!count) fail(attributes, "TRANSLATION, ROTATION or SCALE is expected");
    document_.charge(*count, sizeof(Affine3d));
    for (std::uint32_t i = 0; i < *count; ++i) {
      Node place;
      if (translations != nullptr) translations->read(i, place.translation);
      if (rotations != nullptr) {
        rotations->read(i, place.rotation);
        normalizeRotation(place.rotation, rotations->name);
      }
      if (scales != nullptr) scales->read(i, place.scale);
      instance.copies.push_back(transformOf(place));
    }
  }

  void addTopology(const MeshInstance& instance) {
    const MeshTopology& mesh = instance.mesh->topology;
    const std::size_t copies = instance.copies.size();
    document_.charge(copies, mesh.vertices * sizeof(Point) +
                                 mesh.triangles.size() * sizeof(Triangle) +
                                 mesh.lines.size() * sizeof(mesh.lines[0]) + 1);
    points_in_scene_ += copies * instance.mesh->points;
    for (std::size_t copy = 0; copy < copies; ++copy) {
      const std::uint32_t first = topology.vertices;
      if (first + std::uint64_t{mesh.vertices} > kMaxVertices) {
        fail(document_.root(), "more than 2^31 - 1 vertices");
      }
      const auto renumbered = [&](auto element) {
        for (std::uint32_t& vertex : element) vertex += first;
        return element;
      };
      topology.vertices += mesh.vertices;
      std::ranges::transform(mesh.triangles, std::back_inserter(topology.triangles), renumbered);
      std::ranges::transform(mesh.lines, std::back_inserter(topology.lines), renumbered);
    }
  }

  void noteWhatIsLeftOut() {
    const auto left_out = [&](std::uint64_t number, std::string_view what, std::string_view more) {
      if (number == 0) return;
      addOnce(summary_.left_out, fmt::format("{}{}", counted(number, std::string(what)), more));
    };
    addOnce(summary_.used, fmt::format("{} at {}", counted(meshes_.size(), "mesh", "meshes"),
                                       counted(instances_.size(), "node")));
    std::uint64_t nodes = 0;
    for (std::uint32_t index = 0; index < nodes_.size(); ++index) {
      if (document_.item("nodes", index).has("mesh")) ++nodes;
    }
    left_out(hidden_, "node", " with a mesh, hidden");
    left_out(nodes - instances_.size() - hidden_, "node", " with a mesh, outside of the scene");
    left_out(document_.count("cameras"), "camera", "");
    if (const auto lights = extension(document_.root(), "KHR_lights_punctual")) {
      left_out(lights->has("lights") ? lights->array("lights").size() : 0, "light", "");
    }
    const std::string& elements = options_.elements.value;
    if (elements != "vertices" && elements != "all") {
      left_out(points_in_scene_, "point", ": --elements vertices has them");
    }
  }

  void pose(double seconds) {
    for (const auto& [driven, sampler] : animated_) {
      Node& node = nodes_[driven.node];
      switch (driven.property) {
        case Property::translation:
          sampler->valueAt(seconds, node.translation);
          break;
        case Property::rotation:
          sampler->valueAt(seconds, node.rotation);
          break;
        case Property::scale:
          sampler->valueAt(seconds, node.scale);
          break;
        case Property::weights:
          node.weights.resize(sampler->width());
          sampler->valueAt(seconds, node.weights);
      }
    }
    for (const std::uint32_t index : order_) {
      Node& node = nodes_[index];
      node.global = transformOf(node);
      if (node.parent) node.global = nodes_[*node.parent].global * node.global;
    }
    for (auto& [index, skin] : skins_) {
      for (std::size_t joint = 0; joint < skin.joints.size(); ++joint) {
        skin.matrices[joint] =
            nodes_[skin.joints[joint]].global * skin.inverse_bind_matrices[joint];
      }
    }
  }

  void addPoints(const MeshInstance& instance, const Affine3d& copy) {
    const Node& node = nodes_[instance.node];
    const Affine3d transform = node.global * copy;
    for (const VertexGroup& group : instance.mesh->groups) {
      for (std::size_t vertex = 0; vertex < group.positions.size(); ++vertex) {
        Vector3d position = group.positions[vertex];
        for (std::size_t target = 0; target < group.targets.size(); ++target) {
          if (group.targets[target].empty() || node.weights[target] == 0) continue;
          position += node.weights[target] * group.targets[target][vertex];
        }
        // A skin replaces the place of the node.
        position = instance.skin == nullptr ? transform * position
                                            : skinned(group, vertex, position, *instance.skin);
        points_.push_back({static_cast<float>(position.x()), static_cast<float>(position.y()),
                           static_cast<float>(position.z())});
      }
    }
  }

  static Vector3d skinned(const VertexGroup& group, std::size_t vertex, const Vector3d& position,
                          const Skin& skin) {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < group.influences; ++i) {
      const double weight = group.weights[vertex * group.influences + i];
      if (weight == 0) continue;
      sum += weight * (skin.matrices[group.joints[vertex * group.influences + i]] * position);
    }
    return sum;
  }

  Document document_;
  const ReadingOptions& options_;
  ImportSummary& summary_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> roots_;  ///< nodes without a parent
  std::vector<std::uint32_t> order_;  ///< all nodes, parents first
  std::map<AnimatedProperty, std::shared_ptr<const Sampler>> animated_;
  std::map<std::uint32_t, Skin> skins_;
  std::map<std::pair<std::uint32_t, std::size_t>, Mesh> meshes_;  ///< by index and number of joints
  std::vector<MeshInstance> instances_;
  std::uint64_t hidden_ = 0;  ///< nodes with meshes that are not shown
  std::uint64_t points_in_scene_ = 0;
  std::vector<Point> points_;
};

}  // namespace
}  // namespace gltf

MeshTopology readGltf(const std::filesystem::path& file, const ReadingOptions& options,
                      const PointSink& sink, ImportSummary& summary, std::uint64_t spare_bytes) {
  gltf::Scene scene(file, options, summary, spare_bytes);
  const std::uint64_t frames = scene.frames();
  for (std::uint64_t frame = 0; frame < frames; ++frame) {
    if (InterruptGuard::requested()) throw Interrupted();
    sink(scene.points(frame));
  }
  return std::move(scene.topology);
}

}  // namespace broadmark::imports
