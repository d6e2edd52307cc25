// Helpers of the scene tests: running a scene, and measuring its frames.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "broadmark/scenes/simulation.h"

namespace broadmark::tests {

using Boxes = std::vector<Aabb>;
using Frames = std::vector<Boxes>;
using Point = std::array<double, 3>;

/// A built-in scene with these parameters; engine "": the default.
inline std::unique_ptr<Simulation> sceneWith(const std::string& scene,
                                             const ParameterValues& values,
                                             const std::string& engine = {}) {
  auto simulation = makeSimulation(scene, engine);
  setParameters(*simulation, values);
  return simulation;
}

inline Boxes boxesOf(const Frame& frame) { return {frame.boxes.begin(), frame.boxes.end()}; }

/// All frames of a source, the initial pose first.
inline Frames allFrames(FrameSource& source) {
  Frames frames = {boxesOf(source.rewind())};
  while (const auto frame = source.next()) {
    EXPECT_EQ(frame->index, frames.size());
    frames.push_back(boxesOf(*frame));
  }
  return frames;
}

inline Point centreOf(const Aabb& box) {
  return {(double{box.min[0]} + box.max[0]) / 2, (double{box.min[1]} + box.max[1]) / 2,
          (double{box.min[2]} + box.max[2]) / 2};
}

inline double meanHeight(std::span<const Aabb> boxes) {
  double sum = 0;
  for (const Aabb& box : boxes) sum += centreOf(box)[1];
  return sum / static_cast<double>(boxes.size());
}

inline Point minus(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline double lengthOf(const Point& v) { return std::hypot(v[0], v[1], v[2]); }

inline double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The displacement of a body's centre between two frames.
inline Point way(const Aabb& from, const Aabb& to) { return minus(centreOf(to), centreOf(from)); }

inline double longestEdgeOf(const Aabb& box) {
  return std::max({box.max[0] - box.min[0], box.max[1] - box.min[1], box.max[2] - box.min[2]});
}

/// The maximum extent of a box beyond the world; negative: all boxes are inside.
inline double reachOutside(std::span<const Aabb> boxes, const Aabb& world) {
  double farthest = -1e9;
  for (const Aabb& box : boxes) {
    for (int axis = 0; axis < 3; ++axis) {
      farthest = std::max({farthest, double{world.min[axis]} - box.min[axis],
                           double{box.max[axis]} - world.max[axis]});
    }
  }
  return farthest;
}

/// Whether no box extends beyond the world by more than `slack`.
inline bool allInside(std::span<const Aabb> boxes, const Aabb& world, double slack) {
  return reachOutside(boxes, world) <= slack;
}

inline std::size_t pairsAmong(const Boxes& boxes) {
  std::size_t pairs = 0;
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) pairs += overlaps(boxes[a], boxes[b]) ? 1 : 0;
  }
  return pairs;
}

}  // namespace broadmark::tests
