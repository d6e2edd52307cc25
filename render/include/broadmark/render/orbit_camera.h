// The interactive camera: it turns about a pivot, in view space. A plain struct and pure functions
// on it; toCamera() gives what is drawn with.
#pragma once

#include <array>
#include <string_view>

#include "broadmark/aabb.h"
#include "broadmark/render/camera.h"

namespace broadmark {

/// Looks at the pivot from a distance; y is up, angles in radians.
struct OrbitCamera {
  std::array<float, 3> pivot{};
  float yaw = 0;                ///< 0 looks along -z, a quarter turn looks along -x
  float pitch = 0;              ///< positive looks down; within ±kSteepest
  float distance = 2;           ///< from the pivot to the eye, kNearest…kFarthest
  float field_of_view = 0.70F;  ///< from the picture's lower to its upper border
  float cut = kUncut;  ///< what is nearer than this part of the distance is cut away; below 1

  /// Straight down is not quite reached: there the yaw would have no meaning.
  static constexpr float kSteepest = 1.562F;
  static constexpr float kUncut = 0.02F;
  static constexpr float kNearest = 1e-5F;
  static constexpr float kFarthest = 1e4F;

  friend bool operator==(const OrbitCamera&, const OrbitCamera&) = default;
};

/// Where to look from, the pivot and the distance being kept.
enum class Direction { figure, front, back, left, right, top, bottom };
OrbitCamera lookedFrom(OrbitCamera camera, Direction direction);
inline constexpr Direction kAllDirections[] = {Direction::figure, Direction::front, Direction::back,
                                               Direction::left,   Direction::right, Direction::top,
                                               Direction::bottom};
std::string_view directionName(Direction direction);

/// Turns about the pivot, by radians.
OrbitCamera orbited(OrbitCamera camera, float yaw, float pitch);

/// Moves the picture by a part of its height, to the right and up: what lies at the pivot's depth
/// stays under the pointer that drags it.
OrbitCamera panned(OrbitCamera camera, float right, float up);

/// Brings `point` (in view space) nearer by `factor` (< 1) or farther away (> 1) without moving it
/// on the screen; pointUnder() gives the one under the pointer. At the limits of the distance it
/// goes as far as it can.
OrbitCamera zoomed(OrbitCamera camera, float factor, const std::array<float, 3>& point);

/// Moves eye and pivot, by multiples of the distance, so that the speed suits what is looked at.
OrbitCamera flown(OrbitCamera camera, float forward, float right, float up);

/// Looks at the middle of a box (in view space) from where all of it is in the picture, in the
/// same direction as before. A very small box keeps some of its neighbourhood.
OrbitCamera focusedOn(OrbitCamera camera, const Aabb& box, double aspect);

/// Cuts away what is nearer to the eye than a box (in view space), however much that is.
OrbitCamera cutAway(OrbitCamera camera, const Aabb& box);

/// The way from one view to another, t from 0 to 1, slow at both ends: what is flown to keeps to a
/// straight way across the screen while it grows.
OrbitCamera between(const OrbitCamera& from, const OrbitCamera& to, float t);

/// The point in the pivot's depth that is seen at (x, y), each from -1 to 1, y upwards.
std::array<float, 3> pointUnder(const OrbitCamera& camera, double aspect, float x, float y);

/// What is drawn with, for an aspect ratio (width / height). `contents` (in view space) bounds all
/// that is to be seen: near and far are chosen from it.
Camera toCamera(const OrbitCamera& camera, double aspect, const Aabb& contents);

}  // namespace broadmark
