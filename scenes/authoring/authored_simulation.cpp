// Authored scenes as simulations, and frames of any source as authored scenes.

#include "broadmark/scenes/authored_simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>

#include "authoring/faults.h"
#include "broadmark/error.h"
#include "broadmark/hasher.h"
#include "broadmark/scenes/registry.h"
#include "entries.h"
#include "physics_simulation.h"

namespace broadmark::scenes {
namespace {

SceneListing listingOf(const AuthoredScene& scene) {
  return {.id = std::string(kAuthoredSceneId),
          .name = scene.name,
          .summary = "bodies placed in the scene editor"};
}

bool isAlwaysPresent(const AuthoredBody& body) {
  return body.appears == 0 && body.vanishes == kNever;
}

class AuthoredSimulation final : public PhysicsSimulation, public SceneDocument {
 public:
  AuthoredSimulation(AuthoredScene scene, std::filesystem::path file)
      : PhysicsSimulation(listingOf(scene)),
        scene_(std::move(scene)),
        file_(std::move(file)),
        parameters_(scene_.parameters) {
    requireValid(scene_);
  }

  void visitParameters(const ParameterVisitor& visit) override {
    parameters_.visitParameters(visit);
  }

  [[nodiscard]] AuthoredScene document() override {
    AuthoredScene document = scene_;
    ParameterValues values = parameters_.values();
    // Preserves the text of unchanged values, so that saving again yields the same file.
    if (values != AuthoredParameters(scene_.parameters).values()) {
      document.parameters = std::move(values);
    }
    return document;
  }

  [[nodiscard]] std::filesystem::path input() const override { return file_; }

  /// Covers the scene's bodies and parameters, not the file's layout.
  [[nodiscard]] std::string inputHash() override {
    if (hash_.empty()) {
      const std::string text = formatAuthoredScene(scene_);
      Hasher hasher;
      hasher.add(std::as_bytes(std::span(text)));
      hash_ = hasher.hex();
    }
    return hash_;
  }

 private:
  [[nodiscard]] SceneInfo describe() const override {
    return {.name = scene_.name,
            .object_type = objectTypeName(scene_),
            .objects = static_cast<std::uint32_t>(scene_.bodies.size()),
            .frames = parameters_.frames(),
            .world = scene_.world,
            .all_present = std::ranges::all_of(scene_.bodies, isAlwaysPresent),
            .filter = collisionFilterOf(scene_)};
  }

  [[nodiscard]] std::unique_ptr<PhysicsEngine> createEngine() override {
    return parameters_.createEngine();
  }

  /// The colliding layers, without triggers.
  [[nodiscard]] LayerMatrix pushing(const SceneInfo&) const override {
    LayerMatrix layers = scene_.collide;
    for (std::size_t a = 0; a < LayerMatrix::kLayers; ++a) {
      if ((scene_.triggers >> a & 1) == 0) continue;
      for (std::size_t b = 0; b < LayerMatrix::kLayers; ++b) layers.set(a, b, false);
    }
    return layers;
  }

  void start() override {
    changes_.clear();
    for (std::size_t id = 0; id < scene_.bodies.size(); ++id) {
      const AuthoredBody& body = scene_.bodies[id];
      if (body.appears > 0) changes_.emplace(body.appears, id);
      if (body.vanishes != kNever) changes_.emplace(body.vanishes, id);
    }
    for (std::size_t id = 0; id < scene_.bodies.size(); ++id) {
      if (scene_.bodies[id].appears == 0) addBody(id);
    }
    engine().setGravity(parameters_.gravity());
  }

  void updatePresence(std::uint32_t frame) override {
    const auto [first, last] = changes_.equal_range(frame);
    for (auto change = first; change != last; ++change) {
      const std::size_t id = change->second;
      if (scene_.bodies[id].appears == frame) {
        addBody(id);
      } else {
        bodies().remove(id);
      }
    }
  }

  void addBody(std::size_t id) {
    const AuthoredBody& body = scene_.bodies[id];
    PhysicsBody& added = bodies().add(id, {.shape = body.shape,
                                           .mass = body.mass,
                                           .pose = body.pose,
                                           .linear_velocity = body.linear_velocity,
                                           .angular_velocity = body.angular_velocity});
    if (body.frozen) added.freeze();
  }

