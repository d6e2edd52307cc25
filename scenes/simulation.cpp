// Drives a scene and a physics engine, frame by frame.

#include "scenes/simulation.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "broadmark/error.h"
#include "broadmark/names.h"
#include "scenes/replay.h"
#include "scenes/scene.h"

namespace broadmark {
namespace scenes {
namespace {

/// The entry of a list with this id.
template <class Entry>
Entry entryOf(std::vector<Entry> entries, const Choice& choice, std::string_view kind) {
  const auto found =
      std::ranges::find(entries, choice.value, [](const Entry& entry) { return entry.listing.id; });
  if (found == entries.end()) throw InputError(unknownName(kind, choice.value, choice.options));
  return std::move(*found);
}

/// The cube ± side/2.
Aabb worldBox(double side) {
  const auto half = static_cast<float>(side / 2);
  return {{-half, -half, -half, 0}, {half, half, half, 0}};
}

bool contains(const Aabb& box, const Vec3& point) {
  for (int axis = 0; axis < 3; ++axis) {
    if (point[axis] < box.min[axis] || point[axis] > box.max[axis]) return false;
  }
  return true;
}

class BuiltinSimulation final : public Simulation {
 public:
  explicit BuiltinSimulation(const SceneEntry& entry)
      : Simulation(entry.listing), scene_(entry.create()) {
    scene_->setDefaults(settings_);
  }

  void visitParameters(const ParameterVisitor& visit) override {
    settings_.visit(visit);
    scene_->visitParameters(visit);
    chosenEngine().visitParameters(visit);
  }

  [[nodiscard]] const SceneInfo& scene() const override {
    // Until the first frame the parameters may still change behind our back.
    if (!engine_) info_ = describe();
    return info_;
  }

  Frame rewind() override {
    info_ = describe();
    random_ = Random(static_cast<std::uint64_t>(settings_.seed));
    bodies_.clear();
    engine_ = createEngine();
    setParameters(*engine_, parameterValues(chosenEngine()));
    addWalls();
    addBodies();
    Stage stage = makeStage();
    scene_->start(stage);
    index_ = 0;
    return record();
  }

  std::optional<Frame> next() override {
    if (!engine_) rewind();
    if (index_ == info_.frames) return {};
    ++index_;
    if (!engine_->allAsleep()) {
      engine_->step();
      freezeEscapees();
    }
    const Frame frame = record();
    Stage stage = makeStage();
    scene_->act(stage, index_);
    return frame;
  }

  std::span<const Aabb> unturnedBoxes() override {
    unturned_.resize(bodies_.size());
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      unturned_[i] = tightBox(bodies_[i]->shape(), {.position = poses_[i].position});
    }
    return unturned_;
  }

  std::span<const Pose> poses() override { return poses_; }

 private:
  [[nodiscard]] ObjectType objectType() const {
    return entryOf(objectTypes(), settings_.object_type, "object type");
  }

  [[nodiscard]] SceneInfo describe() const {
    return {.name = listing().name,
            .object_type = objectType().listing.name,
            .objects = static_cast<std::uint32_t>(settings_.objects),
            .frames = static_cast<std::uint32_t>(settings_.frames),
            .world = worldBox(settings_.side())};
  }

  [[nodiscard]] std::unique_ptr<PhysicsEngine> createEngine() const {
    return entryOf(engineEntries(), settings_.engine, "physics engine").create(settings_.physics);
  }

  /// Keeps the parameters of the engine that the settings name; another one's are forgotten.
  PhysicsEngine& chosenEngine() {
    if (!chosen_engine_ || chosen_id_ != settings_.engine.value) {
      chosen_engine_ = createEngine();
      chosen_id_ = settings_.engine.value;
    }
    return *chosen_engine_;
  }

  Stage makeStage() { return {settings_, *engine_, bodies_, random_}; }

  void addWalls() {
    for (int axis = 0; axis < 3; ++axis) {
      for (const float sign : {1.0F, -1.0F}) {
        HalfSpace wall{.offset = info_.world.min[axis]};
        wall.normal[axis] = sign;
        engine_->addWall(wall);
      }
    }
  }

  void addBodies() {
    const ObjectType type = objectType();
    bodies_.reserve(info_.objects);
    scene_->prepare(settings_, random_);
    for (std::size_t i = 0; i < info_.objects; ++i) {
      bodies_.push_back(&engine_->addBody(scene_->body(i, settings_, type, random_)));
    }
  }

  void freezeEscapees() {
    for (PhysicsBody* body : bodies_) {
      if (!body->frozen() && !contains(info_.world, body->pose().position)) body->freeze();
    }
  }

  Frame record() {
    boxes_.resize(bodies_.size());
    poses_.resize(bodies_.size());
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      poses_[i] = bodies_[i]->pose();
      boxes_[i] = tightBox(bodies_[i]->shape(), poses_[i]);
    }
    return {index_, boxes_};
  }

  std::unique_ptr<Scene> scene_;
  Settings settings_;
  mutable SceneInfo info_;
  Random random_{0};
  std::unique_ptr<PhysicsEngine> chosen_engine_;  ///< has no bodies
  std::string chosen_id_;
  std::unique_ptr<PhysicsEngine> engine_;  ///< the running one
  std::vector<PhysicsBody*> bodies_;
  std::vector<Aabb> boxes_;
  std::vector<Aabb> unturned_;
  std::vector<Pose> poses_;
  std::uint32_t index_ = 0;
};

std::vector<std::string> engineIds() {
  std::vector<std::string> ids;
  for (const EngineListing& listing : builtinEngines()) ids.push_back(listing.id);
  return ids;
}

/// A replay by the engine of this id; null if that one simulates.
std::unique_ptr<Simulation> replayBy(const std::string& engine, const SceneListing& scene) {
  for (const ReplayEntry& entry : replayEntries()) {
    if (entry.listing.id == engine) return makeReplay(scene, entry);
  }
  return nullptr;
}

std::unique_ptr<Simulation> simulationOf(const SceneEntry& scene, const std::string& engine) {
  if (auto replay = replayBy(engine, scene.listing)) return replay;
  auto simulation = std::make_unique<BuiltinSimulation>(scene);
  if (engine.empty()) return simulation;
  const std::vector<std::string> known = engineIds();
  if (std::ranges::find(known, engine) == known.end()) {
    throw InputError(unknownName("engine", engine, known));
  }
  setParameters(*simulation, {{"engine", engine}});
  return simulation;
}

std::string lowerCase(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

}  // namespace
}  // namespace scenes

std::unique_ptr<Parametrised> engineParameters(const std::string& id) {
  if (auto replay = scenes::replayBy(id, {})) return replay;
  return scenes::entryOf(scenes::engineEntries(), {id, scenes::engineIds()}, "engine").create({});
}

std::unique_ptr<Simulation> makeSimulation(const std::string& scene, const std::string& engine) {
  const std::string wanted = scenes::lowerCase(scene);
  std::vector<std::string> known;
  for (const scenes::SceneEntry& entry : scenes::sceneEntries()) {
    if (wanted == entry.listing.id || wanted == scenes::lowerCase(entry.listing.name)) {
      return scenes::simulationOf(entry, engine);
    }
    known.push_back(entry.listing.id);
  }
  throw InputError(unknownName("scene", scene, known));
}

}  // namespace broadmark
