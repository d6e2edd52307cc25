// The recordings a run works on: given ones, and those simulated for it.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "options.h"
#include "original/settings.h"
#include "broadmark/recording.h"
#include "broadmark/results.h"
#include "broadmark/scenes/simulation.h"

namespace broadmark {

/// One recording to be: everything known of it before a frame is read or simulated.
struct Source {
  RecordingReference reference;              ///< hash and path filled by openRecording
  std::unique_ptr<Simulation> simulation;    ///< null for a given recording
  std::optional<OriginalSettings> settings;  ///< when the original's settings file names it
  std::string expected_hash = {};            ///< what the recording must be; "": whatever it is
};

/// Every simulation that the options ask for: scenes × object types × object counts, sorted so
/// that counts ascend within a scene. A scene is a built-in one's name, a file of scene parameters,
/// which the options override, or an authored scene, of which they override the parameters. Throws
/// InputError.
std::vector<std::unique_ptr<Simulation>> makeSimulations(const std::vector<std::string>& scenes,
                                                         const SceneOptions&,
                                                         const ParameterValues& parameters);

/// Whether it is a built-in scene's name, or may be a file.
bool isSource(const std::string& text);

/// Understands the sources of a run. Throws InputError.
std::vector<Source> resolveSources(const HeadlessOptions&);

/// The source that a results file refers to: a recording at its path, or else beside that file, or
/// the simulation anew; in either case with the hash it had. Throws InputError.
Source referredSource(const RecordingReference&, const std::filesystem::path& results_file);

/// Where recordings by these recorders lie below a directory, laid out as the original's:
/// "DIRECTORY/Recordings_AABBs/FreeFall Cubes N1000 F1000frames.aabbs", ….
std::vector<std::filesystem::path> recordingPaths(const std::filesystem::path& directory,
                                                  const SceneInfo&,
                                                  const std::vector<std::string>& recorders);

/// Opens a source's recording, simulating it first if need be: below `directory`, one recording by
/// each of `recorders`, the first being opened; or, if that is empty, into an unnamed temporary
/// file. Null when interrupted. Throws InputError when it is not the expected one.
std::unique_ptr<Recording> openRecording(Source&, const std::filesystem::path& directory,
                                         const std::vector<std::string>& recorders, bool quiet);

/// Throws InputError, naming `what`, unless it has the hash of the recording that a case ran on.
void requireHash(const std::string& what, const std::string& hash, const std::string& expected);

/// Creates a directory and its parents. Throws InputError.
void makeDirectory(const std::filesystem::path&);

}  // namespace broadmark
