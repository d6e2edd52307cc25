// The public interface of scenes: parameters in, frames out. Also their parameter files, and baking
// into recordings.
//
// Example:
//
//   const std::unique_ptr<Simulation> simulation = makeSimulation("gravity", "bullet");
//   setParameters(*simulation, {{"objects", "2000"}, {"frames", "100"}, {"seed", "7"}});
//   Frame frame = simulation->rewind();
//   while (const std::optional<Frame> next = simulation->next()) frame = *next;
//   bake(*simulation, {"gravity.aabbs"});  // the same frames again, to a file
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "broadmark/frame.h"
#include "broadmark/parameters.h"
#include "broadmark/pose.h"
#include "broadmark/recordings/recording.h"

namespace broadmark {

/// Maximum number of bodies of any scene, built-in or authored.
inline constexpr std::uint32_t kMaxBodies = 10'000'000;
/// Maximum number of frames after the initial pose.
inline constexpr std::uint32_t kMaxFrames = 1'000'000;

/// A built-in scene, for lists and help.
struct SceneListing {
  std::string id;       ///< "freefall"
  std::string name;     ///< as in recordings: "FreeFall"
  std::string summary;  ///< one sentence
};
/// In the order of lists and help.
std::vector<SceneListing> builtinScenes();

/// How an engine moves the bodies of a scene.
enum class Dynamics {
  rigid,     ///< gravity and velocities move them; they collide with each other and the walls
  passing,   ///< like rigid, but bodies pass through each other
  scripted,  ///< the engine's own rules, which may ignore gravity, velocities and walls
  replayed,  ///< frames from a recording
};

/// A physics engine, for lists and help.
struct EngineListing {
  std::string id;       ///< "bullet"
  std::string summary;  ///< one sentence
  Dynamics dynamics = Dynamics::rigid;
  std::string plugin;  ///< the library, as named on the command line; "": built in
};
/// The built-in engines, the added ones, then those that replay recordings.
std::vector<EngineListing> availableEngines();

/// A writable recording format, for lists and help.
struct RecorderListing {
  std::string id;       ///< "aabbs": also the extension of its recordings, which has a dot
  std::string summary;  ///< one sentence
  std::string folder;   ///< the original's folder name for such recordings
};
std::vector<RecorderListing> builtinRecorders();

/// The parameters of an engine. They are added to a scene's parameters; those of a replay engine
/// replace them. Throws InputError for an unknown id.
std::unique_ptr<Parametrised> engineParameters(const std::string& id);

/// A body that left its world for good, and stays where it was seen first outside.
struct Escape {
  std::uint32_t body = 0;   ///< its id
  std::uint32_t frame = 0;  ///< the first frame that it was outside in
};

/// A live physics simulation, frame by frame. Its parameters (objects, frames, seed, density,
/// object_type, engine, …, the scene's own, and those of the chosen engine) take effect at the next
/// rewind(), which restarts the simulation. Same parameters, same frames, bit for bit.
///
/// Until the first frame, scene() describes the current parameters, computed by each call (a replay
/// opens its recording); then those of the last rewind(). next() rewinds first, if needed. poses()
/// and unrotatedBoxes() require a frame. A failure of a plug-in's engine is an InputError, as is
/// one of a replayed recording.
class Simulation : public Parametrised, public FrameSource, public PoseSource {
 public:
  explicit Simulation(SceneListing listing) : listing_(std::move(listing)) {}

  /// The listing of a built-in scene; for an authored one the id is kAuthoredSceneId.
  [[nodiscard]] const SceneListing& listing() const { return listing_; }
  /// The input file besides the parameters: a recording to replay, an authored scene; "": none.
  /// Throws InputError if there is no such recording.
  [[nodiscard]] virtual std::filesystem::path input() const { return {}; }
  /// The hash of the input besides the parameters; "": none. May read a whole recording. Throws
  /// InputError.
  [[nodiscard]] virtual std::string inputHash() { return {}; }
  /// The bodies that escaped up to the latest frame, in order. Valid until the next frame.
  [[nodiscard]] virtual std::span<const Escape> escapes() const { return {}; }

 private:
  SceneListing listing_;
};

/// A line for each escape: "body 17 left its world for good in frame 4"; of more than 20, the first
/// ones, and a line with the number of the others.
std::vector<std::string> escapeTexts(const Simulation&);

/// Creates the simulation of a built-in scene with default parameters. `scene` is its id or its
/// name in recordings, case-insensitive; `engine` an engine's id ("": the scene's default). Throws
/// InputError for an unknown name, with the nearest as a suggestion.
std::unique_ptr<Simulation> makeSimulation(const std::string& scene,
                                           const std::string& engine = {});

/// The id in the listing of every authored scene. No built-in scene has it.
inline constexpr std::string_view kAuthoredSceneId = "authored";

// The "schema" of the JSON files for a built-in scene: a file of scene parameters, and the sidecar
// of a baked recording. (For authored scenes see scenes::kAuthoredSceneSchema.)
inline constexpr std::string_view kSceneParametersSchema = "broadmark-scene-parameters/1";
inline constexpr std::string_view kBakeSchema = "broadmark-bake/1";

/// Whether JSON with this schema describes a scene: one of the two above, or an authored scene.
bool describesScene(std::string_view schema);

/// Creates the simulation described by such a JSON text, built-in or authored. Missing parameters
/// have their defaults. `name`, the text's path if any, is used in messages. Throws InputError with
/// the key and the expected value.
std::unique_ptr<Simulation> parseSceneParameters(std::string_view json, std::string_view name);

/// Formats scene and parameters as such a text; for an authored scene the whole document.
/// Round-trips to the same simulation.
std::string formatSceneParameters(Simulation&);

/// Whether `path` is a complete recording baked with exactly these parameters and from an input
/// with the current inputHash(), according to its sidecar, and has the sidecar's hash. Reads the
/// whole recording if its parameters match. Throws Cancelled, as does isIntact(), and InputError
/// for a sidecar that cannot be read.
bool isBaked(const std::filesystem::path& path, Simulation& simulation,
             const std::function<bool()>& cancelled = {});
/// Whether `path` is an intact baked recording, of any origin: it has the hash in its
/// sidecar. Reads the whole recording.
bool isIntact(const std::filesystem::path& path, const std::function<bool()>& cancelled = {});

/// The hash in a recording's sidecar; nullopt without a sidecar, or if the file there has
/// another schema. Throws InputError if a sidecar contains no hash or cannot be read. Does not read
/// the recording.
std::optional<std::string> bakedHash(const std::filesystem::path& recording);

/// A recording's sidecar without the hash, as JSON; "" without a sidecar. Throws InputError if it
/// cannot be read.
std::string bakedParameters(const std::filesystem::path& recording);

/// Throws InputError if a recording at one of these paths cannot hold the scene, or if bake() would
/// overwrite input(), its sidecar, or another recording's sidecar.
void requireBakeable(Simulation& simulation, const std::vector<std::filesystem::path>& paths);

/// Simulates all frames once into recordings at `paths`, each in the format of its extension (that
/// of a recorder). Writes a sidecar beside each: a .json of the same name (schema kBakeSchema) with
/// all parameters and the recording's hash. Replaces existing files: also a .json that is no
/// sidecar. Returns false, and leaves no file, if `progress` stopped it. Throws InputError, as
/// requireBakeable(), and for a path or frame that cannot be written.
bool bake(Simulation& simulation, const std::vector<std::filesystem::path>& paths,
          const FrameProgress& progress = {});

}  // namespace broadmark
