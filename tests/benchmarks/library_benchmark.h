// What benchmarks of the broad-phase library share: arguments, motion, queries, and times.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <utility>
#include <vector>

#include "benchmarks/stopwatch.h"
#include "broadmark/aabb.h"
#include "broadmark/broadphase.hpp"
#include "torture/inputs.h"

namespace broadmark::benchmarks {

namespace bp = broadmark::broadphase;

/// NAME [ROUNDS [BODIES...]]
struct LibraryArguments {
  int rounds;
  std::vector<std::size_t> sizes;

  LibraryArguments(int argc, char** argv, int min_rounds, std::vector<std::size_t> default_sizes)
      : rounds(argc > 1 ? std::max(min_rounds, std::atoi(argv[1])) : 101) {
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    for (int i = 2; i < argc; ++i) sizes.push_back(static_cast<std::size_t>(std::atoi(argv[i])));
    if (sizes.empty()) sizes = std::move(default_sizes);
  }
};

/// The boxes, for the library to read where they lie.
inline bp::Boxes viewOf(const std::vector<Aabb>& boxes) {
  return {boxes[0].min.data(), boxes[0].max.data(), boxes.size(), sizeof(Aabb)};
}

inline Aabb aabbOf(const bp::Box& box) {
  return {{box.min[0], box.min[1], box.min[2], 0}, {box.max[0], box.max[1], box.max[2], 0}};
}

inline void translate(Aabb& box, const inputs::Vec3& by) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.min[axis] += by[axis];
    box.max[axis] += by[axis];
  }
}

/// Moves a share of the boxes, chosen at random, by up to 0.1 on each axis.
inline void moveShare(std::vector<Aabb>& boxes, double share, inputs::Random& random) {
  const std::size_t bodies = boxes.size();
  const auto movers = static_cast<std::size_t>(share * static_cast<double>(bodies));
  for (std::size_t i = 0; i < movers; ++i) {
    Aabb& box =
        boxes[movers == bodies
                  ? i
                  : static_cast<std::size_t>(random.integer(0, static_cast<int>(bodies) - 1))];
    inputs::Vec3 step;
    for (float& x : step) x = random.uniform(-0.1F, 0.1F);
    translate(box, step);
  }
}

/// Queries that are answered together.
struct Batch {
  std::vector<bp::BoxQuery> boxes;
  std::vector<bp::Cast> rays;
  std::vector<bp::NearestQuery> points;
};

/// For `bodies` unit cubes as in inputs::uniform(): boxes of eight times a body's volume, rays
/// across the world, the eight nearest bodies.
inline Batch batchIn(std::size_t bodies, std::size_t count, std::uint64_t seed) {
  const float side = inputs::cubeRoot(10.0 * static_cast<double>(bodies));
  inputs::Random random(seed, 0);
  Batch batch;
  for (std::size_t i = 0; i < count; ++i) {
    const inputs::Vec3 from = random.inCube(side);
    const inputs::Vec3 to = random.inCube(side);
    bp::BoxQuery box;
    bp::Cast ray;
    bp::NearestQuery point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.box.min[axis] = from[axis];
      box.box.max[axis] = from[axis] + 2;
      ray.box.min[axis] = ray.box.max[axis] = point.point[axis] = from[axis];
      ray.direction[axis] = to[axis] - from[axis];
    }
    point.count = 8;
    batch.boxes.push_back(box);
    batch.rays.push_back(ray);
    batch.points.push_back(point);
  }
  return batch;
}

/// Where a ray enters a box, as a fraction of `direction`: `near` if it starts inside, infinity if
/// it misses the box up to `far`. For libraries that leave the last test to their caller.
inline float entryOf(const Aabb& box, const float* from, const float* direction, float near,
                     float far) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float a = (box.min[axis] - from[axis]) / direction[axis];
    const float b = (box.max[axis] - from[axis]) / direction[axis];
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  return near <= far ? near : std::numeric_limits<float>::infinity();
}

}  // namespace broadmark::benchmarks
