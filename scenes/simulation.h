// Scenes as the rest of the program sees them: described by parameters, turned into frames.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
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
  replayed,  ///< none at all: the frames come from a recording
  scripted,  ///< the engine alone decides where they are: no gravity, no launching, no walls
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
};
std::vector<RecorderListing> builtinRecorders();

/// A live physics simulation, frame by frame: a FrameSource that knows the poses, too. Its
/// parameters (objects, frames, seed, density, object_type, engine, …, and the scene's own) can be
/// set until the first rewind(). Same parameters, same frames, bit for bit. rewind() starts the
/// simulation anew.
class Simulation : public Parametrised, public FrameSource, public PoseSource {
 public:
  /// The recording that is replayed instead of simulating; "": none. Throws InputError when it is
  /// not there.
  [[nodiscard]] virtual std::filesystem::path input() const { return {}; }
};

/// The simulation of a built-in scene, by id or recorded name, any case, with its default
/// parameters, but by this engine (""; the default one). One that replays recordings has other
/// parameters than physics have. Throws InputError for an unknown name, suggesting the nearest.
std::unique_ptr<Simulation> makeSimulation(const std::string& scene,
                                           const std::string& engine = {});

/// Whether `path` is a complete recording baked with exactly these parameters (its .json beside it
/// says so, and the recording has the stated hash) from what is at `input()` now, if anything.
bool isBaked(const std::filesystem::path& path, Simulation& simulation);

/// Simulates all frames once into a recording at `path` and further ones at `more`, each by the
/// recorder that its extension names. Beside each a .json of the same name holds all parameters and
/// the hash ("schema": "broadmark-bake/1"); recordings that share a name share it. Returns the hash
/// of the one at `path`, or "" when progress stopped it (then nothing is left). Throws InputError.
std::string bake(Simulation& simulation, const std::filesystem::path& path,
                 const FrameProgress& progress = {},
                 const std::vector<std::filesystem::path>& more = {});

}  // namespace broadmark
