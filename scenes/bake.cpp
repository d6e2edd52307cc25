// Recordings of simulations, each with a sidecar that says how it was made.

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "broadmark/atomic_file.h"
#include "broadmark/error.h"
#include "broadmark/recording.h"
#include "scenes/scene_parameters.h"

namespace broadmark {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kSidecarLimitBytes = 1 << 20;
constexpr std::string_view kRecordingExtension = ".aabbs";

std::filesystem::path sidecarPath(std::filesystem::path recording) {
  return recording.replace_extension(".json");
}

/// What stands beside a recording with this hash.
Json sidecarJson(Simulation& simulation, const std::string& hash) {
  Json json = sceneParametersJson(simulation, kBakeSchema);
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

}  // namespace

bool isBaked(const std::filesystem::path& path, Simulation& simulation) {
  try {
    const std::string sidecar = readTextFile(sidecarPath(path), kSidecarLimitBytes);
    const std::optional<std::string> hash = statedHash(sidecar, simulation);
    if (!hash) return false;
    RecordingReader recording(path);
    return recording.scene() == simulation.scene() && recording.hash() == *hash;
  } catch (const InputError&) {
    return false;  // missing or damaged: to be baked anew
  }
}

std::optional<std::string> bakedHash(const std::filesystem::path& recording) {
  const std::filesystem::path path = sidecarPath(recording);
  if (!std::filesystem::exists(path)) return std::nullopt;
  const std::string text = readTextFile(path, kSidecarLimitBytes);
  const auto json = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || json.value("schema", Json()) != kBakeSchema) return std::nullopt;
  if (!json.contains("hash") || !json["hash"].is_string()) {
    throw InputError(fmt::format("{}: states no hash: bake anew with --force", path.string()));
  }
  return json["hash"].get<std::string>();
}

std::string bake(Simulation& simulation, const std::filesystem::path& path,
                 const BakeProgress& progress) {
  if (path.extension() != kRecordingExtension) {
    throw InputError(fmt::format("{}: the name of a recording must end in {}", path.string(),
                                 kRecordingExtension));
  }
  RecordingWriter writer(path, simulation.scene());
  std::optional<Frame> frame = simulation.rewind();
  for (; frame; frame = simulation.next()) {
    writer.write(frame->boxes);
    if (progress && !progress(frame->index)) return {};
  }
  std::string hash = writer.finish();
  writeTextFile(sidecarPath(path), sidecarJson(simulation, hash).dump(2) + "\n");
  return hash;
}

}  // namespace broadmark
