// The interactive camera, which turns about a pivot in view space: a plain struct and pure
// functions on it. toCamera() makes the Camera to draw with.
#pragma once

#include <array>

#include "broadmark/aabb.h"
#include "broadmark/names.h"
#include "broadmark/render/camera.h"

namespace broadmark {

/// Looks at the pivot from a distance; y is up, angles in radians.
struct OrbitCamera {
  std::array<float, 3> pivot{};
  float yaw = 0;                ///< 0 looks along -z, a quarter turn looks along -x
  float pitch = 0;              ///< positive looks down; within ±kSteepest
  float distance = 2;           ///< from the pivot to the eye, kNearest…kFarthest
  float field_of_view = 0.70F;  ///< from the picture's lower to its upper border
  float cut = kUncut;           ///< nearer than this part of the distance nothing is drawn; below 1

  /// A little less than straight down, where the yaw would have no meaning.
  static constexpr float kSteepest = 1.562F;
  static constexpr float kUncut = 0.02F;
  static constexpr float kNearest = 1e-5F;
  static constexpr float kFarthest = 1e4F;

  friend bool operator==(const OrbitCamera&, const OrbitCamera&) = default;
};

/// Where to look from; pivot and distance stay.
enum class Direction { figure, front, back, left, right, top, bottom };
inline constexpr NameTable kDirections{{NamedValue{Direction::figure, "figure"},
                                        {Direction::front, "front"},
                                        {Direction::back, "back"},
                                        {Direction::left, "left"},
                                        {Direction::right, "right"},
                                        {Direction::top, "top"},
                                        {Direction::bottom, "bottom"}}};
OrbitCamera lookedFrom(OrbitCamera camera, Direction direction);

/// Turns about the pivot, by radians.
OrbitCamera orbited(OrbitCamera camera, float yaw, float pitch);

/// Moves the picture to the right and up, by parts of its height: a point at the pivot's depth
/// stays under the pointer that drags it.
OrbitCamera panned(OrbitCamera camera, float right, float up);

/// Brings `point` (in view space) nearer (`factor` < 1) or farther away (> 1) without moving it on
/// the screen; pointUnder() gives the point under the pointer. Stops at the limits of the distance.
OrbitCamera zoomed(OrbitCamera camera, float factor, const std::array<float, 3>& point);

/// Moves eye and pivot by multiples of the distance: the speed suits the scale of the picture.
OrbitCamera flown(OrbitCamera camera, float forward, float right, float up);

/// Looks at the middle of a box (in view space), in the same direction, from a distance that shows
/// all of it. Around a very small box some of its neighbourhood is shown.
OrbitCamera focusedOn(OrbitCamera camera, const Aabb& box, double aspect);

/// Cuts away everything nearer to the eye than a box (in view space).
OrbitCamera cutAway(OrbitCamera camera, const Aabb& box);

/// The way from one view to another, t from 0 to 1, slow at both ends. The new pivot moves across
/// the screen in a straight line.
OrbitCamera between(const OrbitCamera& from, const OrbitCamera& to, float t);

/// The point at the pivot's depth that is seen at (x, y), each from -1 to 1, y upwards.
std::array<float, 3> pointUnder(const OrbitCamera& camera, double aspect, float x, float y);

/// The camera to draw with, for an aspect ratio (width / height). `contents` (in view space) bounds
/// everything to be seen: near and far follow from it.
Camera toCamera(const OrbitCamera& camera, double aspect, const Aabb& contents);

}  // namespace broadmark
