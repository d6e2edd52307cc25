// Recordings of simulations, each with a sidecar that says how it was made.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "broadmark/files.h"
#include "broadmark/error.h"
#include "broadmark/recording.h"
#include "recorders/recorder.h"
#include "scene_parameters.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::uint64_t kSidecarLimitBytes = 1 << 20;

fs::path sidecarPath(fs::path recording) { return recording.replace_extension(".json"); }

/// What stands beside a recording with this hash. Of an input its contents count, not where it
/// lies.
Json sidecarJson(Simulation& simulation, const std::string& hash) {
  Json json = sceneParametersJson(simulation, kBakeSchema);
  if (const std::string input = simulation.inputHash(); !input.empty()) {
    json["parameters"].erase("input");
    json["input_hash"] = input;
  }
  json["hash"] = hash;
  return json;
}

/// The hash that a sidecar's text states, if it is the sidecar of a recording of this simulation.
/// The order of keys does not count.
std::optional<std::string> statedHash(const std::string& text, Simulation& simulation) {
  const auto found = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!found.is_object() || !found.contains("hash") || !found["hash"].is_string()) return {};
  auto hash = found["hash"].get<std::string>();
  if (found != nlohmann::json(sidecarJson(simulation, hash))) return {};
  return hash;
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

}  // namespace

bool isBaked(const fs::path& path, Simulation& simulation) {
  try {
    const std::string sidecar = readTextFile(sidecarPath(path), kSidecarLimitBytes);
    const std::optional<std::string> hash = statedHash(sidecar, simulation);
    if (!hash) return false;
    const auto recording = openRecordingFile(path);
    return recording->scene() == simulation.scene() && recording->hash() == *hash;
  } catch (const InputError&) {
    return false;  // missing or damaged: to be baked anew
  }
}

std::optional<std::string> bakedHash(const fs::path& recording) {
  const fs::path path = sidecarPath(recording);
  if (!fs::exists(path)) return std::nullopt;
  const std::string text = readTextFile(path, kSidecarLimitBytes);
  const auto json = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || json.value("schema", Json()) != kBakeSchema) return std::nullopt;
  if (!json.contains("hash") || !json["hash"].is_string()) {
    throw InputError(fmt::format("{}: states no hash: bake anew with --force", path.string()));
  }
  return json["hash"].get<std::string>();
}

void requireApart(Simulation& simulation, const std::vector<fs::path>& paths) {
  const fs::path input = simulation.input();
  const auto place = [](const fs::path& path) { return sidecarPath(fs::weakly_canonical(path)); };
  std::set<fs::path> taken;
  if (!input.empty()) taken.insert(place(input));
  for (const fs::path& path : paths) {
    if (taken.insert(place(path)).second) continue;
    throw InputError(fmt::format("{}: would be written over {}: another directory is needed",
                                 path.string(),
                                 input.empty() ? "the .json beside another recording"
                                               : "what it is made from, or the .json beside that"));
  }
}

bool bake(Simulation& simulation, const std::vector<fs::path>& paths,
          const FrameProgress& progress) {
  requireApart(simulation, paths);
  std::vector<std::unique_ptr<scenes::Recorder>> recorders;
  for (const fs::path& path : paths) {
    recorders.push_back(recorderOf(path).create(path, simulation.scene()));
  }
  const auto record = [&](const Frame& frame) {
    for (const auto& recorder : recorders) recorder->record(frame, simulation);
  };
  if (!recordAll(simulation, record, progress)) return false;
  // Reads the input of a replay while the recorders may still be writing.
  Json sidecar = sidecarJson(simulation, {});
  for (std::size_t i = 0; i < paths.size(); ++i) {
    sidecar["hash"] = recorders[i]->finish();
    writeTextFile(sidecarPath(paths[i]), sidecar.dump(2) + "\n");
  }
  return true;
}

}  // namespace broadmark
