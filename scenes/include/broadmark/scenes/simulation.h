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
#include "broadmark/pose.h"
#include "broadmark/recording.h"

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
  replayed,  ///< none at all: the frames come from a recording
};
struct EngineListing {
  std::string id;  ///< "bullet"
  std::string summary;
  Dynamics dynamics = Dynamics::rigid;
};
std::vector<EngineListing> builtinEngines();
struct RecorderListing {
  std::string id;  ///< "aabbs": also the extension of what it writes
  std::string summary;
  std::string folder;  ///< where the original keeps such recordings: "Recordings_AABBs"
};
std::vector<RecorderListing> builtinRecorders();

/// The parameters that come with the engine of this id: besides those of a scene, or, if it replays
/// recordings, in their place. Throws InputError for an unknown one.
std::unique_ptr<Parametrised> engineParameters(const std::string& id);

/// A live physics simulation, frame by frame: a FrameSource that knows the poses, too. Its
/// parameters (objects, frames, seed, density, object_type, engine, …, the scene's own, and those
/// of the engine that is chosen) count from the next rewind() on. Same parameters, same frames, bit
/// for bit. rewind() starts the simulation anew.
class Simulation : public Parametrised, public FrameSource, public PoseSource {
 public:
  explicit Simulation(SceneListing listing) : listing_(std::move(listing)) {}

  /// The built-in scene it is one of; of an authored one the id is kAuthoredSceneId.
  [[nodiscard]] const SceneListing& listing() const { return listing_; }
  /// The file that it is made from besides its parameters: a recording that is replayed, an
  /// authored scene; "": none. Throws InputError when a recording is not there.
  [[nodiscard]] virtual std::filesystem::path input() const { return {}; }
  /// The hash of what it is made from besides its parameters; "": nothing. Throws InputError.
  [[nodiscard]] virtual std::string inputHash() { return {}; }

 private:
  SceneListing listing_;
};

/// The simulation of a built-in scene, by id or recorded name, any case, with its default
/// parameters, but by this engine ("": the default one). One that replays recordings has other
/// parameters than physics have. Throws InputError for an unknown name, suggesting the nearest.
std::unique_ptr<Simulation> makeSimulation(const std::string& scene,
                                           const std::string& engine = {});

/// The id in the listing of every authored scene, which no built-in one has.
inline constexpr std::string_view kAuthoredSceneId = "authored";

/// Whether JSON of this kind (see jsonKind) describes a scene: a file of scene parameters
/// ("broadmark-scene-parameters/1"), the sidecar of a baked recording, or an authored scene
/// ("broadmark-scene/1").
bool describesScene(std::string_view json_kind);

/// The simulation that such a JSON text describes; what it does not state keeps its default.
/// `name`, its path if it has one, stands for the text in messages. Throws InputError that names
/// the key and what would be right.
std::unique_ptr<Simulation> parseSceneParameters(std::string_view json, std::string_view name);

/// Scene and parameters as such a text, of an authored scene the whole of it: reading it back gives
/// the same simulation.
std::string formatSceneParameters(Simulation&);

/// Whether `path` is a complete recording baked with exactly these parameters (its .json beside it
/// says so, and the recording has the stated hash) from what has `inputHash()` now.
bool isBaked(const std::filesystem::path& path, Simulation& simulation);

/// The hash that the .json beside a recording states; nothing if there is none, or it is no sidecar
/// of a baked recording. Throws InputError when a sidecar states no hash.
std::optional<std::string> bakedHash(const std::filesystem::path& recording);

/// Throws InputError if bake() to these paths would write over input(), or over the .json beside
/// that or another of them.
void requireApart(Simulation& simulation, const std::vector<std::filesystem::path>& paths);

/// Simulates all frames once into recordings at `paths`, each by the recorder that its extension
/// names. Beside each a .json of the same name, which no two may share, holds all parameters and
/// the hash ("schema": "broadmark-bake/1"). Returns false when progress stopped it: then nothing is
/// left. Throws InputError.
bool bake(Simulation& simulation, const std::vector<std::filesystem::path>& paths,
          const FrameProgress& progress = {});

}  // namespace broadmark
