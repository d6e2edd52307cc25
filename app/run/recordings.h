// Recordings for a run: existing ones, and simulations recorded for it.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "broadmark/recordings/recording.h"
#include "sources/source.h"
#include "support/progress.h"

namespace broadmark {

/// Paths of the recordings by these recorders, laid out like the original's:
/// "DIRECTORY/Recordings_AABBs/FreeFall Cubes N1000 F1000frames.aabbs", …. Names of a sweep's
/// recordings contain the `swept` parameters. Without recorders: one recording of the kind returned
/// by recordingExtension().
std::vector<std::filesystem::path> recordingPaths(const std::filesystem::path& directory,
                                                  const SceneInfo&, const ParameterValues& swept,
                                                  std::vector<std::string> recorders);

/// Opens a source's recording and fills in its hash. A simulation is recorded first: into
/// `directory`, once by each of `recorders`, of which the first is opened; or, if `directory` is
/// empty, into an unnamed temporary file, like all imported frames. Returns null when cancelled.
/// Throws InputError, also if the hash is not the expected one.
std::unique_ptr<IndexedFrames> openRecording(Source&, TaskObserver&,
                                             const std::filesystem::path& directory = {},
                                             const std::vector<std::string>& recorders = {});

/// Same for a command: shows progress and what was imported, unless `quiet`; throws Interrupted
/// when cancelled.
std::unique_ptr<IndexedFrames> openForCommand(Source&, bool quiet);

/// Prints importText(), if any, on standard error.
void printImport(const Source&);

/// Throws InputError, naming `what`, unless `hash` is the `expected` one of a case's recording.
void requireHash(const std::string& what, const std::string& hash, const std::string& expected);

/// Throws InputError unless the file has the extension of a box recording.
void requireRecordingName(const std::filesystem::path&);

/// Creates a directory and its parents. Throws InputError.
void makeDirectory(const std::filesystem::path&);

}  // namespace broadmark
