#include "inspector/views/glass.h"

#include <algorithm>

namespace broadmark {
namespace {

// In longest edges of a body in focus.
constexpr double kClearance = 0.75;     // around the line of sight to its centre
constexpr double kNeighbourhood = 0.4;  // around it
// As a fraction of its distance from the eye.
constexpr double kNearEye = 0.5;

Point centrePoint(const Aabb& box) {
  return {centreOf(box, 0), centreOf(box, 1), centreOf(box, 2)};
}

double distanceTo(const Aabb& box, const Point& point) {
  Point outside;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    outside[axis] = std::max({box.min[i] - point[axis], 0.0, point[axis] - box.max[i]});
  }
  return outside.norm();
}

/// Whether the segment between two points meets a box enlarged by `margin`.
bool meets(const Aabb& box, double margin, const Point& from, const Point& to) {
  double enter = 0;
  double leave = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const double low = box.min[i] - margin - from[axis];
    const double high = box.max[i] + margin - from[axis];
    const double step = to[axis] - from[axis];
    if (step == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    const auto [first, last] = std::minmax({low / step, high / step});
    enter = std::max(enter, first);
    leave = std::min(leave, last);
  }
  return enter <= leave;
}

}  // namespace

std::vector<std::uint8_t> glassBefore(std::span<const Aabb> boxes,
                                      std::span<const std::uint32_t> focus, const Point& eye) {
  std::vector<Aabb> targets;
  for (const std::uint32_t body : focus) {
    if (!isEmpty(boxes[body])) targets.push_back(boxes[body]);
  }
  if (targets.empty()) return {};
  if (targets.size() > 2) {
    Aabb& bounds = targets.front();
    for (const Aabb& box : targets) bounds = merged(bounds, box);
    targets.resize(1);
  }
  std::vector<std::uint8_t> glass(boxes.size(), 0);
  for (const Aabb& target : targets) {
    const Point centre = centrePoint(target);
    const double size = longestEdge(target);
    const Aabb around = enlarged(target, static_cast<float>(kNeighbourhood * size));
    const double near = kNearEye * distanceTo(target, eye);
    for (std::size_t body = 0; body < boxes.size(); ++body) {
      if (overlaps(boxes[body], around) || distanceTo(boxes[body], eye) < near ||
          meets(boxes[body], kClearance * size, eye, centre)) {
        glass[body] = 1;
      }
    }
  }
  for (const std::uint32_t body : focus) glass[body] = 0;
  return glass;
}

}  // namespace broadmark
