#include "broadmark/render/orbit_camera.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace broadmark {
namespace {

using Eigen::Map;
using Eigen::Vector3f;

constexpr float kNearPlane = 0.02F;  // as a fraction of the distance
constexpr float kFullTurn = 2 * std::numbers::pi_v<float>;

/// From the pivot to the eye.
Vector3f backwards(const OrbitCamera& camera) {
  return {std::cos(camera.pitch) * std::sin(camera.yaw), std::sin(camera.pitch),
          std::cos(camera.pitch) * std::cos(camera.yaw)};
}

Vector3f rightwards(const OrbitCamera& camera) {
  return {std::cos(camera.yaw), 0, -std::sin(camera.yaw)};
}

Vector3f upwards(const OrbitCamera& camera) { return backwards(camera).cross(rightwards(camera)); }

Vector3f pivotOf(const OrbitCamera& camera) { return Vector3f(camera.pivot.data()); }

OrbitCamera withPivot(OrbitCamera camera, const Vector3f& pivot) {
  constexpr auto kLimit = static_cast<float>(ViewSpace::kLimit);
  Map<Vector3f>(camera.pivot.data()) = pivot.cwiseMax(-kLimit).cwiseMin(kLimit);
  return camera;
}

/// Half the picture's height at distance 1.
float halfHeight(const OrbitCamera& camera) { return std::tan(camera.field_of_view / 2); }

Vector3f centreOf(const Aabb& box) {
  return (Vector3f(box.min.data()) + Vector3f(box.max.data())) / 2;
}

/// An angle in (-pi, pi], so that the camera turns by the smaller angle.
float wrappedAngle(float angle) { return std::remainder(angle, kFullTurn); }

float smooth(float t) {
  const float clamped = std::clamp(t, 0.0F, 1.0F);
  return clamped * clamped * (3 - 2 * clamped);
}

/// The distances from a point to the nearest and the farthest point of a box.
std::pair<float, float> distancesTo(const Aabb& box, const Vector3f& point) {
  const Vector3f low = Vector3f(box.min.data()) - point;
  const Vector3f high = Vector3f(box.max.data()) - point;
  const Vector3f outside = low.cwiseMax(-high).cwiseMax(Vector3f::Zero());
  return {outside.norm(), low.cwiseAbs().cwiseMax(high.cwiseAbs()).norm()};
}

}  // namespace

OrbitCamera viewedFrom(OrbitCamera camera, Direction direction) {
  constexpr float kQuarter = kFullTurn / 4;
  camera.yaw = camera.pitch = 0;
  switch (direction) {
    case Direction::figure:  // as figureCamera()
      camera.yaw = std::atan2(0.57F, 0.60F);
      camera.pitch = std::atan2(0.20F + 0.05F, std::hypot(0.57F, 0.60F));
      break;
    case Direction::front:
      break;
    case Direction::back:
      camera.yaw = 2 * kQuarter;
      break;
    case Direction::left:
      camera.yaw = -kQuarter;
      break;
    case Direction::right:
      camera.yaw = kQuarter;
      break;
    case Direction::top:
      camera.pitch = OrbitCamera::kSteepest;
      break;
    case Direction::bottom:
      camera.pitch = -OrbitCamera::kSteepest;
      break;
  }
  return camera;
}

OrbitCamera orbited(OrbitCamera camera, float yaw, float pitch) {
  camera.yaw = wrappedAngle(camera.yaw + yaw);
  camera.pitch = std::clamp(camera.pitch + pitch, -OrbitCamera::kSteepest, OrbitCamera::kSteepest);
  return camera;
}

OrbitCamera panned(OrbitCamera camera, float right, float up) {
  const float height = 2 * halfHeight(camera) * camera.distance;
  return withPivot(camera,
                   pivotOf(camera) - height * (right * rightwards(camera) + up * upwards(camera)));
}

