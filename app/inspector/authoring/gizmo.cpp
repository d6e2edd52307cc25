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
constexpr double kMinFactor = 0.01;

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
float distanceTo(const Pixel& a, const Pixel& b, const Pixel& pixel) {
  const Pixel way = b - a;
  const float square = way.squaredNorm();
  const float share = square > 0 ? std::clamp((pixel - a).dot(way) / square, 0.0F, 1.0F) : 0.0F;
  return (pixel - a - share * way).norm();
}

bool isInside(const std::vector<Pixel>& corners, Pixel pixel) {
  bool inside = false;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const Pixel a = corners[i] - pixel;
    const Pixel b = corners[j] - pixel;
    if ((a[1] > 0) != (b[1] > 0) && (b[0] - a[0]) * a[1] / (b[1] - a[1]) < a[0]) inside = !inside;
  }
  return inside;
}

std::optional<HandleShape> axisShape(Handle handle, const GizmoPlace& place,
                                     const ViewProjection& sight) {
  const Point centre = pointOf(place.centre);
  const Point axis = place.axis(axisOf(handle));
  if (axis.cross((sight.eye() - centre).normalized()).norm() < kFlattest) return {};
  const auto at = [&](double share) -> Point { return centre + share * place.length * axis; };
  return HandleShape{handle, {at(kAxisStart), at(1)}, false, at(kGripAt)};
}

std::optional<HandleShape> planeShape(Handle handle, const GizmoPlace& place,
                                      const ViewProjection& sight) {
  const Point centre = pointOf(place.centre);
  const std::size_t normal = axisOf(handle);
  if (std::abs(place.axis(normal).dot((sight.eye() - centre).normalized())) < kFlattest) return {};
  const Point first = place.length * place.axis((normal + 1) % 3);
  const Point second = place.length * place.axis((normal + 2) % 3);
  const auto at = [&](double a, double b) -> Point { return centre + a * first + b * second; };
  constexpr double kMiddle = (kPlaneStart + kPlaneEnd) / 2;
  return HandleShape{handle,
                     {at(kPlaneStart, kPlaneStart), at(kPlaneEnd, kPlaneStart),
                      at(kPlaneEnd, kPlaneEnd), at(kPlaneStart, kPlaneEnd)},
                     true,
                     at(kMiddle, kMiddle)};
}

HandleShape ringShape(Handle handle, const GizmoPlace& place, const ViewProjection& sight) {
  const Point centre = pointOf(place.centre);
  const Point axis = place.axis(axisOf(handle));
  const Point towards_eye = (sight.eye() - centre).normalized();
  // From the hindmost point of the ring all around: what is seen of it is in one piece.
  Point front = towards_eye - towards_eye.dot(axis) * axis;
  if (front.norm() < 1e-6) front = place.axis((axisOf(handle) + 1) % 3);
  front.normalize();
  const Point side = axis.cross(front);
  HandleShape ring{.handle = handle, .grip = centre + place.length * front};
  for (int i = 0; i <= kRingPoints; ++i) {
    const double angle = (2.0 * i / kRingPoints - 1) * std::numbers::pi;
    const Point out = std::cos(angle) * front + std::sin(angle) * side;
    if (out.dot(towards_eye) >= -kRingBehind) ring.points.push_back(centre + place.length * out);
  }
  return ring;
}

}  // namespace

std::optional<Pixel> ViewProjection::pixelOf(const Point& point) const {
  const Vec3 seen = narrow((point - Point(space_.origin.data())) / space_.side);
  const auto at = project(viewpoint_.camera, seen);
  if (!at) return {};
  return Pixel{((*at)[0] + 1) / 2 * static_cast<float>(viewpoint_.width),
               (1 - (*at)[1]) / 2 * static_cast<float>(viewpoint_.height)};
}

Point ViewProjection::eye() const {
  return Point(space_.origin.data()) + space_.side * pointOf(viewpoint_.camera.eye);
}

ViewProjection::Ray ViewProjection::through(Pixel pixel) const {
  return {eye(), pointOf(broadmark::rayThrough(viewpoint_, pixel[0], pixel[1]).direction)};
}

double ViewProjection::pixelAt(const Point& point) const {
  const double depth = -(point - eye()).dot(pointOf(axesOf(viewpoint_.camera).back));
  return depth * double{pixelSize(viewpoint_.camera, viewpoint_.height)};
}

Eigen::Matrix3d turnOf(const Quaternion& turn) {
  return Eigen::Quaterniond(turn[3], turn[0], turn[1], turn[2]).toRotationMatrix();
}

std::vector<HandleShape> handleShapes(Tool tool, const GizmoPlace& place,
                                      const ViewProjection& sight) {
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
  const Point centre = pointOf(place.centre);
  if (tool == Tool::scale) add(HandleShape{Handle::all, {centre, centre}, false, centre});
  return shapes;
}

