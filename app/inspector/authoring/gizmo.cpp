// Handles are hit by their distance on the screen. What is dragged along an axis or a plane stays
// under the mouse: the nearest point of the axis to the line of sight, or that line's point in the
// plane. A ring turns by how far the mouse goes along its tangent where it was taken, so that it
// may be seen from any side.

#include "inspector/authoring/gizmo.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace broadmark {
namespace {

// Shares of the gizmo's length.
constexpr double kAxisStart = 0.16;
constexpr double kPlaneStart = 0.3;
constexpr double kPlaneEnd = 0.55;
constexpr double kGripAt = 0.8;  // on an axis
/// An axis is left out when it looks shorter than this share of its length, a plane when it is
/// flatter.
constexpr double kFlattest = 0.15;
/// A ring is shown so far behind the centre, as a share of its radius: all of it when it faces the
/// eye.
constexpr double kRingBehind = 0.12;
constexpr int kRingPoints = 64;
constexpr double kLeastFactor = 0.01;

Point operator+(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point operator*(double s, const Point& a) { return {s * a[0], s * a[1], s * a[2]}; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Point& a) { return std::sqrt(dot(a, a)); }
Point unit(const Point& a) { return 1 / std::max(length(a), 1e-300) * a; }
Point wide(const Vec3& v) { return {v[0], v[1], v[2]}; }
Vec3 narrow(const Point& p) {
  return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}

double roundedTo(double value, double step) {
  return step > 0 ? step * std::round(value / step) : value;
}

/// The axis of an axis' handle; the one across a plane's.
std::size_t axisOf(Handle handle) { return static_cast<std::size_t>(handle) % 3; }
bool isPlane(Handle handle) { return handle >= Handle::yz && handle <= Handle::xy; }

/// Of a line from a to b.
float distanceTo(Pixel a, Pixel b, Pixel pixel) {
  const float x = b[0] - a[0];
  const float y = b[1] - a[1];
  const float square = x * x + y * y;
  const float share =
      square > 0 ? std::clamp(((pixel[0] - a[0]) * x + (pixel[1] - a[1]) * y) / square, 0.0F, 1.0F)
                 : 0.0F;
  return std::hypot(pixel[0] - a[0] - share * x, pixel[1] - a[1] - share * y);
}

bool isInside(const std::vector<Pixel>& corners, Pixel pixel) {
  bool inside = false;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const auto& [x, y] = corners[i];
    const auto& [u, v] = corners[j];
    if ((y > pixel[1]) != (v > pixel[1]) && pixel[0] < (u - x) * (pixel[1] - y) / (v - y) + x) {
      inside = !inside;
    }
  }
  return inside;
}

std::optional<HandleShape> axisShape(Handle handle, const GizmoPlace& place, const Sight& sight) {
  const Point centre = wide(place.centre);
  const Point axis = place.axis(axisOf(handle));
  const Point sideways = cross(axis, unit(sight.eye() - centre));
  if (length(sideways) < kFlattest) return {};
  const auto at = [&](double share) { return centre + share * place.length * axis; };
  return HandleShape{handle, {at(kAxisStart), at(1)}, false, at(kGripAt)};
}

std::optional<HandleShape> planeShape(Handle handle, const GizmoPlace& place, const Sight& sight) {
  const Point centre = wide(place.centre);
  const std::size_t normal = axisOf(handle);
  if (std::abs(dot(place.axis(normal), unit(sight.eye() - centre))) < kFlattest) return {};
  const Point first = place.length * place.axis((normal + 1) % 3);
  const Point second = place.length * place.axis((normal + 2) % 3);
  const auto at = [&](double a, double b) { return centre + a * first + b * second; };
  constexpr double kMiddle = (kPlaneStart + kPlaneEnd) / 2;
  return HandleShape{handle,
                     {at(kPlaneStart, kPlaneStart), at(kPlaneEnd, kPlaneStart),
                      at(kPlaneEnd, kPlaneEnd), at(kPlaneStart, kPlaneEnd)},
                     true,
                     at(kMiddle, kMiddle)};
}

HandleShape ringShape(Handle handle, const GizmoPlace& place, const Sight& sight) {
  const Point centre = wide(place.centre);
  const Point axis = place.axis(axisOf(handle));
  const Point towards_eye = unit(sight.eye() - centre);
  // From the hindmost point of the ring all around: what is seen of it is in one piece.
  Point front = towards_eye - dot(towards_eye, axis) * axis;
  if (length(front) < 1e-6) front = place.axis((axisOf(handle) + 1) % 3);
  front = unit(front);
  const Point side = cross(axis, front);
  HandleShape ring{.handle = handle, .grip = centre + place.length * front};
  for (int i = 0; i <= kRingPoints; ++i) {
    const double angle = (2.0 * i / kRingPoints - 1) * std::numbers::pi;
    const Point out = std::cos(angle) * front + std::sin(angle) * side;
    if (dot(out, towards_eye) >= -kRingBehind) ring.points.push_back(centre + place.length * out);
  }
  return ring;
}

}  // namespace

