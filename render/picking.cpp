// Picking tests a ray against the slabs of each box; selection tests each box against the planes of
// a frustum. O(n). Double precision is needed for distant and tiny bodies.
#include "broadmark/render/picking.h"

#include <Eigen/Core>
#include <algorithm>

namespace broadmark {
namespace {

using Vector = Eigen::Vector3d;

/// The first three numbers of a point or a corner.
template <class Numbers>
Vector widened(const Numbers& numbers) {
  return Eigen::Vector3f(numbers.data()).cast<double>();
}

Vector eyeInWorld(const Camera& camera, const ViewSpace& space) {
  return Vector(space.origin.data()) + space.side * widened(camera.eye);
}

/// The position of a picture's point on the window at distance 1.
std::array<float, 2> onWindow(const Viewpoint& viewpoint, float x, float y) {
  const Camera& camera = viewpoint.camera;
  const float u = x / static_cast<float>(viewpoint.width);
  const float v = 1 - y / static_cast<float>(viewpoint.height);
  return {camera.window_min[0] + u * (camera.window_max[0] - camera.window_min[0]),
          camera.window_min[1] + v * (camera.window_max[1] - camera.window_min[1])};
}

bool isPickable(std::span<const Aabb> boxes, BodyMask mask, std::size_t body) {
  return !isEmpty(boxes[body]) && (mask.empty() || mask[body] != 0);
}

/// The corners of a box relative to the eye, in view units.
struct ViewBox {
  Vector low;
  Vector high;
};

ViewBox toViewBox(const Aabb& box, const Vector& eye, double scale) {
  return {(widened(box.min) - eye) * scale, (widened(box.max) - eye) * scale};
}

/// Enlarges every side to at least a given number of pixels, like the box shader.
void enlarge(ViewBox& box, const Vector& forward, double half_side_at_1) {
  const Vector centre = (box.low + box.high) / 2;
  const double half = half_side_at_1 * centre.dot(forward);
  box.low = box.low.cwiseMin((centre.array() - half).matrix());
  box.high = box.high.cwiseMax((centre.array() + half).matrix());
}

/// All points p with dot(normal, p) >= offset.
struct Plane {
  Vector normal;
  double offset = 0;
};

/// The part of view space, relative to the eye, behind a rectangle of the picture.
std::array<Plane, 5> frustum(const Viewpoint& viewpoint, const ScreenRectangle& rectangle) {
  const auto [left, right] = std::minmax(rectangle.from[0], rectangle.to[0]);
  const auto [top, bottom] = std::minmax(rectangle.from[1], rectangle.to[1]);
  const std::array low = onWindow(viewpoint, left, bottom);
  const std::array high = onWindow(viewpoint, right, top);
  const CameraAxes axes = axesOf(viewpoint.camera);
  const auto plane = [&](double right_part, double up_part, double back_part, double offset) {
    return Plane{right_part * widened(axes.right) + up_part * widened(axes.up) +
                     back_part * widened(axes.back),
                 offset};
  };
  return {plane(1, 0, low[0], 0), plane(-1, 0, -high[0], 0), plane(0, 1, low[1], 0),
          plane(0, -1, -high[1], 0), plane(0, 0, -1, viewpoint.camera.near)};
}

bool isWithin(const std::array<Plane, 5>& planes, const ViewBox& box) {
  return std::all_of(planes.begin(), planes.end(), [&](const Plane& plane) {
    const auto min_corner =
        plane.normal.cwiseProduct(box.low).cwiseMin(plane.normal.cwiseProduct(box.high));
    return min_corner.sum() >= plane.offset;
  });
}

}  // namespace

std::array<float, 3> Ray::at(float depth) const {
  return {origin[0] + depth * direction[0], origin[1] + depth * direction[1],
          origin[2] + depth * direction[2]};
}

Ray rayThrough(const Viewpoint& viewpoint, float x, float y) {
  const std::array point = onWindow(viewpoint, x, y);
  const CameraAxes axes = axesOf(viewpoint.camera);
  Ray ray{viewpoint.camera.eye, {}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    ray.direction[axis] = point[0] * axes.right[axis] + point[1] * axes.up[axis] - axes.back[axis];
  }
  return ray;
}

std::optional<PickedBody> pickBody(std::span<const Aabb> boxes, const ViewSpace& space,
                                   const Viewpoint& viewpoint, float x, float y, BodyMask mask,
                                   float min_pixels) {
  const Camera& camera = viewpoint.camera;
  const Vector eye = eyeInWorld(camera, space);
  const double scale = 1 / space.side;
  const Vector direction = widened(rayThrough(viewpoint, x, y).direction);
  const Vector inverse = direction.cwiseInverse();
  const Vector forward = -widened(axesOf(camera).back);
  const double half_side = double{min_pixels} * double{pixelSize(camera, viewpoint.height)};

  std::optional<PickedBody> picked;
  double nearest = camera.far;
  for (std::size_t body = 0; body < boxes.size(); ++body) {
    if (!isPickable(boxes, mask, body)) continue;
    ViewBox box = toViewBox(boxes[body], eye, scale);
    enlarge(box, forward, half_side);
    double enter = camera.near;
    double leave = nearest;
    bool is_in_front = false;  // whether the box is in front of the eye, not around it
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // A ray in the plane of a face may yield NaN. Then one of two boxes that share the face is
      // hit.
      const double a = box.low[axis] * inverse[axis];
      const double b = box.high[axis] * inverse[axis];
      const double first = std::min(a, b);
      is_in_front = is_in_front || first >= camera.near;
      enter = std::max(enter, first);
      leave = std::min(leave, std::max(a, b));
    }
    if (!is_in_front || enter > leave || !(enter < nearest)) continue;
    nearest = enter;
    picked = PickedBody{static_cast<std::uint32_t>(body), static_cast<float>(enter)};
  }
  return picked;
}

std::vector<std::uint32_t> bodiesWithin(std::span<const Aabb> boxes, const ViewSpace& space,
                                        const Viewpoint& viewpoint,
                                        const ScreenRectangle& rectangle, BodyMask mask,
                                        SelectBy by) {
  const Vector eye = eyeInWorld(viewpoint.camera, space);
  const std::array planes = frustum(viewpoint, rectangle);
  std::vector<std::uint32_t> bodies;
  for (std::size_t body = 0; body < boxes.size(); ++body) {
    if (!isPickable(boxes, mask, body)) continue;
    ViewBox box = toViewBox(boxes[body], eye, 1 / space.side);
    if (by == SelectBy::centre) box.low = box.high = (box.low + box.high) / 2;
    if (isWithin(planes, box)) bodies.push_back(static_cast<std::uint32_t>(body));
  }
  return bodies;
}

}  // namespace broadmark
