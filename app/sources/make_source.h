// Creates sources: simulations, existing recordings and imported files.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sources/source.h"

namespace broadmark {

/// Key of an authored scene's file among its parameters in results.
inline constexpr const char* kSceneFile = "scene_file";

/// Text for help: "recordings (.aabbs, …)".
std::string recordingKindsText();

/// Ids of the built-in scenes.
std::vector<std::string> sceneIds();
bool isSceneId(const std::string& name);

/// Source that records a simulation.
Source simulationSource(std::unique_ptr<Simulation>);
/// Source for a recording's file. Throws InputError.
Source recordingSource(const std::filesystem::path&);
/// Source for imported files. Throws InputError.
Source importedSource(const std::vector<std::string>& names, const FileImport&, ReadingOptions);
/// Source for imported files or a recording, read with these options. Throws InputError, also for
/// an option that does not apply to them.
Source fileSource(const std::vector<std::string>& names, const ReadingOptions&);

/// Marks a source for the options among these that change the boxes of any source.
void adaptBoxes(Source&, ReadingOptions);

/// Resolves a path stated in `file`: returned unchanged if it exists, else relative to `file`.
std::filesystem::path resolvedPath(const std::filesystem::path& file, const std::string& stated);

/// One of several simulations of a scene.
struct SweptSimulation {
  std::unique_ptr<Simulation> simulation;
  ParameterValues swept;  ///< parameters that differ, as in RecordingReference::swept
};

/// Creates a simulation for every combination of the options' values (sweep.h). The scene is the
/// name of a built-in scene, a file of scene parameters or an authored scene; options override its
/// parameters. Throws InputError.
std::vector<SweptSimulation> makeSimulations(NamedSource& scene, const SceneOptions&,
                                             const ParameterValues& parameters);

/// Opens a scene: SourceKind::open of all kinds of scenes.
OpenedSource openScene(NamedSource&, const OpeningOptions&);

}  // namespace broadmark
