// The recordings that a run works on: given ones, and those that are simulated for it.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "broadmark/recordings/recording.h"
#include "sources/source.h"
#include "support/progress.h"

namespace broadmark {

/// Where recordings by these recorders lie below a directory, laid out as the original's:
/// "DIRECTORY/Recordings_AABBs/FreeFall Cubes N1000 F1000frames.aabbs", …. Those of a sweep also
/// have the `swept` parameters in their names. Without recorders: the one of the kind that
/// recordingExtension() names.
std::vector<std::filesystem::path> recordingPaths(const std::filesystem::path& directory,
                                                  const SceneInfo&, const ParameterValues& swept,
                                                  std::vector<std::string> recorders);

/// Opens a source's recording and fills in its hash. A simulation is recorded first: below
/// `directory`, once by each of `recorders`, of which the first is opened; or, if that is empty,
/// into an unnamed temporary file, as imported frames always are. Null when cancelled. Throws
/// InputError; also when the recording is not the expected one.
std::unique_ptr<IndexedFrames> openRecording(Source&, TaskObserver&,
                                             const std::filesystem::path& directory = {},
                                             const std::vector<std::string>& recorders = {});

/// The same for a command: shows its progress unless `quiet`. Throws Interrupted, too.
std::unique_ptr<IndexedFrames> openForCommand(Source&, bool quiet);

/// Throws InputError, naming `what`, unless `hash` is that of the recording a case ran on.
void requireHash(const std::string& what, const std::string& hash, const std::string& expected);

/// Throws InputError unless the name ends like that of a recording of boxes.
void requireRecordingName(const std::filesystem::path&);

/// Creates a directory and its parents. Throws InputError.
void makeDirectory(const std::filesystem::path&);

}  // namespace broadmark