  AuthoredScene scene_;
  std::filesystem::path file_;
  AuthoredParameters parameters_;
  std::string hash_;
  std::multimap<std::uint32_t, std::size_t> changes_;  ///< bodies that appear or vanish, by frame
};

/// Advances a source from its initial pose to frame `index`.
Frame advance(FrameSource& source, Frame initial, std::uint32_t index) {
  if (auto* frames = dynamic_cast<IndexedFrames*>(&source)) return frames->at(index);
  Frame frame = initial;
  while (frame.index < index) frame = *source.next();
  return frame;
}

/// The unrotated boxes of a source that was just rewound; empty if it has only boxes.
std::vector<Aabb> unrotatedBoxes(PoseSource* source) {
  if (source == nullptr) return {};
  try {
    const auto boxes = source->unrotatedBoxes();
    return {boxes.begin(), boxes.end()};
  } catch (const InputError&) {  // replay of a recording of boxes
    return {};
  }
}

}  // namespace

AuthoredBody bodyFilling(const Aabb& box, const std::string& object_type) {
  AuthoredBody body;
  Vec3 half;
  for (int axis = 0; axis < 3; ++axis) {
    const float edge = box.max[axis] - box.min[axis];
    body.pose.position[axis] = box.min[axis] + edge / 2;
    half[axis] = std::max(edge, kMinEdge) / 2;  // bodies must have a positive thickness
  }
  if (object_type == "Spheres") {
    body.shape = SphereShape{half[0]};
  } else {
    body.shape = BoxShape{half};
  }
  return body;
}

void copyCollisions(AuthoredScene& scene, const CollisionFilter& filter) {
  if (!filter.worlds().empty() || !filter.tags().empty()) {
    throw InputError(fmt::format(
        "{}: its bodies have worlds or tags, which an authored scene cannot state", scene.name));
  }
  if (!filter.wantsAll()) scene.collide = filter.matrix();
}

AuthoredParameters::AuthoredParameters(const ParameterValues& stated)
    : engine_(choiceOf(engineEntries())), engine_parameters_(std::make_unique<ChosenEngine>()) {
  setParameters(*this, stated);
}

AuthoredParameters::AuthoredParameters(const ParameterValues& other, const Vec3& gravity)
    : AuthoredParameters() {
  // One at a time: the chosen engine determines the later parameters.
  visitParameters([&](const Parameter& parameter) {
    const auto value = other.find(std::string(parameter.name));
    if (value != other.end()) setParameter(parameter, value->second);
  });
  gravity_x_ = gravity[0];
  gravity_y_ = gravity[1];
  gravity_z_ = gravity[2];
}

AuthoredParameters::~AuthoredParameters() = default;
AuthoredParameters::AuthoredParameters(AuthoredParameters&&) noexcept = default;
AuthoredParameters& AuthoredParameters::operator=(AuthoredParameters&&) noexcept = default;

void AuthoredParameters::visitParameters(const ParameterVisitor& visit) {
  constexpr double kMaxGravity = 1e6;
  visit({"frames", "number of frames after the initial pose", &frames_, 1, kMaxFrames});
  visit({"engine", "physics engine that moves the bodies", &engine_});
  visit({"gravity_x", "gravity along x, in world units per second squared", &gravity_x_,
         -kMaxGravity, kMaxGravity});
  visit({"gravity_y", "gravity along y, which points up", &gravity_y_, -kMaxGravity, kMaxGravity});
  visit({"gravity_z", "gravity along z", &gravity_z_, -kMaxGravity, kMaxGravity});
  physics_.visit(visit);
  engine_parameters_->parameters(engine_.value, physics_).visitParameters(visit);
}

Vec3 AuthoredParameters::gravity() const {
  return {static_cast<float>(gravity_x_), static_cast<float>(gravity_y_),
          static_cast<float>(gravity_z_)};
}

std::unique_ptr<PhysicsEngine> AuthoredParameters::createEngine() {
  return engine_parameters_->create(engine_.value, physics_);
}

std::unique_ptr<Simulation> makeAuthoredSimulation(AuthoredScene scene,
                                                   std::filesystem::path file) {
  return std::make_unique<AuthoredSimulation>(std::move(scene), std::move(file));
}

AuthoredScene sceneFromFrame(FrameSource& source, std::uint32_t frame) {
  const Frame initial = source.rewind();
  const SceneInfo info = source.scene();
  if (frame > info.frames) {
    throw InputError(
        fmt::format("{}: there is no frame {}: the last one is {}", info.name, frame, info.frames));
  }
  auto* poses = dynamic_cast<PoseSource*>(&source);
  const std::vector<Aabb> unrotated = unrotatedBoxes(poses);
  const Frame requested = advance(source, initial, frame);
  if (auto* whole = dynamic_cast<SceneSource*>(&source)) return whole->authoredScene();

  // Gravity is unknown: the bodies remain at rest.
  AuthoredScene scene{
      .name = info.name, .world = info.world, .parameters = {{"gravity_y", "0"}}, .bodies = {}};
  copyCollisions(scene, info.filter);
  if (frame > 0 && !unrotated.empty()) {
    const auto poses_of_frame = poses->poses();
    for (std::size_t i = 0; i < unrotated.size(); ++i) {
      scene.bodies.push_back(bodyFilling(unrotated[i], info.object_type));
      scene.bodies.back().pose = poses_of_frame[i];
    }
  } else {
    for (std::uint32_t id = 0; id < requested.boxes.size(); ++id) {
      if (isEmpty(requested.boxes[id])) continue;
      scene.bodies.push_back(bodyFilling(requested.boxes[id], info.object_type));
      scene.bodies.back().layer = requested.filterIn(info).groupsOf(id).layer;
    }
  }
  requireValid(scene);
  return scene;
}

}  // namespace broadmark::scenes
