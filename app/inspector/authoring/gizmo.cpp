// Hit tests use distances on the screen. A body dragged along an axis or a plane stays under the
// mouse: at the point of the axis nearest to the mouse's ray, or where the ray hits the plane. A
// ring turns by the motion along its tangent at the grabbed point, which works from any side.

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
/// Axes and planes foreshortened to less than this share are left out.
constexpr double kMinForeshortening = 0.15;
/// Depth behind the centre to which a ring is shown, as a share of its radius. A ring that faces
/// the eye is shown as a whole.
constexpr double kRingBehind = 0.12;
constexpr int kRingPoints = 64;
constexpr double kMinFactor = 0.01;

Vec3 toVec3(const Point& p) {
  return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}

double roundedTo(double value, double step) {
  return step > 0 ? step * std::round(value / step) : value;
}

/// Returns the axis of an axis handle, or the normal of a plane handle.
std::size_t axisOf(Handle handle) { return static_cast<std::size_t>(handle) % 3; }
bool isPlane(Handle handle) { return handle >= Handle::yz && handle <= Handle::xy; }

/// Returns the distance of a pixel to the segment from a to b.
float segmentDistance(const Pixel& a, const Pixel& b, const Pixel& pixel) {
  const Pixel edge = b - a;
  const float square = edge.squaredNorm();
  const float share = square > 0 ? std::clamp((pixel - a).dot(edge) / square, 0.0F, 1.0F) : 0.0F;
  return (pixel - a - share * edge).norm();
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

std::optional<HandleShape> axisShape(Handle handle, const GizmoPose& pose,
                                     const ViewProjection& projection) {
  const Point centre = pointOf(pose.centre);
  const Point axis = pose.axis(axisOf(handle));
  if (axis.cross((projection.eye() - centre).normalized()).norm() < kMinForeshortening) return {};
  const auto at = [&](double share) -> Point { return centre + share * pose.length * axis; };
  return HandleShape{handle, {at(kAxisStart), at(1)}, false, at(kGripAt)};
}

std::optional<HandleShape> planeShape(Handle handle, const GizmoPose& pose,
                                      const ViewProjection& projection) {
  const Point centre = pointOf(pose.centre);
  const std::size_t normal = axisOf(handle);
  const Point to_eye = (projection.eye() - centre).normalized();
  if (std::abs(pose.axis(normal).dot(to_eye)) < kMinForeshortening) return {};
  const Point first = pose.length * pose.axis((normal + 1) % 3);
  const Point second = pose.length * pose.axis((normal + 2) % 3);
  const auto at = [&](double a, double b) -> Point { return centre + a * first + b * second; };
  constexpr double kMiddle = (kPlaneStart + kPlaneEnd) / 2;
  return HandleShape{handle,
                     {at(kPlaneStart, kPlaneStart), at(kPlaneEnd, kPlaneStart),
                      at(kPlaneEnd, kPlaneEnd), at(kPlaneStart, kPlaneEnd)},
                     true,
                     at(kMiddle, kMiddle)};
}

HandleShape ringShape(Handle handle, const GizmoPose& pose, const ViewProjection& projection) {
  const Point centre = pointOf(pose.centre);
  const Point axis = pose.axis(axisOf(handle));
  const Point towards_eye = (projection.eye() - centre).normalized();
  // Starts at the hindmost point of the ring, so that the visible part is contiguous.
  Point front = towards_eye - towards_eye.dot(axis) * axis;
  if (front.norm() < 1e-6) front = pose.axis((axisOf(handle) + 1) % 3);
  front.normalize();
  const Point side = axis.cross(front);
  HandleShape ring{.handle = handle, .grip = centre + pose.length * front};
  for (int i = 0; i <= kRingPoints; ++i) {
    const double angle = (2.0 * i / kRingPoints - 1) * std::numbers::pi;
    const Point out = std::cos(angle) * front + std::sin(angle) * side;
    if (out.dot(towards_eye) >= -kRingBehind) ring.points.push_back(centre + pose.length * out);
  }
  return ring;
}

}  // namespace

