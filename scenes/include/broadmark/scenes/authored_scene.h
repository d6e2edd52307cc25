// Authored scenes: documents that are edited, saved and simulated.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/frame.h"
#include "broadmark/parameters.h"
#include "broadmark/scenes/shape.h"

namespace broadmark::scenes {

inline constexpr std::string_view kAuthoredSceneSchema = "broadmark-scene/1";
/// Limits of a box's edges and of a sphere's diameter.
inline constexpr float kMinEdge = 1e-6F;
inline constexpr float kMaxEdge = 1e6F;
/// The value of `vanishes` for a body that stays.
inline constexpr std::uint32_t kNever = std::numeric_limits<std::uint32_t>::max();

/// A body in its initial state.
struct AuthoredBody {
  Shape shape = BoxShape{{0.5F, 0.5F, 0.5F}};
  double mass = 1;
  bool frozen = false;  ///< an immovable obstacle
  Pose pose;
  Vec3 linear_velocity{};   ///< world units per second
  Vec3 angular_velocity{};  ///< radians per second
  std::uint8_t layer = 0;
  std::uint32_t appears = 0;        ///< the first frame in which it is present
  std::uint32_t vanishes = kNever;  ///< the first later frame in which it is absent
  std::uint32_t group = 0;  ///< bodies selected together in an editor, 1 to kMaxBodies; 0: none

  friend bool operator==(const AuthoredBody&, const AuthoredBody&) = default;
};

/// Calls visit(key, value, default) for each property of a body except its shape, with its key in
/// files.
template <class Body, class Visit>
void visitProperties(Body& body, const Visit& visit) {
  static constexpr AuthoredBody kDefault;
  visit("position", body.pose.position, kDefault.pose.position);
  visit("rotation", body.pose.rotation, kDefault.pose.rotation);
  visit("velocity", body.linear_velocity, kDefault.linear_velocity);
  visit("angular_velocity", body.angular_velocity, kDefault.angular_velocity);
  visit("mass", body.mass, kDefault.mass);
  visit("frozen", body.frozen, kDefault.frozen);
  visit("layer", body.layer, kDefault.layer);
  visit("appears", body.appears, kDefault.appears);
  visit("vanishes", body.vanishes, kDefault.vanishes);
  visit("group", body.group, kDefault.group);
}

/// A scene as a plain value. Lengths are in world units. A body's id is its index. At most
/// kMaxBodies (simulation.h) bodies.
struct AuthoredScene {
  std::string name = "Untitled";  ///< as in recordings
  Aabb world{{-10, -10, -10, 0}, {10, 10, 10, 0}};
  LayerMatrix collide = LayerMatrix::all();  ///< colliding layers
  std::uint32_t triggers = 0;  ///< bit b: bodies of layer b push nothing, and nothing pushes them
  /// The stated values of AuthoredParameters; the others have their defaults.
  ParameterValues parameters;
  std::vector<AuthoredBody> bodies;

  friend bool operator==(const AuthoredScene&, const AuthoredScene&) = default;
};

/// A source of frames with shapes and velocities of bodies, not only boxes.
class SceneSource {
 public:
  virtual ~SceneSource() = default;
  /// The latest frame as a separate scene: its bodies with their velocities, and the current
  /// gravity.
  [[nodiscard]] virtual AuthoredScene authoredScene() = 0;
};

/// Checks a part of a scene. Returns the fault with the expected value ("mass: a number from … is
/// expected"), or "".
std::string faultOfBody(const AuthoredBody&);
std::string faultOfName(std::string_view name);
std::string faultOfWorld(const Aabb&);

/// Formats a scene as JSON (docs/scene-format.md), one body per line. Round-trips bit for bit.
/// Throws InputError if a part of the scene is invalid.
std::string formatAuthoredScene(const AuthoredScene&);

/// Parses such a text, in time and memory proportional to its length; `name` is used in messages.
/// Throws InputError with the body, the key and the expected value.
AuthoredScene parseAuthoredScene(std::string_view json, std::string_view name);

/// A body that fills this box: a sphere if the object type is "Spheres".
AuthoredBody bodyFilling(const Aabb& box, const std::string& object_type = {});

/// The object type for recordings: "Cubes" or "Spheres" if all bodies are, otherwise "Assorted".
std::string objectTypeName(const AuthoredScene&);

CollisionFilter collisionFilterOf(const AuthoredScene&);

/// The tight box of each body in its initial pose.
std::vector<Aabb> boxesOf(const AuthoredScene&);

}  // namespace broadmark::scenes
