// What several kinds of sources share: recordings to be simulated, and given ones.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sources/source.h"

namespace broadmark {

/// In results, beside the parameters of an authored scene: where its file is.
inline constexpr const char* kSceneFile = "scene_file";

/// "recordings (.aabbs, …)", for help.
std::string recordingKindsText();

/// The ids of the built-in scenes.
std::vector<std::string> sceneIds();
bool isSceneId(const std::string& name);

/// The recording of a simulation.
Source simulationSource(std::unique_ptr<Simulation>);
/// A recording in a file. Throws InputError.
Source recordingSource(const std::filesystem::path&);
/// Files that are imported. Throws InputError.
Source importedSource(const std::vector<std::string>& names, const FileImport&, ReadingOptions);
/// Files that are imported, or a recording, read as the options say. Throws InputError, also for an
/// option that is of no use to them.
Source fileSource(const std::vector<std::string>& names, const ReadingOptions&);

/// Makes its boxes swept ones.
void sweepBoxes(Source&);

/// A path that is stated in `file`: as stated if there is such a file, else relative to `file`.
std::filesystem::path statedPath(const std::filesystem::path& file, const std::string& stated);

/// One of several simulations of a scene.
struct SweptSimulation {
  std::unique_ptr<Simulation> simulation;
  ParameterValues swept;  ///< what tells it from the others, as RecordingReference::swept
};

/// Every simulation that the options ask for: every combination of their values (sweep.h). The
/// scene is a built-in one's name, a file of scene parameters, or an authored scene, of which the
/// options override the parameters. Throws InputError.
std::vector<SweptSimulation> makeSimulations(NamedSource& scene, const SceneOptions&,
                                             const ParameterValues& parameters);

/// Opens a scene of any kind: SourceKind::open of all of them.
OpenedSource openScene(NamedSource&, const OpeningOptions&);

}  // namespace broadmark
