// Sources from scenes, recordings and imported files.

#include "sources/make_source.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>

#include "broadmark/error.h"
#include "broadmark/json_fields.h"
#include "broadmark/names.h"
#include "broadmark/recordings/adapted_frames.h"
#include "broadmark/recordings/recording.h"
#include "request/sweep.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

/// Scene parameters with their own options, as text.
ParameterValues statedValues(const SceneOptions& options) {
  ParameterValues values = options.parameters;
  if (!options.objects.empty()) {
    values["objects"] = fmt::format("{}", fmt::join(options.objects, ","));
  }
  if (!options.object_types.empty()) {
    values["object_type"] = fmt::format("{}", fmt::join(options.object_types, ","));
  }
  return values;
}

void requireStatedOnce(const ParameterValues& stated, const ParameterValues& parameters) {
  for (const auto& [name, text] : stated) {
    if (!parameters.contains(name)) continue;
    throw InputError(
        fmt::format("--param: '{}' is given twice: {} also sets it", name, parameterOption(name)));
  }
}

/// The engines requested by --engine or --param; a single "": the default.
std::vector<std::string> enginesOf(const ParameterValues& stated,
                                   const ParameterValues& parameters) {
  for (const ParameterValues* values : {&stated, &parameters}) {
    const auto engine = values->find("engine");
    if (engine != values->end()) return valuesIn(engine->second);
  }
  return {""};
}

std::unique_ptr<Simulation> simulationOf(NamedSource& scene, const std::string& engine) {
  if (isSceneId(scene.name()) || !scene.isFile()) return makeSimulation(scene.name(), engine);
  return parseSceneParameters(scene.text(), scene.name());
}

/// Throws InputError for options of bodies, sizes or positions if an authored scene defines them.
void requireApplicable(Simulation& simulation, const std::string& scene,
                       const ParameterValues& options) {
  if (simulation.listing().id != kAuthoredSceneId) return;
  const std::vector<std::string> known = parameterNames(simulation);
  for (const auto& [name, value] : options) {
    if (std::ranges::find(known, name) != known.end()) continue;
    throw InputError(
        fmt::format("{}: {}: an authored scene defines its own bodies: omit the option", scene,
                    parameterOption(name)));
  }
}

/// Sets `swept` to the `given` parameters that differ between simulations, except those that are
/// part of every recording's name.
void setSweptParameters(std::vector<SweptSimulation>& simulations, const ParameterValues& given) {
  const auto values_of = [&](const std::string& name) {
    std::vector<std::string> values;  // "": the simulation has no such parameter
    for (const auto& [simulation, swept] : simulations) {
      values.push_back(parameterValues(*simulation)[name]);
    }
    return values;
  };
  for (const auto& [name, text] : given) {
    if (name == "objects" || name == "object_type" || name == "frames") continue;
    const std::vector<std::string> values = values_of(name);
    if (std::ranges::adjacent_find(values, std::ranges::not_equal_to()) == values.end()) continue;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!values[i].empty()) simulations[i].swept[name] = values[i];
    }
  }
}

/// Whether a source is imported in this way even if no format is stated.
bool isRecognised(const std::string& name, const FileImport& import) {
  const auto found = importOf(name);
  return found && found->formats == import.formats && import.formats.size() == 1;
}

}  // namespace

std::string recordingKindsText() {
  return fmt::format("recordings ({})", fmt::join(recordingExtensions(), ", "));
}

std::vector<std::string> sceneIds() {
  std::vector<std::string> ids;
  for (const SceneListing& scene : builtinScenes()) ids.push_back(scene.id);
  return ids;
}

bool isSceneId(const std::string& name) { return std::ranges::count(sceneIds(), name) > 0; }

Source simulationSource(std::unique_ptr<Simulation> simulation) {
  Source source;
  RecordingReference& reference = source.reference;
  reference.scene = simulation->scene();
  reference.scene_parameters = parameterValues(*simulation);
  if (simulation->listing().id == kAuthoredSceneId) {
    reference.scene_parameters[kSceneFile] = simulation->input().string();
  }
  // A replay has no seed.
  if (const auto seed = reference.scene_parameters.find("seed");
      seed != reference.scene_parameters.end()) {
    reference.seed = static_cast<std::uint64_t>(
        parseInteger(seed->second, "seed", 0, std::numeric_limits<long long>::max()));
  }
  source.simulation = std::move(simulation);
  return source;
}

