// Picking tests a ray against the slabs of each box; selecting tests each box against the planes of
// a frustum. O(n). Double precision: neither far-off nor tiny bodies are lost.
#include "broadmark/render/picking.h"

#include <algorithm>

namespace broadmark {
namespace {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector widened(const std::array<float, 3>& vector) { return {vector[0], vector[1], vector[2]}; }

Vector eyeInWorld(const Camera& camera, const ViewSpace& space) {
  Vector eye;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    eye[axis] = space.origin[axis] + space.side * double{camera.eye[axis]};
  }
  return eye;
}

/// Where a point of the picture lies on the window at distance 1.
std::array<float, 2> onWindow(const Viewpoint& viewpoint, float x, float y) {
  const Camera& camera = viewpoint.camera;
  const float u = x / static_cast<float>(viewpoint.width);
  const float v = 1 - y / static_cast<float>(viewpoint.height);
  return {camera.window_min[0] + u * (camera.window_max[0] - camera.window_min[0]),
          camera.window_min[1] + v * (camera.window_max[1] - camera.window_min[1])};
}

bool counts(std::span<const Aabb> boxes, BodyMask mask, std::size_t body) {
  return !isEmpty(boxes[body]) && (mask.empty() || mask[body] != 0);
}

/// The corners of a box relative to the eye, in view units.
struct SeenBox {
  Vector low;
  Vector high;
};

SeenBox seenBox(const Aabb& box, const Vector& eye, double scale) {
  SeenBox seen;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    seen.low[axis] = (double{box.min[axis]} - eye[axis]) * scale;
    seen.high[axis] = (double{box.max[axis]} - eye[axis]) * scale;
  }
  return seen;
}

/// Like the box shader: makes every side at least a given number of pixels long.
void enlarge(SeenBox& box, const Vector& forward, double half_side_at_1) {
  Vector centre;
  for (std::size_t axis = 0; axis < 3; ++axis) centre[axis] = (box.low[axis] + box.high[axis]) / 2;
  const double half = half_side_at_1 * dot(centre, forward);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = std::min(box.low[axis], centre[axis] - half);
    box.high[axis] = std::max(box.high[axis], centre[axis] + half);
  }
}

/// All points p with dot(normal, p) >= offset.
struct Plane {
  Vector normal{};
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
    Plane result{{}, offset};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result.normal[axis] = right_part * double{axes.right[axis]} +
                            up_part * double{axes.up[axis]} + back_part * double{axes.back[axis]};
    }
    return result;
  };
  return {plane(1, 0, low[0], 0), plane(-1, 0, -high[0], 0), plane(0, 1, low[1], 0),
          plane(0, -1, -high[1], 0), plane(0, 0, -1, viewpoint.camera.near)};
}

bool isWithin(const std::array<Plane, 5>& planes, const SeenBox& box) {
  return std::all_of(planes.begin(), planes.end(), [&](const Plane& plane) {
    double least = 0;  // over the corners
    for (std::size_t axis = 0; axis < 3; ++axis) {
      least += std::min(plane.normal[axis] * box.low[axis], plane.normal[axis] * box.high[axis]);
    }
    return least >= plane.offset;
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
                                   float smallest) {
  const Camera& camera = viewpoint.camera;
  const Vector eye = eyeInWorld(camera, space);
  const double scale = 1 / space.side;
  const Vector direction = widened(rayThrough(viewpoint, x, y).direction);
  const Vector inverse = {1 / direction[0], 1 / direction[1], 1 / direction[2]};
  const std::array<float, 3> back = axesOf(camera).back;
  const Vector forward = {-back[0], -back[1], -back[2]};
  const double half_side = double{smallest} * double{pixelSize(camera, viewpoint.height)};

  std::optional<PickedBody> picked;
  double nearest = camera.far;
  for (std::size_t body = 0; body < boxes.size(); ++body) {
    if (!counts(boxes, mask, body)) continue;
    SeenBox box = seenBox(boxes[body], eye, scale);
    enlarge(box, forward, half_side);
    double enter = camera.near;
    double leave = nearest;
    bool is_before = false;  // the box is in front of the eye, not around it
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // A ray in the plane of a face may make one of these NaN. Of two boxes that share the face
      // one is then hit.
      const double a = box.low[axis] * inverse[axis];
      const double b = box.high[axis] * inverse[axis];
      const double first = std::min(a, b);
      is_before = is_before || first >= camera.near;
      enter = std::max(enter, first);
      leave = std::min(leave, std::max(a, b));
    }
    if (!is_before || enter > leave || !(enter < nearest)) continue;
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
    if (!counts(boxes, mask, body)) continue;
    SeenBox box = seenBox(boxes[body], eye, 1 / space.side);
    if (by == SelectBy::centre) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        box.low[axis] = box.high[axis] = (box.low[axis] + box.high[axis]) / 2;
      }
    }
    if (isWithin(planes, box)) bodies.push_back(static_cast<std::uint32_t>(body));
  }
  return bodies;
}

}  // namespace broadmark
