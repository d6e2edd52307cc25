// Sources of a run, and baking.

#include "recordings.h"

#include <fmt/format.h>

#include <algorithm>

#include "case_reference.h"
#include "cases.h"
#include "interrupt.h"
#include "progress.h"
#include "broadmark/files.h"
#include "broadmark/error.h"
#include "broadmark/names.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

/// In results, beside the parameters of an authored scene: where its bodies are.
constexpr const char* kSceneFile = "scene_file";

bool isSceneName(const std::string& source) {
  return std::ranges::any_of(builtinScenes(),
                             [&](const SceneListing& scene) { return scene.id == source; });
}

bool looksLikeFile(const std::string& source) {
  return source.find('/') != std::string::npos || fs::path(source).has_extension() ||
         fs::exists(source);
}

/// Whether a source is a file that describes a scene: an authored one, or parameters.
bool isSceneFile(const std::string& source) {
  return fs::path(source).extension() == ".json" &&
         describesScene(jsonKind(readTextFile(source), source));
}

/// The simulation that a scene's name, moved by this engine ("": the default one), or a file that
/// describes a scene stands for.
std::unique_ptr<Simulation> simulationOf(const std::string& scene, const std::string& engine) {
  if (!looksLikeFile(scene)) return makeSimulation(scene, engine);
  return parseSceneParameters(readTextFile(scene), scene);
}

/// An authored scene says itself which bodies there are and where: options that would say it anew
/// are mistakes.
void requireApplicable(Simulation& simulation, const std::string& scene,
                       const ParameterValues& options) {
  if (simulation.listing().id != kAuthoredSceneId) return;
  const std::vector<std::string> known = parameterNames(simulation);
  for (const auto& [name, value] : options) {
    if (std::ranges::find(known, name) != known.end()) continue;
    std::string option = "--" + name;
    std::ranges::replace(option, '_', '-');
    throw InputError(fmt::format(
        "{}: {}: bodies, sizes and places are those of the authored scene: leave the option out",
        scene, option));
  }
}

/// Sets those of the values that the object has.
void setApplicable(Parametrised& object, const ParameterValues& values) {
  object.visitParameters([&](const Parameter& parameter) {
    const auto value = values.find(std::string(parameter.name));
    if (value != values.end()) setParameter(parameter, value->second);
  });
}

RecordingReference referenceTo(Simulation& simulation) {
  RecordingReference reference;
  reference.scene = simulation.scene();
  reference.scene_parameters = parameterValues(simulation);
  if (simulation.listing().id == kAuthoredSceneId) {
    reference.scene_parameters[kSceneFile] = simulation.input().string();
  }
  // A replay has none.
  if (const auto seed = reference.scene_parameters.find("seed");
      seed != reference.scene_parameters.end()) {
    reference.seed = static_cast<std::uint64_t>(
        parseInteger(seed->second, "seed", 0, std::numeric_limits<long long>::max()));
  }
  return reference;
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

/// A path in a file: as given, else relative to that file.
fs::path besides(const fs::path& file, const std::string& path) {
  const fs::path beside = file.parent_path() / path;
  return !fs::exists(path) && fs::exists(beside) ? beside : fs::path(path);
}

Source jsonSource(const fs::path& path) {
  const std::string text = readTextFile(path);
  const std::string kind = jsonKind(text, path.string());
  if (kind == kResultsSchema) throw missingCase(parseResults(text, path.string()), path);
  if (kind != "original-settings") {
    throw InputError(fmt::format(
        "{}: {}: an authored scene (\"schema\": \"broadmark-scene/1\"), scene parameters "
        "(\"broadmark-scene-parameters/1\") or a settings file of the original Broadmark (with "
        "m_inputScene) are expected",
        path.string(), kind.empty() ? "of no known kind" : fmt::format("of the kind '{}'", kind)));
  }
  const OriginalSettings settings = parseOriginalSettings(text, path.string());
  Source source = recordingSource(besides(path, settings.input_scene));
  source.settings = settings;
  return source;
}

Source fileSource(const fs::path& path) {
  if (path.extension() == ".json") return jsonSource(path);
  return recordingSource(path);
}

std::vector<std::string> sceneIds() {
  std::vector<std::string> ids;
  for (const SceneListing& scene : builtinScenes()) ids.push_back(scene.id);
  return ids;
}

/// Simulates into `write`, a function that records one source with a progress callback.
template <class Record>
bool simulateWithProgress(Simulation& simulation, bool quiet, Record&& record) {
  const SceneInfo scene = simulation.scene();
  Progress progress(fmt::format("baking {} {} N{}", scene.name, scene.object_type, scene.objects),
                    scene.frames, quiet);
  return record([&](std::uint32_t frame) {
    progress.update(frame);
    return !InterruptGuard::requested();
  });
}

/// Bakes a simulation below `directory`, unless it is already there. Returns the path of the first
/// recorder's recording, or "" when interrupted.
fs::path bakeInto(Simulation& simulation, const fs::path& directory,
                  const std::vector<std::string>& recorders, bool quiet) {
  const auto paths = recordingPaths(directory, simulation.scene(), recorders);
  const auto there = [&](const fs::path& path) { return isBaked(path, simulation); };
  if (std::ranges::all_of(paths, there)) return paths.front();
  for (const fs::path& path : paths) makeDirectory(path.parent_path());
  const bool whole = simulateWithProgress(simulation, quiet, [&](const FrameProgress& progress) {
    return bake(simulation, paths, progress);
  });
  return whole ? paths.front() : fs::path();
}

std::unique_ptr<Recording> simulateTemporary(Simulation& simulation, bool quiet) {
  RecordingWriter writer(simulation.scene());
  const bool whole = simulateWithProgress(simulation, quiet, [&](const FrameProgress& progress) {
    return recordAll(simulation, writer, progress);
  });
  return whole ? writer.finishTemporary() : nullptr;
}

void requireExpected(const Source& source) {
  requireHash(
      source.simulation ? source.reference.scene.name + " simulated anew" : source.reference.path,
      source.reference.hash, source.expected_hash);
}

/// The engine asked for, by its own option or by --param; "": the default.
std::string engineOf(const SceneOptions& options, const ParameterValues& parameters) {
  for (const ParameterValues& values : {options.parameters, parameters}) {
    if (const auto engine = values.find("engine"); engine != values.end()) return engine->second;
  }
  return {};
}

}  // namespace

