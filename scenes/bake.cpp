// Recordings of simulations, each with a .json sidecar that describes its origin.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/recordings/posrot.h"
#include "broadmark/scenes/simulation.h"
#include "scene_parameters.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;
using Sidecar = nlohmann::json;  // unlike Json, compares regardless of key order

constexpr std::uint64_t kSidecarLimitBytes = 1 << 20;

fs::path sidecarPath(fs::path recording) { return recording.replace_extension(".json"); }

/// All parameters except the path of an input, which is meaningless elsewhere.
Json parametersWithoutPath(Simulation& simulation) {
  Json json = sceneParametersJson(simulation, kBakeSchema);
  json["parameters"].erase("input");
  return json;
}

RecordingOrigin originOf(Simulation& simulation) {
  return {.source = simulation.input().filename().string(),
          .scene_parameters = formatJson(parametersWithoutPath(simulation))};
}

/// The sidecar for a recording with this hash. Identifies an input by its contents, not its path.
Json sidecarJson(Simulation& simulation, const std::string& hash) {
  Json json = parametersWithoutPath(simulation);
  if (const std::string input = simulation.inputHash(); !input.empty()) json["input_hash"] = input;
  json["hash"] = hash;
  return json;
}

std::optional<std::string> storedHash(const Sidecar& sidecar) {
  const auto hash = sidecar.find("hash");
  if (hash == sidecar.end() || !hash->is_string()) return {};
  return hash->get<std::string>();
}

/// The sidecar of a recording; empty if it has none. Throws InputError.
Sidecar sidecarOf(const fs::path& recording) {
  const fs::path path = sidecarPath(recording);
  if (!fs::exists(path)) return Sidecar::object();
  const Sidecar json = jsonOrNull(readTextFile(path, kSidecarLimitBytes));
  const bool is_sidecar = json.is_object() && json.value("schema", Sidecar()) == kBakeSchema;
  return is_sidecar ? json : Sidecar::object();
}

/// Writes a recording in the format of the path's extension: poses or boxes. Leaves no file
/// unless finished.
class Recorder {
 public:
  Recorder(const fs::path& path, Simulation& simulation) {
    std::vector<std::string> extensions;
    for (const RecorderListing& kind : builtinRecorders()) extensions.push_back("." + kind.id);
    if (std::ranges::find(extensions, path.extension().string()) == extensions.end()) {
      throw InputError(fmt::format("{}: the name of a recording must end in {}", path.string(),
                                   fmt::join(extensions, " or ")));
    }
    if (path.extension() == kPosrotExtension) {
      poses_ = std::make_unique<PosrotWriter>(path, simulation.scene());
    } else {
      boxes_ = std::make_unique<RecordingWriter>(path, simulation.scene(), originOf(simulation));
    }
  }

  /// Writes the simulation's latest frame. Starts with the initial pose.
  void record(const Frame& frame, Simulation& simulation) {
    if (boxes_) {
      boxes_->write(frame);
    } else if (frame.index == 0) {
      poses_->writeBoxes(simulation.unrotatedBoxes());
    } else {
      poses_->write(simulation.poses());
    }
  }
  std::string finish() { return boxes_ ? boxes_->finish() : poses_->finish(); }

 private:
  std::unique_ptr<RecordingWriter> boxes_;
  std::unique_ptr<PosrotWriter> poses_;
};

}  // namespace

std::vector<RecorderListing> builtinRecorders() {
  return {{"aabbs", "boxes of all bodies, frame after frame", "Recordings_AABBs"},
          {"broadmark", "boxes of the bodies that changed; bodies may be absent, and have layers",
           "Recordings_Broadmark"},
          {"posrot", "positions and rotations of all bodies, frame after frame",
           "Recordings_PositionRotation"}};
}

std::vector<std::string> escapeTexts(const Simulation& simulation) {
  constexpr std::size_t kMaxLines = 20;
  const std::span<const Escape> escapes = simulation.escapes();
  const std::size_t shown = std::min(escapes.size(), kMaxLines);
  std::vector<std::string> lines;
  for (const Escape& escape : escapes.first(shown)) {
    lines.push_back(
        fmt::format("body {} left its world for good in frame {}", escape.body, escape.frame));
  }
  if (shown < escapes.size()) {
    lines.push_back(fmt::format("{} more bodies left it, the last in frame {}",
                                escapes.size() - shown, escapes.back().frame));
  }
  return lines;
}

bool isBaked(const fs::path& path, Simulation& simulation, const std::function<bool()>& cancelled) {
  const Sidecar sidecar = sidecarOf(path);
  try {
    const std::optional<std::string> hash = storedHash(sidecar);
    if (!hash || sidecar != Sidecar(sidecarJson(simulation, *hash))) return false;
    const auto recording = openRecordingFile(path);
    return recording->scene() == simulation.scene() && recording->hash(cancelled) == *hash;
  } catch (const InputError&) {
    return false;  // missing or damaged
  }
}

bool isIntact(const fs::path& path, const std::function<bool()>& cancelled) {
  try {
    const std::optional<std::string> hash = bakedHash(path);
    return hash && openRecordingFile(path)->hash(cancelled) == *hash;
  } catch (const InputError&) {
    return false;  // missing or damaged
  }
}

std::optional<std::string> bakedHash(const fs::path& recording) {
  const Sidecar sidecar = sidecarOf(recording);
  if (sidecar.empty()) return std::nullopt;
  std::optional<std::string> hash = storedHash(sidecar);
  if (!hash) {
    throw InputError(fmt::format("{}: contains no hash: bake again with --force",
                                 sidecarPath(recording).string()));
  }
  return hash;
}

std::string bakedParameters(const fs::path& recording) {
  Sidecar sidecar = sidecarOf(recording);
  sidecar.erase("hash");
  return sidecar.empty() ? std::string() : formatJson(Json(sidecar));
}

void requireBakeable(Simulation& simulation, const std::vector<fs::path>& paths) {
  for (const fs::path& path : paths) requireHolds(path, simulation.scene());
  const fs::path input = simulation.input();
  const auto sidecar_of = [](const fs::path& path) {
    return sidecarPath(fs::weakly_canonical(path));
  };
  std::set<fs::path> reserved;
  if (!input.empty()) reserved.insert(sidecar_of(input));
  for (const fs::path& path : paths) {
    if (reserved.insert(sidecar_of(path)).second) continue;
    throw InputError(fmt::format("{}: would overwrite {}: choose another folder", path.string(),
                                 input.empty() ? "the sidecar of another recording"
                                               : "its own source, or the sidecar of that"));
  }
}

bool bake(Simulation& simulation, const std::vector<fs::path>& paths,
          const FrameProgress& progress) {
  requireBakeable(simulation, paths);
  std::vector<Recorder> recorders;
  for (const fs::path& path : paths) recorders.emplace_back(path, simulation);
  const auto record = [&](const Frame& frame) {
    for (Recorder& recorder : recorders) recorder.record(frame, simulation);
  };
  if (!recordAll(simulation, record, progress)) return false;
  // Hashes the input of a replay while the recorders may still be writing.
  Json sidecar = sidecarJson(simulation, {});
  for (std::size_t i = 0; i < paths.size(); ++i) {
    sidecar["hash"] = recorders[i].finish();
    writeTextFile(sidecarPath(paths[i]), formatJson(sidecar, 2));
  }
  return true;
}

}  // namespace broadmark
