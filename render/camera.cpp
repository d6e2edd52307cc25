#include "broadmark/render/camera.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace broadmark {
namespace {

using Eigen::Map;
using Eigen::Matrix4f;
using Eigen::Vector2f;
using Eigen::Vector3f;
using Eigen::Vector4f;

Matrix4f viewMatrix(const Camera& camera) {
  const CameraAxes axes = axesOf(camera);
  Matrix4f view = Matrix4f::Identity();
  view.block<1, 3>(0, 0) = Vector3f(axes.right.data());
  view.block<1, 3>(1, 0) = Vector3f(axes.up.data());
  view.block<1, 3>(2, 0) = Vector3f(axes.back.data());
  view.block<3, 1>(0, 3) = -view.block<3, 3>(0, 0) * Vector3f(camera.eye.data());
  return view;
}

Matrix4f projectionMatrix(const Camera& camera) {
  const Vector2f low(camera.window_min.data());
  const Vector2f high(camera.window_max.data());
  const Vector2f size = high - low;
  const float depth = camera.far - camera.near;
  Matrix4f projection = Matrix4f::Zero();
  projection(0, 0) = 2 / size.x();
  projection(1, 1) = 2 / size.y();
  projection(0, 2) = (high.x() + low.x()) / size.x();
  projection(1, 2) = (high.y() + low.y()) / size.y();
  projection(2, 2) = -(camera.far + camera.near) / depth;
  projection(2, 3) = -2 * camera.far * camera.near / depth;
  projection(3, 2) = -1;
  return projection;
}

Matrix4f viewProjectionMatrix(const Camera& camera) {
  return projectionMatrix(camera) * viewMatrix(camera);
}

Vector3f corner(const Aabb& box, int index) {
  Vector3f point;
  for (int axis = 0; axis < 3; ++axis) {
    point[axis] = ((index >> axis) & 1) != 0 ? box.max[axis] : box.min[axis];
  }
  return point;
}

}  // namespace

std::array<float, 3> ViewSpace::toView(const std::array<float, 4>& world_point) const {
  std::array<float, 3> point;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double value = (double{world_point[axis]} - origin[axis]) / side;
    point[axis] = static_cast<float>(std::clamp(value, -kLimit, kLimit));
  }
  return point;
}

Aabb ViewSpace::toView(const Aabb& world_box) const {
  const std::array<float, 3> low = toView(world_box.min);
  const std::array<float, 3> high = toView(world_box.max);
  return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

ViewSpace viewSpaceOf(const Aabb& box) {
  ViewSpace space;
  for (std::size_t axis = 0; axis < 3; ++axis) space.origin[axis] = centreOf(box, axis);
  const double longest = longestEdge(box);
  if (longest > 0) space.side = longest;
  return space;
}

Aabb shownBox(const Aabb& world, std::span<const Aabb> boxes) {
  std::size_t present = 0;
  std::size_t inside = 0;
  Aabb all = kEmptyBox;
  for (const Aabb& box : boxes) {
    if (isEmpty(box)) continue;
    ++present;
    inside += holdsCentre(world, box) ? 1 : 0;
    all = merged(all, box);
  }
  if (present == 0) return world;
  if (longestEdge(world) == 0) return all;
  return 2 * inside >= present ? world : merged(world, all);
}

Camera figureCamera(const Aabb& box, double aspect) {
  constexpr float kMargin = 0.04F;  // on each side, of the extent of the box
  Camera camera;
  camera.eye = {0.57F * 3, 0.20F * 3, 0.60F * 3};
  camera.target = {0, -0.15F, 0};

  const Matrix4f view = viewMatrix(camera);
  Vector2f low = Vector2f::Constant(std::numeric_limits<float>::max());
  Vector2f high = -low;
  for (int index = 0; index < 8; ++index) {
    const Vector4f point = view * corner(box, index).homogeneous();
    const Vector2f on_plane = point.head<2>() / -point.z();
    low = low.cwiseMin(on_plane);
    high = high.cwiseMax(on_plane);
  }

  const Vector2f centre = (low + high) / 2;
  // A point has no extent: it gets about the window of a unit box.
  const bool is_point = (high - low).norm() < 1e-3F;
  const Vector2f extent =
      is_point ? Vector2f::Constant(0.5F) : Vector2f((high - low) * (1 + 2 * kMargin));
  const auto ratio = static_cast<float>(aspect);
  const float height = std::max(extent.y(), extent.x() / ratio);
  const Vector2f half(height * ratio / 2, height / 2);
  Map<Vector2f>(camera.window_min.data()) = centre - half;
  Map<Vector2f>(camera.window_max.data()) = centre + half;
  return camera;
}

CameraAxes axesOf(const Camera& camera) {
  const Vector3f back = (Vector3f(camera.eye.data()) - Vector3f(camera.target.data())).normalized();
  // Straight up or down the horizontal is undefined: x then points to the right.
  Vector3f right = Vector3f::UnitY().cross(back);
  right = right.norm() > 1e-6F ? right.normalized() : Vector3f::UnitX();
  CameraAxes axes;
  Map<Vector3f>(axes.right.data()) = right;
  Map<Vector3f>(axes.up.data()) = back.cross(right);
  Map<Vector3f>(axes.back.data()) = back;
  return axes;
}

float focus(const Camera& camera) {
  return std::hypot(camera.eye[0] - camera.target[0], camera.eye[1] - camera.target[1],
                    camera.eye[2] - camera.target[2]);
}

float pixelSize(const Camera& camera, int height) {
  return (camera.window_max[1] - camera.window_min[1]) / static_cast<float>(height);
}

std::array<float, 16> viewProjection(const Camera& camera) {
  std::array<float, 16> columns;
  Map<Matrix4f>(columns.data()) = viewProjectionMatrix(camera);
  return columns;
}

std::optional<std::array<float, 3>> project(const Camera& camera,
                                            const std::array<float, 3>& point) {
  const Vector4f clip = viewProjectionMatrix(camera) * Vector3f(point.data()).homogeneous();
  if (clip.w() <= 0) return std::nullopt;
  return std::array{clip.x() / clip.w(), clip.y() / clip.w(), clip.z() / clip.w()};
}

}  // namespace broadmark