std::optional<Pixel> ViewProjection::pixelOf(const Point& point) const {
  const Vec3 in_view = toVec3((point - Point(space_.origin.data())) / space_.side);
  const auto at = project(viewpoint_.camera, in_view);
  if (!at) return {};
  return Pixel{((*at)[0] + 1) / 2 * static_cast<float>(viewpoint_.width),
               (1 - (*at)[1]) / 2 * static_cast<float>(viewpoint_.height)};
}

Point ViewProjection::eye() const {
  return Point(space_.origin.data()) + space_.side * pointOf(viewpoint_.camera.eye);
}

ViewProjection::Ray ViewProjection::rayThrough(Pixel pixel) const {
  return {eye(), pointOf(broadmark::rayThrough(viewpoint_, pixel[0], pixel[1]).direction)};
}

double ViewProjection::pixelSizeAt(const Point& point) const {
  const double depth = -(point - eye()).dot(pointOf(axesOf(viewpoint_.camera).back));
  return depth * double{pixelSize(viewpoint_.camera, viewpoint_.height)};
}

Eigen::Matrix3d rotationMatrix(const Quaternion& rotation) {
  return Eigen::Quaterniond(rotation[3], rotation[0], rotation[1], rotation[2]).toRotationMatrix();
}

std::vector<HandleShape> handleShapes(Tool tool, const GizmoPose& pose,
                                      const ViewProjection& projection) {
  std::vector<HandleShape> shapes;
  const auto add = [&](std::optional<HandleShape> shape) {
    if (shape) shapes.push_back(std::move(*shape));
  };
  for (const Handle handle : {Handle::x, Handle::y, Handle::z}) {
    if (tool == Tool::turn) {
      add(ringShape(handle, pose, projection));
    } else {
      add(axisShape(handle, pose, projection));
    }
  }
  if (tool == Tool::move) {
    for (const Handle handle : {Handle::yz, Handle::zx, Handle::xy}) {
      add(planeShape(handle, pose, projection));
    }
  }
  const Point centre = pointOf(pose.centre);
  if (tool == Tool::scale) add(HandleShape{Handle::all, {centre, centre}, false, centre});
  return shapes;
}

std::optional<Handle> handleUnder(const std::vector<HandleShape>& shapes,
                                  const ViewProjection& projection, Pixel pixel, float reach) {
  std::optional<Handle> nearest;
  for (const HandleShape& shape : shapes) {
    std::vector<Pixel> pixels;
    for (const Point& point : shape.points) {
      if (const auto at = projection.pixelOf(point)) pixels.push_back(*at);
    }
    float distance = reach;
    for (std::size_t i = 1; i < pixels.size(); ++i) {
      distance = std::min(distance, segmentDistance(pixels[i - 1], pixels[i], pixel));
    }
    if (shape.filled && isInside(pixels, pixel)) distance = 0;
    if (distance >= reach) continue;
    reach = distance;
    nearest = shape.handle;
  }
  return nearest;
}

GizmoDrag::GizmoDrag(Tool tool, Handle handle, const GizmoPose& pose,
                     const ViewProjection& projection, Pixel from)
    : tool_(tool), handle_(handle), pose_(pose), projection_(projection), from_(from) {}

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

double GizmoDrag::axisCoordinate(std::size_t axis, Pixel pixel) const {
  const ViewProjection::Ray ray = projection_.rayThrough(pixel);
  const Point direction = pose_.axis(axis);
  const Point to_centre = pointOf(pose_.centre) - ray.from;
  const double cosine = direction.dot(ray.direction);
  const double square = ray.direction.squaredNorm();
  const double denominator = square - cosine * cosine;
  if (denominator < 1e-12 * square) return 0;
  return (cosine * ray.direction.dot(to_centre) - square * direction.dot(to_centre)) / denominator;
}

std::optional<Point> GizmoDrag::planePoint(std::size_t axis, Pixel pixel) const {
  const ViewProjection::Ray ray = projection_.rayThrough(pixel);
  const Point normal = pose_.axis(axis);
  const Point to_centre = pointOf(pose_.centre) - ray.from;
  const double share = normal.dot(to_centre) / normal.dot(ray.direction);
  if (!(share > 0) || !std::isfinite(share)) return {};  // beyond the horizon
  return Point(share * ray.direction - to_centre);
}

