// Validation of scenes and their bodies, and the boxes and object type of the bodies.

#include "broadmark/scenes/authored_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "authoring/faults.h"
#include "broadmark/error.h"
#include "broadmark/recordings/posrot.h"
#include "broadmark/scenes/registry.h"
#include "broadmark/scenes/simulation.h"
#include "entries.h"

namespace broadmark::scenes {
namespace {

constexpr float kMaxCoordinate = 1e9F;
constexpr float kMaxSpeed = 1e6F;
constexpr double kMinMass = 1e-6;
constexpr double kMaxMass = 1e9;

bool isWithin(std::span<const float> values, float limit) {
  // Comparisons with NaN are false.
  return std::ranges::all_of(values, [&](float value) { return std::abs(value) <= limit; });
}

bool isSize(float edge) { return edge >= kMinEdge && edge <= kMaxEdge; }

std::string outOfRange(std::string_view key, double max) {
  return fmt::format("{}: numbers from {:g} to {:g} are expected", key, -max, max);
}

/// The fault of a body, with its id.
std::string faultOfBody(const AuthoredBody& body, std::size_t id) {
  const std::string fault = faultOfBody(body);
  return fault.empty() ? fault : fmt::format("body {}: {}", id, fault);
}

}  // namespace

std::string faultOfBody(const AuthoredBody& body) {
  if (!std::ranges::all_of(edgesOf(body.shape), isSize)) {
    return fmt::format("size: edges or a diameter from {:g} to {:g} are expected", kMinEdge,
                       kMaxEdge);
  }
  if (!isWithin(body.pose.position, kMaxCoordinate)) {
    return outOfRange("position", kMaxCoordinate);
  }
  float length = 0;
  for (const float component : body.pose.rotation) length += component * component;
  if (!(std::abs(length - 1) <= kRotationTolerance)) {
    return "rotation: a quaternion x, y, z, w of unit length is expected";
  }
  if (!(body.mass >= kMinMass && body.mass <= kMaxMass)) {
    return fmt::format("mass: a number from {:g} to {:g} is expected", kMinMass, kMaxMass);
  }
  if (!isWithin(body.linear_velocity, kMaxSpeed)) return outOfRange("velocity", kMaxSpeed);
  if (!isWithin(body.angular_velocity, kMaxSpeed)) {
    return outOfRange("angular_velocity", kMaxSpeed);
  }
  if (body.layer >= LayerMatrix::kLayers) return faultOfLayer("layer");
  if (body.appears > kMaxFrames) {
    return fmt::format("appears: a frame from 0 to {} is expected", kMaxFrames);
  }
  if (body.vanishes <= body.appears || (body.vanishes > kMaxFrames && body.vanishes != kNever)) {
    return fmt::format("vanishes: a frame from {} to {} is expected: it appears in frame {}",
                       body.appears + 1, kMaxFrames, body.appears);
  }
  if (body.group > kMaxBodies) {
    return fmt::format("group: a whole number from 0 to {} is expected", kMaxBodies);
  }
  return {};
}

std::string faultOfLayer(std::string_view key) {
  return fmt::format("{}: a layer from 0 to {} is expected", key, LayerMatrix::kLayers - 1);
}

std::string faultOfName(std::string_view name) {
  const bool printable =
      std::ranges::all_of(name, [](char c) { return c >= ' ' && c <= '~' && c != '/'; });
  if (printable && !name.empty() && name.size() <= kMaxNameLength) return {};
  return fmt::format(
      "name: 1 to {} printable ASCII characters are expected, none of them '/': it becomes part of "
      "file names",
      kMaxNameLength);
}

std::string faultOfWorld(const Aabb& world) {
  for (int axis = 0; axis < 3; ++axis) {
    const bool is_valid = std::abs(world.min[axis]) <= kMaxCoordinate &&
                          std::abs(world.max[axis]) <= kMaxCoordinate &&
                          world.min[axis] < world.max[axis];
    if (is_valid) continue;
    return fmt::format("world: min below max is expected on every axis, from {:g} to {:g}",
                       -kMaxCoordinate, kMaxCoordinate);
  }
  return {};
}

void requireValid(const AuthoredBody& body, std::size_t id) {
  const std::string fault = faultOfBody(body, id);
  if (!fault.empty()) throw InputError(fault);
}

void requireValid(const AuthoredScene& scene) {
  const auto require_no_fault = [](const std::string& fault) {
    if (!fault.empty()) throw InputError("authored scene: " + fault);
  };
  require_no_fault(faultOfName(scene.name));
  require_no_fault(faultOfWorld(scene.world));
  if (scene.bodies.size() > kMaxBodies) {
    require_no_fault(fmt::format("bodies: {} are more than {}", scene.bodies.size(), kMaxBodies));
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    require_no_fault(faultOfBody(scene.bodies[i], i));
  }
}

std::string objectTypeName(const AuthoredScene& scene) {
  const auto all_shapes = [&](auto&& holds) {
    return std::ranges::all_of(scene.bodies,
                               [&](const AuthoredBody& body) { return holds(body.shape); });
  };
  const bool spheres =
      all_shapes([](const Shape& s) { return std::holds_alternative<SphereShape>(s); });
  const bool cubes = all_shapes([](const Shape& s) {
    const Vec3 edges = edgesOf(s);
    return std::holds_alternative<BoxShape>(s) && edges[0] == edges[1] && edges[1] == edges[2];
  });
  const std::string id = cubes ? "cubes" : spheres ? "spheres" : "assorted";
  return entryOf(objectTypes(), id, "object type").listing.name;
}

CollisionFilter collisionFilterOf(const AuthoredScene& scene) {
  std::vector<BodyGroups> bodies(scene.bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) bodies[i].layer = scene.bodies[i].layer;
  return {bodies, scene.collide};
}

std::vector<Aabb> boxesOf(const AuthoredScene& scene) {
  std::vector<Aabb> boxes(scene.bodies.size());
  std::ranges::transform(scene.bodies, boxes.begin(),
                         [](const AuthoredBody& body) { return tightBox(body.shape, body.pose); });
  return boxes;
}

}  // namespace broadmark::scenes