Source recordingSource(const fs::path& path) {
  Source source;
  source.reference.path = path.string();
  source.reference.scene = openRecordingFile(path)->scene();
  return source;
}

Source importedSource(const std::vector<std::string>& names, const FileImport& import,
                      ReadingOptions options) {
  Source source;
  source.imported =
      import.open(filesToImport(names, import, options.format.value), options, source.summary);
  source.reference.scene = source.imported->scene();
  source.reference.path = NamedSource(names.front()).name();
  std::vector<std::string> left_out = source.summary.left_out;
  std::ranges::copy(source.summary.warnings, std::back_inserter(left_out));
  if (options.strict && !left_out.empty()) {
    throw InputError(fmt::format("{}: --strict: left out: {}", source.reference.path,
                                 onOneLine(fmt::format("{}", fmt::join(left_out, "; ")))));
  }
  source.reference.reading = options.changed();
  // A format is stated only if it is needed to read the file again.
  const bool needs_format = options.format.value != "auto" && !isRecognised(names.front(), import);
  std::erase_if(source.reference.reading, [&](const auto& option) {
    if (option.first == "format") return !needs_format;
    return std::ranges::find(import.options, option.first) == import.options.end();
  });
  return source;
}

Source fileSource(const std::vector<std::string>& names, const ReadingOptions& reading) {
  const auto import = importOf(names.front(), reading.format.value);
  std::vector<PlanEntry> entries(1);
  Source& source = entries.front().source;
  source = import ? importedSource(names, *import, reading) : recordingSource(names.front());
  adaptBoxes(source, reading);
  requireReadingUsed(reading, entries);
  return std::move(source);
}

void adaptBoxes(Source& source, ReadingOptions reading) {
  const ParameterValues adapters = adaptersIn(reading.changed());
  RecordingReference& reference = source.reference;
  reference.scene = adaptedScene(std::move(reference.scene), adapters);
  reference.reading.insert(adapters.begin(), adapters.end());
}

fs::path resolvedPath(const fs::path& file, const std::string& stated) {
  const fs::path relative = file.parent_path() / stated;
  return !fs::exists(stated) && fs::exists(relative) ? relative : fs::path(stated);
}

std::vector<SweptSimulation> makeSimulations(NamedSource& scene, const SceneOptions& options,
                                             const ParameterValues& parameters) {
  const ParameterValues stated = statedValues(options);
  requireStatedOnce(stated, parameters);
  std::vector<SweptSimulation> simulations;
  for (const std::string& engine : enginesOf(stated, parameters)) {
    const auto make = [&] {
      auto simulation = simulationOf(scene, engine);
      requireApplicable(*simulation, scene.name(), stated);
      // Set the engine first, as it adds parameters.
      if (!engine.empty()) setParameters(*simulation, {{"engine", engine}});
      return simulation;
    };
    const auto first = make();
    ParameterValues texts = stated;
    texts.merge(applicableValues(*first, parameters));
    if (!engine.empty()) texts["engine"] = engine;
    for (const ParameterValues& values : combinations(*first, texts)) {
      auto simulation = make();
      setParameters(*simulation, values);
      simulations.push_back({std::move(simulation), {}});
    }
  }
  ParameterValues given = stated;
  given.insert(parameters.begin(), parameters.end());
  setSweptParameters(simulations, given);
  return simulations;
}

OpenedSource openScene(NamedSource& scene, const OpeningOptions& options) {
  OpenedSource opened;
  for (auto& [simulation, swept] : makeSimulations(scene, options.scene, options.parameters)) {
    PlanEntry entry{.source = simulationSource(std::move(simulation)), .cases = {}};
    entry.source.reference.swept = std::move(swept);
    opened.entries.push_back(std::move(entry));
  }
  return opened;
}

}  // namespace broadmark
