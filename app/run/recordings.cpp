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

/// Reports what is `doing` to a scene, frame by frame.
FrameProgress reportedTo(TaskObserver& tasks, const char* doing, const SceneInfo& scene) {
  tasks.onTaskStart(
      fmt::format("{} {} {} N{}", doing, scene.name, scene.object_type, scene.objects),
      scene.frames);
  return [&tasks](std::uint32_t frame) {
    tasks.onProgress(frame);
    return !tasks.cancelled();
  };
}

/// Bakes a source's simulation below `directory`, unless it is already there. Returns the path of
/// the first recorder's recording, or "" when cancelled.
fs::path bakeInto(Source& source, TaskObserver& tasks, const fs::path& directory,
                  const std::vector<std::string>& recorders) {
  Simulation& simulation = *source.simulation;
  const auto paths =
      recordingPaths(directory, simulation.scene(), source.reference.swept, recorders);
  const auto there = [&](const fs::path& path) { return isBaked(path, simulation); };
  if (std::ranges::all_of(paths, there)) return paths.front();
  for (const fs::path& path : paths) makeDirectory(path.parent_path());
  const bool whole = bake(simulation, paths, reportedTo(tasks, "baking", simulation.scene()));
  return whole ? paths.front() : fs::path();
}

std::unique_ptr<Recording> recordTemporary(const char* doing, FrameSource& frames,
                                           TaskObserver& tasks) {
  RecordingWriter writer(frames.scene());
  const bool whole = recordAll(frames, writer, reportedTo(tasks, doing, frames.scene()));
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

/// The recording as it is, swept or not. Null when cancelled.
std::unique_ptr<Recording> openPlain(Source& source, TaskObserver& tasks, const fs::path& directory,
                                     const std::vector<std::string>& recorders) {
  if (source.imported) return recordTemporary("importing", *source.imported, tasks);
  if (!source.simulation) return openAgain(source.reference);
  if (directory.empty()) return recordTemporary("baking", *source.simulation, tasks);
  const fs::path path = bakeInto(source, tasks, directory, recorders);
  return path.empty() ? nullptr : openRecordingFile(path);
}

}  // namespace

std::unique_ptr<IndexedFrames> openRecording(Source& source, TaskObserver& tasks,
                                             const fs::path& directory,
                                             const std::vector<std::string>& recorders) {
  std::unique_ptr<Recording> recording = openPlain(source, tasks, directory, recorders);
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

std::unique_ptr<IndexedFrames> openForCommand(Source& source, bool quiet) {
  TerminalTasks<> tasks(quiet);
  auto recording = openRecording(source, tasks);
  if (!recording) throw Interrupted();
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

void makeDirectory(const fs::path& directory) {
  std::vector<fs::path> missing;
  for (fs::path at = fs::absolute(directory); !fs::exists(at); at = at.parent_path()) {
    missing.push_back(at);
  }
  if (missing.empty() && fs::is_directory(directory)) return;
  requireInSandbox(directory);
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) {
    throw InputError(
        fmt::format("{}: cannot create the directory: {}", directory.string(), error.message()));
  }
  for (const fs::path& made : missing) syncName(made);
}

}  // namespace broadmark
