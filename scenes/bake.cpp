// Recordings of simulations, each with a sidecar that says how it was made.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <string_view>
#include <type_traits>

#include "broadmark/atomic_file.h"
#include "broadmark/error.h"
#include "broadmark/recording.h"
#include "scenes/recorder.h"
#include "scenes/simulation.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::uint64_t kSidecarLimitBytes = 1 << 20;

fs::path sidecarPath(fs::path recording) { return recording.replace_extension(".json"); }

Json parametersJson(Simulation& simulation) {
  Json parameters = Json::object();
  simulation.visitParameters([&](const Parameter& parameter) {
    parameters[std::string(parameter.name)] = std::visit(
        [](const auto* value) -> Json {
          if constexpr (std::is_same_v<decltype(value), const Choice*>) {
            return value->value;
          } else {
            return *value;
          }
        },
        parameter.value);
  });
  return parameters;
}

/// The id of the built-in scene with this simulation's name.
std::string sceneId(const Simulation& simulation) {
  for (const SceneListing& listing : builtinScenes()) {
    if (listing.name == simulation.scene().name) return listing.id;
  }
  return simulation.scene().name;
}

/// What makes a simulation's frames what they are. Of a replayed recording its contents count, not
/// where it lies.
Json identityJson(Simulation& simulation) {
  Json parameters = parametersJson(simulation);
  if (const fs::path input = simulation.input(); !input.empty()) {
    parameters["input"] = openRecordingFile(input)->hash();
  }
  return {{"schema", "broadmark-bake/1"},
          {"scene", sceneId(simulation)},
          {"parameters", std::move(parameters)}};
}

/// A recorder's key for the hash of its recording: "hash" for boxes, which always were called so.
std::string hashKey(const fs::path& recording) {
  const std::string extension = recording.extension().string();
  return extension == kAabbsExtension ? "hash" : extension.substr(1) + "_hash";
}

/// The hashes that the sidecar of `recording` states, by key, if it is one of recordings with this
/// identity. The order of keys does not count.
Json statedHashes(const fs::path& recording, const Json& identity) {
  const std::string text = readTextFile(sidecarPath(recording), kSidecarLimitBytes);
  const auto found = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!found.is_object()) return Json::object();
  nlohmann::json rest = found;
  Json hashes = Json::object();
  for (const auto& [key, value] : found.items()) {
    if (!key.ends_with("hash") || !value.is_string()) continue;
    hashes[key] = value.get<std::string>();
    rest.erase(key);
  }
  return rest == nlohmann::json(identity) ? hashes : Json::object();
}

/// Notes a recording's hash in its sidecar, keeping those of its kin of the same identity.
void addToSidecar(const fs::path& recording, Json identity, const std::string& hash) {
  Json hashes = Json::object();
  try {
    hashes = statedHashes(recording, identity);
  } catch (const InputError&) {
    // There is none yet.
  }
  hashes[hashKey(recording)] = hash;
  identity.update(hashes);
  writeTextFile(sidecarPath(recording), identity.dump(2) + "\n");
}

scenes::RecorderEntry recorderOf(const fs::path& path) {
  std::vector<std::string> extensions;
  for (const scenes::RecorderEntry& entry : scenes::recorderEntries()) {
    extensions.push_back("." + entry.listing.id);
    if (path.extension() == extensions.back()) return entry;
  }
  throw InputError(fmt::format("{}: the name of a recording must end in {}", path.string(),
                               fmt::join(extensions, " or ")));
}

/// A sidecar beside the input would take the place of the input's own.
void requireApart(const fs::path& path, const fs::path& input) {
  const auto sidecar = [](const fs::path& recording) {
    return sidecarPath(fs::weakly_canonical(recording));
  };
  if (input.empty() || sidecar(path) != sidecar(input)) return;
  throw InputError(
      fmt::format("{}: would be written over the recording that is replayed: another "
                  "directory is needed",
                  path.string()));
}

}  // namespace

bool isBaked(const fs::path& path, Simulation& simulation) {
  try {
    const Json hashes = statedHashes(path, identityJson(simulation));
    const auto hash = hashes.find(hashKey(path));
    if (hash == hashes.end()) return false;
    const auto recording = openRecordingFile(path);
    return recording->scene() == simulation.scene() && recording->hash() == *hash;
  } catch (const InputError&) {
    return false;  // missing or damaged: to be baked anew
  }
}

std::string bake(Simulation& simulation, const fs::path& path, const FrameProgress& progress,
                 const std::vector<fs::path>& more) {
  std::vector<fs::path> paths = {path};
  paths.insert(paths.end(), more.begin(), more.end());
  std::vector<std::unique_ptr<scenes::Recorder>> recorders;
  for (const fs::path& each : paths) {
    requireApart(each, simulation.input());
    recorders.push_back(recorderOf(each).create(each, simulation.scene()));
  }
  const auto record = [&](const Frame& frame) {
    for (const auto& recorder : recorders) recorder->record(frame, simulation);
  };
  if (!recordAll(simulation, record, progress)) return {};

  const Json identity = identityJson(simulation);
  std::string first;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const std::string hash = recorders[i]->finish();
    addToSidecar(paths[i], identity, hash);
    if (i == 0) first = hash;
  }
  return first;
}

}  // namespace broadmark
