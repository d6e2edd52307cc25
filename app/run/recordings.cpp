// Recordings of sources, and where they are kept.

#include "run/recordings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/recordings/swept_frames.h"
#include "request/sweep.h"
#include "support/interrupt.h"
#include "support/progress.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

/// Calls record(FrameProgress) and shows how far it is with what it is `doing`.
template <class Record>
bool recordWithProgress(const char* doing, const SceneInfo& scene, bool quiet, Record&& record) {
  Progress progress(
      fmt::format("{} {} {} N{}", doing, scene.name, scene.object_type, scene.objects),
      scene.frames, quiet);
  return record([&](std::uint32_t frame) {
    progress.update(frame);
    return !InterruptGuard::requested();
  });
}

/// Bakes a source's simulation below `directory`, unless it is already there. Returns the path of
/// the first recorder's recording, or "" when interrupted.
fs::path bakeInto(Source& source, const fs::path& directory,
                  const std::vector<std::string>& recorders, bool quiet) {
  Simulation& simulation = *source.simulation;
  const auto paths =
      recordingPaths(directory, simulation.scene(), source.reference.swept, recorders);
  const auto there = [&](const fs::path& path) { return isBaked(path, simulation); };
  if (std::ranges::all_of(paths, there)) return paths.front();
  for (const fs::path& path : paths) makeDirectory(path.parent_path());
  const auto& scene = simulation.scene();
  const bool whole = recordWithProgress("baking", scene, quiet, [&](const auto& progress) {
    return bake(simulation, paths, progress);
  });
  return whole ? paths.front() : fs::path();
}

std::unique_ptr<Recording> recordTemporary(const char* doing, FrameSource& frames, bool quiet) {
  RecordingWriter writer(frames.scene());
  const bool whole = recordWithProgress(
      doing, frames.scene(), quiet,
      [&](const FrameProgress& progress) { return recordAll(frames, writer, progress); });
  return whole ? writer.finishTemporary() : nullptr;
}

/// The recording that a run was planned for. Throws InputError when another has taken its name.
std::unique_ptr<Recording> openAgain(const RecordingReference& reference) {
  auto recording = openRecordingFile(reference.path);
  SceneInfo scene = recording->scene();
  scene.name = reference.scene.name;  // that may tell of sweeping
  if (scene == reference.scene) return recording;
  throw InputError(fmt::format("{}: was replaced after the run had begun", reference.path));
}

/// The recording as it is, swept or not. Null when interrupted.
std::unique_ptr<Recording> openPlain(Source& source, const fs::path& directory,
                                     const std::vector<std::string>& recorders, bool quiet) {
  if (source.imported) return recordTemporary("importing", *source.imported, quiet);
  if (!source.simulation) return openAgain(source.reference);
  if (directory.empty()) return recordTemporary("baking", *source.simulation, quiet);
  const fs::path path = bakeInto(source, directory, recorders, quiet);
  return path.empty() ? nullptr : openRecordingFile(path);
}

}  // namespace

std::unique_ptr<IndexedFrames> openRecording(Source& source, const fs::path& directory,
                                             const std::vector<std::string>& recorders,
                                             bool quiet) {
  std::unique_ptr<Recording> recording = openPlain(source, directory, recorders, quiet);
  if (!recording) return nullptr;
  const bool swept = source.reference.reading.contains("swept");
  const std::string hash = swept ? sweptHash(recording->hash()) : recording->hash();
  source.reference.hash = hash;
  if (!source.expected_hash.empty()) {
    requireHash(source.simulation ? source.reference.scene.name + ", simulated again"
                                  : source.reference.path,
                hash, source.expected_hash);
  }
  if (swept) return std::make_unique<SweptFrames>(std::move(recording));
  return recording;
}

void requireHash(const std::string& what, const std::string& hash, const std::string& expected) {
  if (hash == expected) return;
  throw InputError(fmt::format("{}: not the recording that the case ran on: its hash is {}, not {}",
                               what, hash, expected));
}

std::vector<fs::path> recordingPaths(const fs::path& directory, const SceneInfo& scene,
                                     const ParameterValues& swept,
                                     std::vector<std::string> recorders) {
  if (recorders.empty()) recorders.emplace_back(recordingExtension(scene).substr(1));
  std::vector<fs::path> paths;
  const std::vector<RecorderListing> listings = builtinRecorders();
  for (const std::string& id : recorders) {
    const auto listing = std::ranges::find(listings, id, &RecorderListing::id);
    paths.push_back(directory / listing->folder /
                    recordingFileName(scene, fmt::format("{}.{}", sweptText(swept), id)));
  }
  return paths;
}

void requireRecordingName(const fs::path& path) {
  const std::vector<std::string> extensions = boxRecordingExtensions();
  if (std::ranges::find(extensions, path.extension().string()) != extensions.end()) return;
  throw InputError(fmt::format("{}: cannot be written: the name of a recording ends in {}",
                               path.string(), fmt::join(extensions, " or ")));
}

std::string recordingKindsText() {
  return fmt::format("recordings ({})", fmt::join(recordingExtensions(), ", "));
}

void makeDirectory(const fs::path& directory) {
  std::vector<fs::path> missing;
  for (fs::path at = fs::absolute(directory); !fs::exists(at); at = at.parent_path()) {
    missing.push_back(at);
  }
  if (missing.empty() && fs::is_directory(directory)) return;
  requireAllowed(directory);
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) {
    throw InputError(
        fmt::format("{}: cannot create the directory: {}", directory.string(), error.message()));
  }
  for (const fs::path& made : missing) syncName(made);
}

}  // namespace broadmark
