// The recordings a run works on: given ones, and those simulated for it.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/options.h"
#include "broadmark/original_settings.h"
#include "broadmark/recording.h"
#include "broadmark/results.h"
#include "scenes/simulation.h"

namespace broadmark {

/// One recording to be: everything known of it before a frame is read or simulated.
struct Source {
  RecordingReference reference;              ///< hash and path filled by openRecording
  std::unique_ptr<Simulation> simulation;    ///< null for a given recording
  std::optional<OriginalSettings> settings;  ///< when the original's settings file names it
};

/// Every simulation that the options ask for: scenes × object types × object counts, sorted so
/// that counts ascend within a scene. Throws InputError.
std::vector<std::unique_ptr<Simulation>> makeSimulations(const std::vector<std::string>& scenes,
                                                         const SceneOptions&,
                                                         const ParameterValues& parameters);

/// Understands the sources of a run. Throws InputError.
std::vector<Source> resolveSources(const HeadlessOptions&);

/// Opens a source's recording, simulating it first if need be: into `directory`, as bakeInto does,
/// or, if that is empty, into an unnamed temporary file. Null when interrupted.
std::unique_ptr<Recording> openRecording(Source&, const std::filesystem::path& directory,
                                         const std::vector<std::string>& recorders, bool quiet);

/// Bakes a simulation into `directory` under the name that belongs to it, one recording by each of
/// `recorders`, unless they are already there (and not `force`). Returns their paths, or none when
/// interrupted.
std::vector<std::filesystem::path> bakeInto(Simulation&, const std::filesystem::path& directory,
                                            const std::vector<std::string>& recorders, bool force,
                                            bool quiet);

/// Creates a directory and its parents. Throws InputError.
void makeDirectory(const std::filesystem::path&);

}  // namespace broadmark
