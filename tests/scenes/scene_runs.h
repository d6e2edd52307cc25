// What the tests of scenes share: running one, and a few questions about its frames.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "broadmark/scenes/simulation.h"

namespace broadmark::testing {

using Boxes = std::vector<Aabb>;
using Point = std::array<double, 3>;

/// A built-in scene with these parameters.
inline std::unique_ptr<Simulation> sceneWith(const std::string& scene,
                                             const ParameterValues& values) {
  auto simulation = makeSimulation(scene);
  setParameters(*simulation, values);
  return simulation;
}

/// All its frames, the initial pose first.
inline std::vector<Boxes> allFrames(Simulation& simulation) {
  const auto copy = [](const Frame& frame) {
    return Boxes(frame.boxes.begin(), frame.boxes.end());
  };
  std::vector<Boxes> frames = {copy(simulation.rewind())};
  while (const auto frame = simulation.next()) frames.push_back(copy(*frame));
  return frames;
}

inline Point centreOf(const Aabb& box) {
  return {(double{box.min[0]} + box.max[0]) / 2, (double{box.min[1]} + box.max[1]) / 2,
          (double{box.min[2]} + box.max[2]) / 2};
}

inline Point minus(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline double lengthOf(const Point& v) { return std::hypot(v[0], v[1], v[2]); }

inline double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The way of a body's centre from one frame to another.
inline Point way(const Aabb& from, const Aabb& to) { return minus(centreOf(to), centreOf(from)); }

inline double longestEdgeOf(const Aabb& box) {
  return std::max({box.max[0] - box.min[0], box.max[1] - box.min[1], box.max[2] - box.min[2]});
}

/// Whether every box is inside the world, but for `slack`.
inline bool allInside(const Boxes& boxes, const Aabb& world, double slack) {
  return std::ranges::all_of(boxes, [&](const Aabb& box) {
    for (int axis = 0; axis < 3; ++axis) {
      if (box.min[axis] < world.min[axis] - slack || box.max[axis] > world.max[axis] + slack) {
        return false;
      }
    }
    return true;
  });
}

inline std::size_t pairsAmong(const Boxes& boxes) {
  std::size_t pairs = 0;
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) pairs += overlaps(boxes[a], boxes[b]) ? 1 : 0;
  }
  return pairs;
}

}  // namespace broadmark::testing
