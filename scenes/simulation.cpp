// The simulations of built-in scenes, found by name.

#include "broadmark/scenes/simulation.h"

#include <algorithm>
#include <cctype>

#include "broadmark/error.h"
#include "broadmark/names.h"
#include "broadmark/recordings/recording.h"
#include "broadmark/scenes/scene.h"
#include "engines/replay.h"
#include "entries.h"
#include "physics_simulation.h"

namespace broadmark {
namespace scenes {
namespace {

class BuiltinSimulation final : public PhysicsSimulation {
 public:
  explicit BuiltinSimulation(const SceneEntry& entry)
      : PhysicsSimulation(entry.listing), scene_(entry.create()) {
    scene_->setDefaults(settings_);
  }

  void visitParameters(const ParameterVisitor& visit) override {
    settings_.visit([&](const Parameter& parameter) {
      const std::string engine = settings_.engine.value;
      visit(parameter);
      if (settings_.engine.value != engine) adaptDefaults(engine);
    });
    scene_->visitParameters(visit);
    engine_parameters_.parameters(settings_.engine.value, settings_.physics).visitParameters(visit);
  }

 private:
  /// The scene's defaults for an engine.
  [[nodiscard]] Settings defaultsFor(const std::string& engine) const {
    Settings defaults;
    defaults.engine.value = engine;
    scene_->setDefaults(defaults);
    return defaults;
  }

  /// Gives all settings still at their defaults for the `former` engine those for the current one.
  void adaptDefaults(const std::string& former) {
    const auto parameters_of = [](Settings& settings) {
      std::vector<Parameter> parameters;
      settings.visit([&](const Parameter& parameter) { parameters.push_back(parameter); });
      return parameters;
    };
    Settings before = defaultsFor(former);
    Settings after = defaultsFor(settings_.engine.value);
    const std::vector<Parameter> old_defaults = parameters_of(before);
    const std::vector<Parameter> new_defaults = parameters_of(after);
    const std::vector<Parameter> current = parameters_of(settings_);
    for (std::size_t i = 0; i < current.size(); ++i) {
      const std::string fresh = parameterText(new_defaults[i]);
      const std::string stale = parameterText(old_defaults[i]);
      if (current[i].name == "engine" || fresh == stale) continue;
      if (parameterText(current[i]) == stale) setParameter(current[i], fresh);
    }
  }

  [[nodiscard]] ObjectType objectType() const {
    return entryOf(objectTypes(), settings_.object_type.value, "object type");
  }

  [[nodiscard]] SceneInfo describe() const override {
    SceneInfo info{.name = listing().name,
                   .object_type = objectType().listing.name,
                   .objects = static_cast<std::uint32_t>(settings_.objects),
                   .frames = static_cast<std::uint32_t>(settings_.frames),
                   .world = settings_.world()};
    scene_->describe(settings_, info);
    return info;
  }

  [[nodiscard]] std::unique_ptr<PhysicsEngine> createEngine() override {
    return engine_parameters_.create(settings_.engine.value, settings_.physics);
  }

  [[nodiscard]] LayerMatrix pushing(const SceneInfo& info) const override {
    return scene_->pushing(info);
  }

  void start() override {
    random_ = Random(static_cast<std::uint64_t>(settings_.seed));
    running_type_ = objectType();
    scene_->prepare(settings_, random_);
    Stage stage = makeStage();
    scene_->populate(stage);
    scene_->start(stage);
  }

  void act(std::uint32_t frame) override {
    Stage stage = makeStage();
    scene_->act(stage, frame);
  }

  Stage makeStage() { return {settings_, running_type_, engine(), bodies(), random_}; }

  std::unique_ptr<Scene> scene_;
  Settings settings_;
  ChosenEngine engine_parameters_;
  ObjectType running_type_;
  Random random_{0};
};

/// Throws InputError unless an engine, replay engines included, has this id.
void requireEngine(const std::string& id) {
  std::vector<std::string> ids;
  for (const EngineListing& listing : availableEngines()) ids.push_back(listing.id);
  if (std::ranges::find(ids, id) == ids.end()) {
    throw InputError(unknownName("engine", id, ids));
  }
}

/// A replay by the engine with this id; null if it is not a replay engine. `scene` may be null: no
/// particular scene.
std::unique_ptr<Simulation> replayBy(const std::string& engine, const SceneEntry* scene) {
  for (const ReplayEntry& entry : replayEntries()) {
    if (entry.listing.id != engine) continue;
    if (scene == nullptr) return makeReplay({}, entry, {});
    return makeReplay(scene->listing, entry, recordingExtension(BuiltinSimulation(*scene).scene()));
  }
  return nullptr;
}

std::unique_ptr<Simulation> simulationOf(const SceneEntry& scene, const std::string& engine) {
  if (auto replay = replayBy(engine, &scene)) return replay;
  auto simulation = std::make_unique<BuiltinSimulation>(scene);
  if (engine.empty()) return simulation;
  requireEngine(engine);
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
  if (auto replay = scenes::replayBy(id, nullptr)) return replay;
  scenes::requireEngine(id);
  return scenes::entryOf(scenes::engineEntries(), id, "engine").create({});
}

std::unique_ptr<Simulation> makeSimulation(const std::string& scene, const std::string& engine) {
  const std::string name = scenes::lowerCase(scene);
  std::vector<std::string> ids;
  for (const scenes::SceneEntry& entry : scenes::sceneEntries()) {
    if (name == entry.listing.id || name == scenes::lowerCase(entry.listing.name)) {
      return scenes::simulationOf(entry, engine);
    }
    ids.push_back(entry.listing.id);
  }
  throw InputError(unknownName("scene", scene, ids));
}

}  // namespace broadmark