OrbitCamera zoomed(OrbitCamera camera, float factor, const std::array<float, 3>& point) {
  const float distance =
      std::clamp(camera.distance * factor, OrbitCamera::kNearest, OrbitCamera::kFarthest);
  // Eye and pivot move towards the point by the same factor, which preserves its screen position.
  const Vector3f fixed(point.data());
  camera = withPivot(camera, fixed + (pivotOf(camera) - fixed) * (distance / camera.distance));
  camera.distance = distance;
  return camera;
}

OrbitCamera flown(OrbitCamera camera, float forward, float right, float up) {
  return withPivot(camera, pivotOf(camera) + camera.distance * (right * rightwards(camera) +
                                                                up * upwards(camera) -
                                                                forward * backwards(camera)));
}

OrbitCamera focusedOn(OrbitCamera camera, const Aabb& box, double aspect) {
  constexpr float kMargin = 1.1F;
  constexpr float kSmallestSide = 1e-4F;
  const Vector3f half_sides =
      ((Vector3f(box.max.data()) - Vector3f(box.min.data())) / 2).cwiseMax(kSmallestSide / 2);
  const float half_height = halfHeight(camera);
  const float half_width = half_height * static_cast<float>(aspect);
  float distance = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3f signs((corner & 1) != 0 ? 1.0F : -1.0F, (corner & 2) != 0 ? 1.0F : -1.0F,
                         (corner & 4) != 0 ? 1.0F : -1.0F);
    const Vector3f point = half_sides.cwiseProduct(signs);
    const float offset_distance = std::max(std::abs(point.dot(rightwards(camera))) / half_width,
                                           std::abs(point.dot(upwards(camera))) / half_height);
    distance = std::max(distance, point.dot(backwards(camera)) + kMargin * offset_distance);
  }
  camera.distance = std::clamp(distance, OrbitCamera::kNearest, OrbitCamera::kFarthest);
  return withPivot(camera, centreOf(box));
}

OrbitCamera between(const OrbitCamera& from, const OrbitCamera& to, float t) {
  const float s = smooth(t);
  if (s >= 1) return to;
  OrbitCamera camera = from;
  camera.yaw = from.yaw + s * wrappedAngle(to.yaw - from.yaw);
  camera.pitch = std::lerp(from.pitch, to.pitch, s);
  camera.field_of_view = std::lerp(from.field_of_view, to.field_of_view, s);
  camera.distance = from.distance * std::pow(to.distance / from.distance, s);
  // The pivot moves in proportion to the distance. Otherwise the new pivot would leave the picture
  // during a long zoom.
  const float change = from.distance - to.distance;
  const float remaining =
      std::abs(change) > 1e-3F * from.distance ? (camera.distance - to.distance) / change : 1 - s;
  return withPivot(camera, pivotOf(to) + remaining * (pivotOf(from) - pivotOf(to)));
}

std::array<float, 3> pointUnder(const OrbitCamera& camera, double aspect, float x, float y) {
  const float half_height = halfHeight(camera) * camera.distance;
  const float half_width = half_height * static_cast<float>(aspect);
  std::array<float, 3> point;
  Map<Vector3f>(point.data()) =
      pivotOf(camera) + x * half_width * rightwards(camera) + y * half_height * upwards(camera);
  return point;
}

Camera toCamera(const OrbitCamera& orbit, double aspect, const Aabb& contents) {
  Camera camera;
  const Vector3f eye = pivotOf(orbit) + orbit.distance * backwards(orbit);
  Map<Vector3f>(camera.eye.data()) = eye;
  camera.target = orbit.pivot;
  const float half_height = halfHeight(orbit);
  const float half_width = half_height * static_cast<float>(aspect);
  camera.window_min = {-half_width, -half_height};
  camera.window_max = {half_width, half_height};
  // The near plane depends on the pivot's distance. Planes close to the contents increase the depth
  // precision.
  const auto [nearest, farthest] = distancesTo(contents, eye);
  camera.near = std::max(kNearPlane * orbit.distance, 0.5F * nearest);
  camera.far = std::max(1.02F * farthest, 2 * camera.near);
  return camera;
}

}  // namespace broadmark
