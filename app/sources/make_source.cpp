// Scenes and recordings as sources.

#include "sources/make_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "broadmark/error.h"
#include "broadmark/names.h"
#include "broadmark/recording.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

/// One of the simulations that options ask for: "" and nothing stand for the scene's default.
struct Axes {
  std::string object_type;
  std::optional<std::uint32_t> objects;

  [[nodiscard]] ParameterValues values() const {
    ParameterValues values;
    if (objects) values["objects"] = fmt::format("{}", *objects);
    if (!object_type.empty()) values["object_type"] = object_type;
    return values;
  }
};

std::vector<Axes> axesOf(const SceneOptions& options) {
  std::vector<std::string> types = options.object_types;
  if (types.empty()) types.emplace_back();
  std::vector<std::optional<std::uint32_t>> counts(options.objects.begin(), options.objects.end());
  if (counts.empty()) counts.emplace_back();
  std::vector<Axes> axes;
  for (const std::string& type : types) {
    for (const auto& count : counts) axes.push_back({type, count});
  }
  return axes;
}

/// The engine asked for, by its own option or by --param; "": the default.
std::string engineOf(const SceneOptions& options, const ParameterValues& parameters) {
  for (const ParameterValues* values : {&options.parameters, &parameters}) {
    if (const auto engine = values->find("engine"); engine != values->end()) return engine->second;
  }
  return {};
}

std::unique_ptr<Simulation> simulationOf(NamedSource& scene, const std::string& engine) {
  if (isSceneId(scene.name()) || !scene.isFile()) return makeSimulation(scene.name(), engine);
  return parseSceneParameters(scene.text(), scene.name());
}

/// Bodies, sizes and places are stated by an authored scene itself: options for them are mistakes.
void requireApplicable(Simulation& simulation, const std::string& scene,
                       const ParameterValues& options) {
  if (simulation.listing().id != kAuthoredSceneId) return;
  const std::vector<std::string> known = parameterNames(simulation);
  for (const auto& [name, value] : options) {
    if (std::ranges::find(known, name) != known.end()) continue;
    std::string option = "--" + name;
    std::ranges::replace(option, '_', '-');
    throw InputError(fmt::format(
        "{}: {}: an authored scene states its bodies itself: leave the option out", scene, option));
  }
}

RecordingReference referenceTo(Simulation& simulation) {
  RecordingReference reference;
  reference.scene = simulation.scene();
  reference.scene_parameters = parameterValues(simulation);
  if (simulation.listing().id == kAuthoredSceneId) {
    reference.scene_parameters[kSceneFile] = simulation.input().string();
  }
  // A replay has no seed.
  if (const auto seed = reference.scene_parameters.find("seed");
      seed != reference.scene_parameters.end()) {
    reference.seed = static_cast<std::uint64_t>(
        parseInteger(seed->second, "seed", 0, std::numeric_limits<long long>::max()));
  }
  return reference;
}

}  // namespace

bool isSceneId(const std::string& name) {
  return std::ranges::any_of(builtinScenes(),
                             [&](const SceneListing& scene) { return scene.id == name; });
}

Source simulationSource(std::unique_ptr<Simulation> simulation) {
  Source source;
  source.reference = referenceTo(*simulation);
  source.simulation = std::move(simulation);
  return source;
}

Source recordingSource(const fs::path& path) {
  Source source;
  source.reference.path = path.string();
  source.reference.scene = openRecordingFile(path)->scene();
  return source;
}

fs::path statedPath(const fs::path& file, const std::string& stated) {
  const fs::path beside = file.parent_path() / stated;
  return !fs::exists(stated) && fs::exists(beside) ? beside : fs::path(stated);
}

std::vector<std::unique_ptr<Simulation>> makeSimulations(NamedSource& scene,
                                                         const SceneOptions& options,
                                                         const ParameterValues& parameters) {
  const std::string engine = engineOf(options, parameters);
  std::vector<std::unique_ptr<Simulation>> simulations;
  for (const Axes& axes : axesOf(options)) {
    auto simulation = simulationOf(scene, engine);
    requireApplicable(*simulation, scene.name(), options.parameters);
    requireApplicable(*simulation, scene.name(), axes.values());
    // The engine first: it brings parameters of its own.
    if (!engine.empty()) setParameters(*simulation, {{"engine", engine}});
    setParameters(*simulation, options.parameters);
    setParameters(*simulation, applicableValues(*simulation, parameters));
    setParameters(*simulation, axes.values());
    simulations.push_back(std::move(simulation));
  }
  return simulations;
}

OpenedSource openScene(NamedSource& scene, const OpeningOptions& options) {
  OpenedSource opened;
  for (auto& simulation : makeSimulations(scene, options.scene, options.parameters)) {
    opened.entries.push_back({.source = simulationSource(std::move(simulation)), .cases = {}});
  }
  return opened;
}

}  // namespace broadmark
