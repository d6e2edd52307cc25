// Scenes as the rest of the program sees them: described by parameters, turned into frames.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/frame.h"
#include "broadmark/parameters.h"

namespace broadmark {

/// A built-in scene or physics engine, for lists and help.
struct SceneListing {
  std::string id;       ///< "freefall"
  std::string name;     ///< as recordings call it: "FreeFall"
  std::string summary;  ///< one sentence
};
std::vector<SceneListing> builtinScenes();
/// What an engine does with the bodies of a scene.
enum class Dynamics {
  rigid,     ///< gravity and velocities move them; they collide with each other and the walls
  passing,   ///< as above, but they pass through each other
  scripted,  ///< by rules of its own: gravity, launching and walls may count for nothing
};
struct EngineListing {
  std::string id;  ///< "bullet"
  std::string summary;
  Dynamics dynamics = Dynamics::rigid;
};
std::vector<EngineListing> builtinEngines();

/// The parameters that only the engine with this id has. Throws InputError for an unknown one.
std::unique_ptr<Parametrised> engineParameters(const std::string& id);

/// A live physics simulation, frame by frame: a FrameSource. Its parameters (objects, frames, seed,
/// density, object_type, engine, …, the scene's own, and those of the engine that is chosen) count
/// from the next rewind() on. Same parameters, same frames, bit for bit. rewind() starts the
/// simulation anew.
class Simulation : public Parametrised, public FrameSource {};

/// The simulation of a built-in scene, by id or recorded name, any case, with its default
/// parameters. Throws InputError for an unknown name, suggesting the nearest.
std::unique_ptr<Simulation> makeSimulation(const std::string& scene);

/// Whether JSON of this kind (see jsonKind) describes a scene: a file of scene parameters
/// ("broadmark-scene-parameters/1"), or the sidecar of a baked recording.
bool describesScene(std::string_view json_kind);

/// The simulation that such a JSON text describes; what it does not state keeps its default. `name`
/// stands for the text in messages. Throws InputError that names the key and what would be right.
std::unique_ptr<Simulation> parseSceneParameters(std::string_view json, std::string_view name);

/// Scene and parameters as such a text: reading it back gives the same simulation.
std::string formatSceneParameters(Simulation&);

/// Told after each frame that was written; returning false stops.
using BakeProgress = std::function<bool(std::uint32_t frame)>;

/// Whether `path` is a complete recording baked with exactly these parameters (its .json beside it
/// says so, and the recording has the stated hash).
bool isBaked(const std::filesystem::path& path, Simulation& simulation);

/// The hash that the .json beside a recording states; nothing if there is none, or it is no sidecar
/// of a baked recording. Throws InputError when a sidecar states no hash.
std::optional<std::string> bakedHash(const std::filesystem::path& recording);

/// Simulates all frames into an .aabbs recording at `path`, with a .json of the same name that
/// holds all parameters and the recording's hash ("schema": "broadmark-bake/1"). Returns the hash,
/// or "" when progress stopped it (then nothing is left). Throws InputError.
std::string bake(Simulation& simulation, const std::filesystem::path& path,
                 const BakeProgress& progress = {});

}  // namespace broadmark