std::optional<Pixel> Sight::pixelOf(const Point& point) const {
  std::array<float, 3> seen;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    seen[axis] = static_cast<float>((point[axis] - space_.origin[axis]) / space_.side);
  }
  const auto at = project(viewpoint_.camera, seen);
  if (!at) return {};
  return Pixel{((*at)[0] + 1) / 2 * static_cast<float>(viewpoint_.width),
               (1 - (*at)[1]) / 2 * static_cast<float>(viewpoint_.height)};
}

Point Sight::eye() const {
  Point eye;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    eye[axis] = space_.origin[axis] + space_.side * double{viewpoint_.camera.eye[axis]};
  }
  return eye;
}

Sight::Line Sight::through(Pixel pixel) const {
  return {eye(), wide(broadmark::rayThrough(viewpoint_, pixel[0], pixel[1]).direction)};
}

double Sight::pixelAt(const Point& point) const {
  const double depth = -dot(point - eye(), wide(axesOf(viewpoint_.camera).back));
  return depth * double{pixelSize(viewpoint_.camera, viewpoint_.height)};
}

Point turnedAxis(const Quaternion& turn, std::size_t axis) {
  // A column of the quaternion's matrix.
  const double x = turn[0];
  const double y = turn[1];
  const double z = turn[2];
  const double w = turn[3];
  switch (axis) {
    case 0:
      return {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)};
    case 1:
      return {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)};
    default:
      return {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)};
  }
}

std::vector<HandleShape> handleShapes(Tool tool, const GizmoPlace& place, const Sight& sight) {
  std::vector<HandleShape> shapes;
  const auto add = [&](std::optional<HandleShape> shape) {
    if (shape) shapes.push_back(std::move(*shape));
  };
  for (const Handle handle : {Handle::x, Handle::y, Handle::z}) {
    if (tool == Tool::turn) {
      add(ringShape(handle, place, sight));
    } else {
      add(axisShape(handle, place, sight));
    }
  }
  if (tool == Tool::move) {
    for (const Handle handle : {Handle::yz, Handle::zx, Handle::xy}) {
      add(planeShape(handle, place, sight));
    }
  }
  const Point centre = wide(place.centre);
  if (tool == Tool::scale) add(HandleShape{Handle::all, {centre, centre}, false, centre});
  return shapes;
}

std::optional<Handle> handleUnder(const std::vector<HandleShape>& shapes, const Sight& sight,
                                  Pixel pixel, float reach) {
  std::optional<Handle> nearest;
  for (const HandleShape& shape : shapes) {
    std::vector<Pixel> seen;
    for (const Point& point : shape.points) {
      if (const auto at = sight.pixelOf(point)) seen.push_back(*at);
    }
    float distance = reach;
    for (std::size_t i = 1; i < seen.size(); ++i) {
      distance = std::min(distance, distanceTo(seen[i - 1], seen[i], pixel));
    }
    if (shape.filled && isInside(seen, pixel)) distance = 0;
    if (distance >= reach) continue;
    reach = distance;
    nearest = shape.handle;
  }
  return nearest;
}

GizmoDrag::GizmoDrag(Tool tool, Handle handle, const GizmoPlace& place, const Sight& sight,
                     Pixel from)
    : tool_(tool), handle_(handle), place_(place), sight_(sight), from_(from) {}

GizmoDrag::Outcome GizmoDrag::at(Pixel pixel, const Tools& tools, bool snaps) const {
  switch (tool_) {
    case Tool::turn:
      return turned(pixel, snaps ? tools.turn_step : 0);
    case Tool::scale:
      return scaled(pixel, snaps ? tools.scale_step : 0);
    default:
      return moved(pixel, snaps ? tools.move_step : 0);
  }
}

double GizmoDrag::along(std::size_t axis, Pixel pixel) const {
  const Sight::Line line = sight_.through(pixel);
  const Point direction = place_.axis(axis);
  const Point to_centre = wide(place_.centre) - line.from;
  const double cosine = dot(direction, line.direction);
  const double square = dot(line.direction, line.direction);
  const double denominator = square - cosine * cosine;
  if (denominator < 1e-12 * square) return 0;
  return (cosine * dot(line.direction, to_centre) - square * dot(direction, to_centre)) /
         denominator;
}

