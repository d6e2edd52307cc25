// In double precision, so that pure translations add floats exactly.

#include "broadmark/scenes/transformation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace broadmark::scenes {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

Vector3d wide(const Vec3& v) { return {v[0], v[1], v[2]}; }
Quaterniond wide(const Quaternion& q) { return {q[3], q[0], q[1], q[2]}; }
Vec3 narrow(const Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// The factor by which an edge in this direction grows.
double factorAlong(const Vector3d& direction, const Transformation& change) {
  const Vector3d along = wide(change.axes).conjugate() * direction;
  return along.cwiseProduct(wide(change.scale)).norm() / along.norm();
}

}  // namespace

Pose transformedPose(const AuthoredBody& body, const Transformation& change) {
  const Vector3d centre = wide(change.centre);
  const Quaterniond axes = wide(change.axes);
  const Vector3d along = axes.conjugate() * (wide(body.pose.position) - centre);
  const Vector3d scaled = axes * along.cwiseProduct(wide(change.scale));
  Pose pose = body.pose;
  pose.position = narrow(centre + wide(change.turn) * scaled + wide(change.move));
  if (change.turn == Transformation().turn) return pose;
  const Quaterniond turned = (wide(change.turn) * wide(body.pose.rotation)).normalized();
  const Vec3 parts = narrow(turned.vec());
  pose.rotation = {parts[0], parts[1], parts[2], static_cast<float>(turned.w())};
  return pose;
}

Shape transformedShape(const AuthoredBody& body, const Transformation& change) {
  if (change.scale == Transformation().scale) return body.shape;
  if (const auto* sphere = std::get_if<SphereShape>(&body.shape)) {
    const double factor = std::cbrt(wide(change.scale).prod());
    return SphereShape{static_cast<float>(factor * sphere->radius)};
  }
  BoxShape box = std::get<BoxShape>(body.shape);
  const Quaterniond rotation = wide(body.pose.rotation);
  for (int axis = 0; axis < 3; ++axis) {
    const double factor = factorAlong(rotation * Vector3d::Unit(axis), change);
    box.half_extents[static_cast<std::size_t>(axis)] *= static_cast<float>(factor);
  }
  return box;
}

Vec3 anglesOf(const Quaternion& rotation) {
  constexpr double kUpright = 1 - 1e-9;  // beyond, a turn about x is one about z
  const Eigen::Matrix3d m = wide(rotation).normalized().toRotationMatrix();
  const double sine = std::clamp(-m(2, 0), -1.0, 1.0);
  const bool is_upright = std::abs(sine) > kUpright;
  const double x = is_upright ? std::atan2(-m(1, 2), m(1, 1)) : std::atan2(m(2, 1), m(2, 2));
  const double z = is_upright ? 0 : std::atan2(m(1, 0), m(0, 0));
  const Vector3d angles = Vector3d(x, std::asin(sine), z) * (180 / std::numbers::pi);
  return narrow(angles + Vector3d::Zero());  // 0 instead of -0
}

Quaternion rotationBy(const Vec3& angles) {
  const Vector3d radians = wide(angles) * (std::numbers::pi / 180);
  const Quaterniond rotation = Eigen::AngleAxisd(radians.z(), Vector3d::UnitZ()) *
                               Eigen::AngleAxisd(radians.y(), Vector3d::UnitY()) *
                               Eigen::AngleAxisd(radians.x(), Vector3d::UnitX());
  const Vec3 parts = narrow(rotation.vec());
  return {parts[0], parts[1], parts[2], static_cast<float>(rotation.w())};
}

}  // namespace broadmark::scenes
