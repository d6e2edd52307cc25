// The interactive camera, which orbits a pivot in view space: a plain struct with pure functions.
// toCamera() converts it to a Camera for drawing.
#pragma once

#include <array>

#include "broadmark/aabb.h"
#include "broadmark/names.h"
#include "broadmark/render/camera.h"

namespace broadmark {

/// A camera directed at the pivot; y is up, angles are in radians.
struct OrbitCamera {
  std::array<float, 3> pivot{};
  float yaw = 0;                ///< view direction: 0 is -z, a quarter turn is -x
  float pitch = 0;              ///< positive is downwards; within ±kSteepest
  float distance = 2;           ///< from the pivot to the eye, kNearest…kFarthest
  float field_of_view = 0.70F;  ///< vertical

  /// Slightly less than straight down, where the yaw is undefined.
  static constexpr float kSteepest = 1.562F;
  static constexpr float kNearest = 1e-5F;
  static constexpr float kFarthest = 1e4F;

  friend bool operator==(const OrbitCamera&, const OrbitCamera&) = default;
};

/// Standard views, with the same pivot and distance.
enum class Direction { figure, front, back, left, right, top, bottom };
inline constexpr NameTable kDirections{{NamedValue{Direction::figure, "default"},
                                        {Direction::front, "front"},
                                        {Direction::back, "back"},
                                        {Direction::left, "left"},
                                        {Direction::right, "right"},
                                        {Direction::top, "top"},
                                        {Direction::bottom, "bottom"}}};
OrbitCamera viewedFrom(OrbitCamera camera, Direction direction);

/// Orbits the pivot by angles in radians.
OrbitCamera orbited(OrbitCamera camera, float yaw, float pitch);

/// Pans the picture to the right and up, by fractions of its height: a dragged point at the
/// pivot's depth remains under the pointer.
OrbitCamera panned(OrbitCamera camera, float right, float up);

/// Zooms towards `point` (in view space; `factor` < 1) or away from it (> 1) without moving it on
/// the screen; pointUnder() gives the point under the pointer. The distance is clamped.
OrbitCamera zoomed(OrbitCamera camera, float factor, const std::array<float, 3>& point);

/// Moves eye and pivot by multiples of the distance, so that the speed scales with the picture.
OrbitCamera flown(OrbitCamera camera, float forward, float right, float up);

/// Focuses the centre of a box (in view space) in the same direction, at a distance that shows the
/// whole box, or a neighbourhood of a very small box.
OrbitCamera focusedOn(OrbitCamera camera, const Aabb& box, double aspect);

/// Interpolates between two views, with t from 0 to 1, slowly at both ends. The new pivot moves on
/// a straight line on the screen.
OrbitCamera between(const OrbitCamera& from, const OrbitCamera& to, float t);

/// The point at the pivot's depth that appears at (x, y), each from -1 to 1, y upwards.
std::array<float, 3> pointUnder(const OrbitCamera& camera, double aspect, float x, float y);

/// The camera for drawing, for an aspect ratio (width / height). `contents` (in view space) bounds
/// all visible objects, and determines the near and far planes.
Camera toCamera(const OrbitCamera& camera, double aspect, const Aabb& contents);

}  // namespace broadmark