bool isSource(const std::string& text) { return isSceneName(text) || looksLikeFile(text); }

std::vector<std::unique_ptr<Simulation>> makeSimulations(const std::vector<std::string>& scenes,
                                                         const SceneOptions& options,
                                                         const ParameterValues& parameters) {
  std::vector<std::unique_ptr<Simulation>> simulations;
  const std::string engine = engineOf(options, parameters);
  // An empty list stands for the scene's own default.
  auto counts = options.objects;
  std::ranges::sort(counts);
  const std::size_t count_choices = std::max<std::size_t>(counts.size(), 1);
  const std::size_t type_choices = std::max<std::size_t>(options.object_types.size(), 1);
  for (const std::string& scene : scenes) {
    for (std::size_t type = 0; type < type_choices; ++type) {
      for (std::size_t count = 0; count < count_choices; ++count) {
        ParameterValues axes;
        if (!counts.empty()) axes["objects"] = fmt::format("{}", counts[count]);
        if (!options.object_types.empty()) axes["object_type"] = options.object_types[type];
        auto simulation = simulationOf(scene, engine);
        requireApplicable(*simulation, scene, options.parameters);
        requireApplicable(*simulation, scene, axes);
        setParameters(*simulation, options.parameters);  // the engine first: it brings its own
        setApplicable(*simulation, parameters);
        setParameters(*simulation, axes);
        simulations.push_back(std::move(simulation));
      }
    }
  }
  return simulations;
}

std::vector<Source> resolveSources(const HeadlessOptions& options) {
  std::vector<Source> sources;
  for (const std::string& name : options.sources) {
    if (!isSceneName(name) && !isSceneFile(name)) {
      if (!looksLikeFile(name)) {
        throw InputError(unknownName("scene", name, sceneIds()) + ", and no such file");
      }
      sources.push_back(fileSource(name));
      continue;
    }
    for (auto& simulation : makeSimulations({name}, options.scene, options.parameters)) {
      sources.push_back(simulationSource(std::move(simulation)));
    }
  }
  return sources;
}

Source referredSource(const RecordingReference& reference, const fs::path& results_file) {
  Source source;
  if (!reference.path.empty()) {
    source = recordingSource(besides(results_file, reference.path));
  } else {
    ParameterValues parameters = reference.scene_parameters;
    const auto file = parameters.extract(kSceneFile);
    // Which brings parameters of its own.
    const std::string engine = parameters.contains("engine") ? parameters["engine"] : "";
    auto simulation = file.empty()
                          ? makeSimulation(reference.scene.name, engine)
                          : simulationOf(besides(results_file, file.mapped()).string(), engine);
    setParameters(*simulation, parameters);
    source = simulationSource(std::move(simulation));
  }
  source.expected_hash = reference.hash;
  return source;
}

std::unique_ptr<Recording> openRecording(Source& source, const fs::path& directory,
                                         const std::vector<std::string>& recorders, bool quiet) {
  std::unique_ptr<Recording> recording;
  if (!source.simulation) {
    recording = openRecordingFile(source.reference.path);
  } else if (directory.empty()) {
    recording = simulateTemporary(*source.simulation, quiet);
  } else if (const fs::path path = bakeInto(*source.simulation, directory, recorders, quiet);
             !path.empty()) {
    recording = openRecordingFile(path);
  }
  if (recording) source.reference.hash = recording->hash();
  if (recording && !source.expected_hash.empty()) requireExpected(source);
  return recording;
}

void requireHash(const std::string& what, const std::string& hash, const std::string& expected) {
  if (hash == expected) return;
  throw InputError(fmt::format("{}: not the recording that the case ran on: its hash is {}, not {}",
                               what, hash, expected));
}

std::vector<fs::path> recordingPaths(const fs::path& directory, const SceneInfo& scene,
                                     const std::vector<std::string>& recorders) {
  std::vector<fs::path> paths;
  const std::vector<RecorderListing> listings = builtinRecorders();
  for (const std::string& id : recorders) {
    const auto listing = std::ranges::find(listings, id, &RecorderListing::id);
    paths.push_back(directory / listing->folder / recordingFileName(scene, "." + id));
  }
  return paths;
}

void makeDirectory(const fs::path& directory) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) {
    throw InputError(
        fmt::format("{}: cannot create the directory: {}", directory.string(), error.message()));
  }
}

}  // namespace broadmark
