// Cameras in view space: the world, moved to the origin and scaled to side 1 in double precision,
// so that no huge coordinate reaches a matrix.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "broadmark/aabb.h"
#include "broadmark/render/colour.h"

namespace broadmark {

/// The map from world to view space.
struct ViewSpace {
  std::array<double, 3> origin{};  ///< the world point that becomes 0
  double side = 1;                 ///< the world length that becomes 1; positive

  /// Transforms to view space, clamped to ±kLimit: finite for every finite point.
  [[nodiscard]] std::array<float, 3> toView(const std::array<float, 4>& world_point) const;
  [[nodiscard]] Aabb toView(const Aabb& world_box) const;

  static constexpr double kLimit = 1e5;

  friend bool operator==(const ViewSpace&, const ViewSpace&) = default;
};

/// The view space that centres `box` and scales its longest edge to 1. If `box` is a point,
/// lengths are not scaled.
ViewSpace viewSpaceOf(const Aabb& box);

/// The box that a picture should show: the world, merged with all bodies if it has no extent or
/// contains fewer than half of their centres.
Aabb shownBox(const Aabb& world, std::span<const Aabb> boxes);

/// A perspective camera in view space; y is up. The frustum may be shifted off the view axis.
struct Camera {
  std::array<float, 3> eye{0, 0, 3};
  std::array<float, 3> target{};
  /// The window on the plane at distance 1 before the eye: x to the right, y up.
  std::array<float, 2> window_min{-0.5F, -0.5F};
  std::array<float, 2> window_max{0.5F, 0.5F};
  float near = 0.01F;
  float far = 100;

  friend bool operator==(const Camera&, const Camera&) = default;
};

/// The camera of the paper's figures, at (0.57, 0.20, 0.60)·3 with the target (0, −0.15, 0). Its
/// window contains `box` (in view space), for any aspect ratio (width / height).
Camera figureCamera(const Aabb& box, double aspect);

/// Directions of the picture in view space, each of length 1.
struct CameraAxes {
  std::array<float, 3> right{};
  std::array<float, 3> up{};
  std::array<float, 3> back{};  ///< from the target to the eye
};
CameraAxes axesOf(const Camera& camera);

/// The length of a pixel at distance 1 from the eye, in a picture of this height.
float pixelSize(const Camera& camera, int height);

/// The matrix from view space to clip space, by columns as in OpenGL.
std::array<float, 16> viewProjection(const Camera& camera);

/// Distance from the eye to the target.
float focus(const Camera& camera);

/// Projects a point of view space: x and y in [-1, 1] from left to right and bottom to
/// top, depth in [-1, 1]. nullopt for a point behind the eye.
std::optional<std::array<float, 3>> project(const Camera& camera,
                                            const std::array<float, 3>& point);

/// The parameters of a picture.
struct Viewpoint {
  Camera camera;
  int width = 1;   ///< pixels
  int height = 1;  ///< pixels
  Rgb haze = 0;    ///< the background, towards which distant bodies fade

  friend bool operator==(const Viewpoint&, const Viewpoint&) = default;
};

}  // namespace broadmark