GizmoDrag::Outcome GizmoDrag::moved(Pixel pixel, double step) const {
  Point amounts = Point::Zero();  // along the gizmo's axes
  if (isPlane(handle_)) {
    const auto from = planePoint(axisOf(handle_), from_);
    const auto to = planePoint(axisOf(handle_), pixel);
    if (from && to) {
      for (const std::size_t other : {1, 2}) {
        const std::size_t axis = (axisOf(handle_) + other) % 3;
        amounts[axis] = roundedTo((*to - *from).dot(pose_.axis(axis)), step);
      }
    }
  } else {
    const std::size_t axis = axisOf(handle_);
    amounts[axis] = roundedTo(axisCoordinate(axis, pixel) - axisCoordinate(axis, from_), step);
  }
  Outcome outcome;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool drags = isPlane(handle_) != (axis == axisOf(handle_));
    if (!drags) continue;
    outcome.text +=
        fmt::format("{}{} {:.4g}", outcome.text.empty() ? "" : "  ", "xyz"[axis], amounts[axis]);
  }
  outcome.change.move = toVec3(rotationMatrix(pose_.rotation) * amounts);
  return outcome;
}

GizmoDrag::Outcome GizmoDrag::turned(Pixel pixel, double step) const {
  const Point centre = pointOf(pose_.centre);
  const Point axis = pose_.axis(axisOf(handle_));
  // The point of the ring nearest to the press.
  const HandleShape ring = ringShape(handle_, pose_, projection_);
  Point grabbed = ring.grip;
  float nearest = std::numeric_limits<float>::max();
  for (const Point& point : ring.points) {
    const auto at = projection_.pixelOf(point);
    if (!at) continue;
    const float distance = (*at - from_).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    grabbed = point;
  }
  constexpr double kSmall = 0.05;  // radians
  const auto before = projection_.pixelOf(grabbed);
  const auto after = projection_.pixelOf(grabbed + kSmall * axis.cross(grabbed - centre));
  double degrees = 0;
  if (before && after) {
    const Eigen::Vector2d tangent = (*after - *before).cast<double>() / kSmall;  // pixels / radian
    const double motion = (pixel - from_).cast<double>().dot(tangent);
    // At the ends of a ring seen edge-on, the tangent points away from the eye.
    const double min_length = kMinForeshortening * pose_.length / projection_.pixelSizeAt(centre);
    const double square = std::max(tangent.squaredNorm(), min_length * min_length);
    degrees = motion / square * 180 / std::numbers::pi;
  }
  degrees = roundedTo(degrees, step);
  const double half = degrees * std::numbers::pi / 360;
  Outcome outcome{.text = fmt::format("{} {:.4g}°", "xyz"[axisOf(handle_)], degrees)};
  outcome.change.centre = pose_.centre;
  const auto& [x, y, z] = toVec3(std::sin(half) * axis);
  outcome.change.turn = {x, y, z, static_cast<float>(std::cos(half))};
  return outcome;
}

GizmoDrag::Outcome GizmoDrag::scaled(Pixel pixel, double step) const {
  double factor = 1;
  if (handle_ == Handle::all) {
    const double pixels = pose_.length / projection_.pixelSizeAt(pointOf(pose_.centre));
    factor += ((pixel[0] - from_[0]) - (pixel[1] - from_[1])) / pixels;
  } else {
    factor = axisCoordinate(axisOf(handle_), pixel) / axisCoordinate(axisOf(handle_), from_);
  }
  factor =
      std::max(roundedTo(std::isfinite(factor) ? factor : 1, step), step > 0 ? step : kMinFactor);
  Outcome outcome;
  outcome.change = {.centre = pose_.centre, .axes = pose_.rotation};
  const std::string axes = handle_ == Handle::all ? "xyz" : std::string(1, "xyz"[axisOf(handle_)]);
  for (const char axis : axes) {
    outcome.change.scale[static_cast<std::size_t>(axis - 'x')] = static_cast<float>(factor);
  }
  outcome.text = fmt::format("{} × {:.4g}", axes, factor);
  return outcome;
}

}  // namespace broadmark