std::optional<Handle> handleUnder(const std::vector<HandleShape>& shapes,
                                  const ViewProjection& sight, Pixel pixel, float reach) {
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

GizmoDrag::GizmoDrag(Tool tool, Handle handle, const GizmoPlace& place, const ViewProjection& sight,
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
  const ViewProjection::Ray line = sight_.through(pixel);
  const Point direction = place_.axis(axis);
  const Point to_centre = pointOf(place_.centre) - line.from;
  const double cosine = direction.dot(line.direction);
  const double square = line.direction.squaredNorm();
  const double denominator = square - cosine * cosine;
  if (denominator < 1e-12 * square) return 0;
  return (cosine * line.direction.dot(to_centre) - square * direction.dot(to_centre)) / denominator;
}

std::optional<Point> GizmoDrag::across(std::size_t axis, Pixel pixel) const {
  const ViewProjection::Ray line = sight_.through(pixel);
  const Point normal = place_.axis(axis);
  const Point to_centre = pointOf(place_.centre) - line.from;
  const double share = normal.dot(to_centre) / normal.dot(line.direction);
  if (!(share > 0) || !std::isfinite(share)) return {};  // beyond the horizon
  return Point(share * line.direction - to_centre);
}

GizmoDrag::Outcome GizmoDrag::moved(Pixel pixel, double step) const {
  Point amounts = Point::Zero();  // along the gizmo's axes
  if (isPlane(handle_)) {
    const auto from = across(axisOf(handle_), from_);
    const auto to = across(axisOf(handle_), pixel);
    if (from && to) {
      for (const std::size_t other : {1, 2}) {
        const std::size_t axis = (axisOf(handle_) + other) % 3;
        amounts[axis] = roundedTo((*to - *from).dot(place_.axis(axis)), step);
      }
    }
  } else {
    const std::size_t axis = axisOf(handle_);
    amounts[axis] = roundedTo(along(axis, pixel) - along(axis, from_), step);
  }
  Outcome outcome;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool drags = isPlane(handle_) != (axis == axisOf(handle_));
    if (!drags) continue;
    outcome.text +=
        fmt::format("{}{} {:.4g}", outcome.text.empty() ? "" : "  ", "xyz"[axis], amounts[axis]);
  }
  outcome.change.move = narrow(turnOf(place_.turn) * amounts);
  return outcome;
}

GizmoDrag::Outcome GizmoDrag::turned(Pixel pixel, double step) const {
  const Point centre = pointOf(place_.centre);
  const Point axis = place_.axis(axisOf(handle_));
  // Of the ring's points the one that was taken.
  const HandleShape ring = ringShape(handle_, place_, sight_);
  Point taken = ring.grip;
  float nearest = std::numeric_limits<float>::max();
  for (const Point& point : ring.points) {
    const auto seen = sight_.pixelOf(point);
    if (!seen) continue;
    const float distance = (*seen - from_).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    taken = point;
  }
  constexpr double kSmall = 0.05;  // radians
  const auto here = sight_.pixelOf(taken);
  const auto there = sight_.pixelOf(taken + kSmall * axis.cross(taken - centre));
  double degrees = 0;
  if (here && there) {
    const Eigen::Vector2d on = (*there - *here).cast<double>() / kSmall;  // pixels for a radian
    const double way = (pixel - from_).cast<double>().dot(on);
    // At the end of a ring seen from its edge the tangent leads away from the eye.
    const double least = kFlattest * place_.length / sight_.pixelAt(centre);
    degrees = way / std::max(on.squaredNorm(), least * least) * 180 / std::numbers::pi;
  }
  degrees = roundedTo(degrees, step);
  const double half = degrees * std::numbers::pi / 360;
  Outcome outcome{.text = fmt::format("{} {:.4g}°", "xyz"[axisOf(handle_)], degrees)};
  outcome.change.centre = place_.centre;
  const auto& [x, y, z] = narrow(std::sin(half) * axis);
  outcome.change.turn = {x, y, z, static_cast<float>(std::cos(half))};
  return outcome;
}

GizmoDrag::Outcome GizmoDrag::scaled(Pixel pixel, double step) const {
  double factor = 1;
  if (handle_ == Handle::all) {
    const double pixels = place_.length / sight_.pixelAt(pointOf(place_.centre));
    factor += ((pixel[0] - from_[0]) - (pixel[1] - from_[1])) / pixels;
  } else {
    factor = along(axisOf(handle_), pixel) / along(axisOf(handle_), from_);
  }
  factor =
      std::max(roundedTo(std::isfinite(factor) ? factor : 1, step), step > 0 ? step : kMinFactor);
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
