// Recordings of sources, and their paths.

#include "run/recordings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/recordings/adapted_frames.h"
#include "request/sweep.h"
#include "support/interrupt.h"
#include "support/progress.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

/// Starts a task with a step per frame, and returns its progress callback.
FrameProgress startTask(TaskObserver& tasks, const char* activity, const SceneInfo& scene) {
  tasks.onTaskStart(
      fmt::format("{} {} {} N{}", activity, scene.name, scene.object_type, scene.objects),
      scene.frames);
  return [&tasks](std::uint32_t frame) {
    tasks.onProgress(frame);
    return !tasks.cancelled();
  };
}

void noteEscapes(const Simulation& simulation, TaskObserver& tasks) {
  for (const std::string& line : escapeTexts(simulation)) {
    tasks.onNote(fmt::format("{}: {}", simulation.listing().name, line));
  }
}

/// Bakes a source's simulation into `directory`, unless already baked. Returns the path of the
/// first recorder's recording, or "" when cancelled.
fs::path bakeInto(Source& source, TaskObserver& tasks, const fs::path& directory,
                  const std::vector<std::string>& recorders) {
  Simulation& simulation = *source.simulation;
  const auto paths =
      recordingPaths(directory, simulation.scene(), source.reference.swept, recorders);
  const auto is_baked = [&](const fs::path& path) {
    return isBaked(path, simulation, [&tasks] { return tasks.cancelled(); });
  };
  if (std::ranges::all_of(paths, is_baked)) return paths.front();
  for (const fs::path& path : paths) makeDirectory(path.parent_path());
  const bool is_complete = bake(simulation, paths, startTask(tasks, "baking", simulation.scene()));
  noteEscapes(simulation, tasks);
  return is_complete ? paths.front() : fs::path();
}

std::unique_ptr<Recording> recordTemporary(const char* activity, FrameSource& frames,
                                           TaskObserver& tasks) {
  RecordingWriter writer(frames.scene());
  const bool is_complete = recordAll(frames, writer, startTask(tasks, activity, frames.scene()));
  return is_complete ? writer.finishTemporary() : nullptr;
}

/// Opens the recording that a run was planned for. Throws InputError if it has been replaced.
std::unique_ptr<Recording> reopen(const RecordingReference& reference) {
  auto recording = openRecordingFile(reference.path);
  if (adaptedScene(recording->scene(), reference.reading) == reference.scene) return recording;
  throw InputError(fmt::format("{}: was replaced after the run had started", reference.path));
}

/// Opens a source's recording with its own boxes. Returns null when cancelled.
std::unique_ptr<Recording> openUnadapted(Source& source, TaskObserver& tasks,
                                         const fs::path& directory,
                                         const std::vector<std::string>& recorders) {
  if (source.imported) return recordTemporary("importing", *source.imported, tasks);
  if (!source.simulation) return reopen(source.reference);
  if (directory.empty()) {
    auto recording = recordTemporary("baking", *source.simulation, tasks);
    noteEscapes(*source.simulation, tasks);
    return recording;
  }
  const fs::path path = bakeInto(source, tasks, directory, recorders);
  return path.empty() ? nullptr : openRecordingFile(path);
}

}  // namespace

std::unique_ptr<IndexedFrames> openRecording(Source& source, TaskObserver& tasks,
                                             const fs::path& directory,
                                             const std::vector<std::string>& recorders) try {
  std::unique_ptr<Recording> recording = openUnadapted(source, tasks, directory, recorders);
  if (!recording) return nullptr;
  const std::string hash = adaptedHash(recording->hash([&tasks] { return tasks.cancelled(); }),
                                       source.reference.reading);
  source.reference.hash = hash;
  if (!source.expected_hash.empty()) {
    requireHash(source.simulation ? source.reference.scene.name + ", simulated again"
                                  : source.reference.path,
                hash, source.expected_hash);
  }
  return adapted(std::move(recording), source.reference.reading);
} catch (const Cancelled&) {
  return nullptr;
}

std::unique_ptr<IndexedFrames> openForCommand(Source& source, bool quiet) {
  if (!quiet) printImport(source);
  TerminalTasks<> tasks(quiet);
  auto recording = openRecording(source, tasks);
  if (!recording) throw Interrupted();
  return recording;
}

void printImport(const Source& source) {
  if (const std::string text = importText(source); !text.empty()) fmt::print(stderr, "{}\n", text);
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
  for (fs::path path = fs::absolute(directory); !fs::exists(path); path = path.parent_path()) {
    missing.push_back(path);
  }
  if (missing.empty() && fs::is_directory(directory)) return;
  requireInSandbox(directory);
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) {
    throw InputError(
        fmt::format("{}: cannot create the folder: {}", directory.string(), error.message()));
  }
  for (const fs::path& created : missing) syncName(created);
}

}  // namespace broadmark
