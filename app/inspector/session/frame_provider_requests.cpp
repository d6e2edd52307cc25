#include "inspector/session/frame_provider_requests.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/recordings/adapted_frames.h"
#include "broadmark/recordings/recording.h"
#include "run/recordings.h"
#include "sources/make_source.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

/// The parameters that a recording was baked with; "" if they are unknown or invalid.
std::string parametersOf(const Recording& recording, const fs::path& path) {
  try {
    const std::string& stated = recording.origin().scene_parameters;
    const std::string text = stated.empty() ? bakedParameters(path) : stated;
    return text.empty() ? "" : formatSceneParameters(*parseSceneParameters(text, path.string()));
  } catch (const InputError&) {
    return "";
  }
}

}  // namespace

FrameProviderRequest simulationSource(Simulation& simulation, ParameterValues reading) {
  const std::string text = formatSceneParameters(simulation);
  return {.open =
              [text, reading = std::move(reading)](const SimulationHost& host,
                                                   const CancelQuery& cancelled) {
                return std::make_unique<FrameProvider>(
                    host(parseSceneParameters(text, "scene parameters"), cancelled), reading);
              },
          .origin = FrameOrigin::simulation,
          .title = simulation.listing().name,
          .scene_parameters = text};
}

FrameProviderRequest recordingSource(const fs::path& path, const std::string& hash,
                                     ParameterValues reading) {
  // Open the file here, too, so that an invalid one is reported at once.
  const std::string parameters = parametersOf(*openRecordingFile(path), path);
  const auto open = [path, hash, reading = std::move(reading)](const SimulationHost&,
                                                               const CancelQuery& cancelled) {
    std::unique_ptr<Recording> recording = openRecordingFile(path);
    if (!hash.empty()) {
      requireHash(path.string(), adaptedHash(recording->hash(cancelled), reading), hash);
    }
    return std::make_unique<FrameProvider>(std::move(recording), reading);
  };
  return {.open = open,
          .origin = FrameOrigin::recording,
          .title = path.filename().string(),
          .recording = path,
          .scene_parameters = parameters};
}

FrameProviderRequest importSource(Source& source, ParameterValues reading) {
  const RecordingReference& reference = source.reference;
  // Consumed by the first opening; later ones read the files again.
  const auto first = std::make_shared<std::unique_ptr<IndexedFrames>>(std::move(source.imported));
  const auto open = [reference, first, reading = std::move(reading)](
                        const SimulationHost&,
                        const CancelQuery& cancelled) -> std::unique_ptr<FrameProvider> {
    if (*first) return std::make_unique<FrameProvider>(std::move(*first), reading);
    ReadingOptions options;
    setParameters(options, reference.reading);
    options.progress = [&cancelled](double) { return !cancelled(); };
    const auto import = importOf(reference.path, options.format.value);
    if (!import) throw InputError(fmt::format("{}: no longer exists", reference.path));
    Source again = importedSource({reference.path}, *import, options);
    return std::make_unique<FrameProvider>(std::move(again.imported), reading);
  };
  return {.open = open,
          .origin = FrameOrigin::import,
          .title = fs::path(reference.path).filename().string()};
}

ParameterValues sceneParametersOf(const FrameProviderRequest* source) {
  if (source == nullptr || source->scene_parameters.empty()) return {};
  const auto simulation = parseSceneParameters(source->scene_parameters, source->title);
  ParameterValues values = parameterValues(*simulation);
  values["scene"] = simulation->listing().id;
  return values;
}

void Draft::choose(const std::string& id) {
  ParameterValues values = parameterValues(*scene_);
  scene_ = makeSimulation(id);
  // Copy the parameters that the scenes may share.
  for (const char* shared : {"objects", "frames", "object_type", "seed", "engine"}) {
    const auto value = values.find(shared);
    const ParameterValues supported = parameterValues(*scene_);
    if (value == values.end() || !supported.contains(shared)) continue;
    setParameters(*scene_, {*value});
  }
}

bool Draft::isOpen() const {
  return playback_.source() &&
         playback_.source()->scene_parameters == formatSceneParameters(*scene_);
}

}  // namespace broadmark