std::optional<Point> GizmoDrag::across(std::size_t axis, Pixel pixel) const {
  const Sight::Line line = sight_.through(pixel);
  const Point normal = place_.axis(axis);
  const Point to_centre = wide(place_.centre) - line.from;
  const double share = dot(normal, to_centre) / dot(normal, line.direction);
  if (!(share > 0) || !std::isfinite(share)) return {};  // beyond the horizon
  return share * line.direction - to_centre;
}

GizmoDrag::Outcome GizmoDrag::moved(Pixel pixel, double step) const {
  Point amounts{};  // along the gizmo's axes
  if (isPlane(handle_)) {
    const auto from = across(axisOf(handle_), from_);
    const auto to = across(axisOf(handle_), pixel);
    if (from && to) {
      for (const std::size_t other : {1, 2}) {
        const std::size_t axis = (axisOf(handle_) + other) % 3;
        amounts[axis] = roundedTo(dot(*to - *from, place_.axis(axis)), step);
      }
    }
  } else {
    const std::size_t axis = axisOf(handle_);
    amounts[axis] = roundedTo(along(axis, pixel) - along(axis, from_), step);
  }
  Outcome outcome;
  Point way{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    way = way + amounts[axis] * place_.axis(axis);
    const bool drags = isPlane(handle_) != (axis == axisOf(handle_));
    if (!drags) continue;
    outcome.text +=
        fmt::format("{}{} {:.4g}", outcome.text.empty() ? "" : "  ", "xyz"[axis], amounts[axis]);
  }
  outcome.change.move = narrow(way);
  return outcome;
}

GizmoDrag::Outcome GizmoDrag::turned(Pixel pixel, double step) const {
  const Point centre = wide(place_.centre);
  const Point axis = place_.axis(axisOf(handle_));
  // Of the ring's points the one that was taken.
  const HandleShape ring = ringShape(handle_, place_, sight_);
  Point taken = ring.grip;
  float nearest = std::numeric_limits<float>::max();
  for (const Point& point : ring.points) {
    const auto seen = sight_.pixelOf(point);
    if (!seen) continue;
    const float distance = std::hypot((*seen)[0] - from_[0], (*seen)[1] - from_[1]);
    if (distance >= nearest) continue;
    nearest = distance;
    taken = point;
  }
  constexpr double kSmall = 0.05;  // radians
  const auto here = sight_.pixelOf(taken);
  const auto there = sight_.pixelOf(taken + kSmall * cross(axis, taken - centre));
  double degrees = 0;
  if (here && there) {
    const double x = ((*there)[0] - (*here)[0]) / kSmall;  // pixels for a radian
    const double y = ((*there)[1] - (*here)[1]) / kSmall;
    const double way = (pixel[0] - from_[0]) * x + (pixel[1] - from_[1]) * y;
    // At the end of a ring seen from its edge the tangent leads away from the eye.
    const double least = kFlattest * place_.length / sight_.pixelAt(centre);
    degrees = way / std::max(x * x + y * y, least * least) * 180 / std::numbers::pi;
  }
  degrees = roundedTo(degrees, step);
  const double half = degrees * std::numbers::pi / 360;
  Outcome outcome{.text = fmt::format("{} {:.4g}°", "xyz"[axisOf(handle_)], degrees)};
  outcome.change.centre = place_.centre;
  for (std::size_t i = 0; i < 3; ++i) {
    outcome.change.turn[i] = static_cast<float>(std::sin(half) * axis[i]);
  }
  outcome.change.turn[3] = static_cast<float>(std::cos(half));
  return outcome;
}

GizmoDrag::Outcome GizmoDrag::scaled(Pixel pixel, double step) const {
  double factor = 1;
  if (handle_ == Handle::all) {
    const double pixels = place_.length / sight_.pixelAt(wide(place_.centre));
    factor += ((pixel[0] - from_[0]) - (pixel[1] - from_[1])) / pixels;
  } else {
    factor = along(axisOf(handle_), pixel) / along(axisOf(handle_), from_);
  }
  factor =
      std::max(roundedTo(std::isfinite(factor) ? factor : 1, step), step > 0 ? step : kLeastFactor);
  Outcome outcome;
  outcome.change = {.centre = place_.centre, .axes = place_.turn};
  const std::string axes = handle_ == Handle::all ? "xyz" : std::string(1, "xyz"[axisOf(handle_)]);
  for (const char axis : axes) {
    outcome.change.scale[static_cast<std::size_t>(axis - 'x')] = static_cast<float>(factor);
  }
  outcome.text = fmt::format("{} × {:.4g}", axes, factor);
  return outcome;
}

}  // namespace broadmark
