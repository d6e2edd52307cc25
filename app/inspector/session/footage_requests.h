// What asks the run thread to open something: a recording, an import, a simulation.
#pragma once

#include <filesystem>
#include <string>

#include "broadmark/harness/case_result.h"
#include "broadmark/parameters.h"
#include "broadmark/scenes/simulation.h"
#include "inspector/run/snapshot.h"

namespace broadmark {

// `swept`: shown as swept boxes.

/// The simulation with its present parameters.
FootageRequest simulationFootage(Simulation& simulation, bool swept);
/// `hash`: the expected one; "": any. Throws InputError.
FootageRequest recordingFootage(const std::filesystem::path& path, const std::string& hash,
                                bool swept);
/// Throws InputError.
FootageRequest importFootage(const RecordingReference& reference, bool swept);

/// The parameters of the request's scene, "scene" among them, as far as they are known. Null: none.
ParameterValues sceneParametersOf(const FootageRequest* footage);

}  // namespace broadmark
