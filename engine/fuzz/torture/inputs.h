// Boxes to test algorithms on: each input is a name and a function of size, frame and seed.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <string_view>
#include <vector>

#include "broadmark/aabb.h"

namespace broadmark::inputs {

/// `n` boxes of frame `frame` (0 = initial pose); the same arguments give the same boxes.
using Generator = std::vector<Aabb> (*)(std::size_t n, std::uint32_t frame, std::uint64_t seed);

struct Input {
  std::string_view name;
  Generator boxes;
  bool all_overlap = false;  ///< each box every other one
};

using Vec3 = std::array<float, 3>;

/// Random numbers of one frame.
class Random {
 public:
  Random(std::uint64_t seed, std::uint32_t frame) : bits_(seed * 1'000'003 + frame) {}

  float uniform(float low, float high) {
    return low + (high - low) * static_cast<float>(static_cast<double>(bits_() >> 11) * 0x1p-53);
  }
  int integer(int low, int high) {  // both inclusive
    return low + static_cast<int>(bits_() % static_cast<std::uint64_t>(high - low + 1));
  }
  /// Whether something happens that does so once in `times`.
  bool onceIn(int times) { return integer(1, times) == 1; }
  template <class List>
  const auto& anyOf(const List& list) {
    return list[static_cast<std::size_t>(integer(0, static_cast<int>(list.size()) - 1))];
  }
  Vec3 inCube(float side) { return {uniform(0, side), uniform(0, side), uniform(0, side)}; }

 private:
  std::mt19937_64 bits_;
};

inline Aabb boxAt(const Vec3& corner, const Vec3& edges) {
  return {{corner[0], corner[1], corner[2], 0},
          {corner[0] + edges[0], corner[1] + edges[1], corner[2] + edges[2], 0}};
}

inline float cubeRoot(double volume) { return static_cast<float>(std::cbrt(volume)); }

/// n boxes, each made by make(random, i).
template <class Make>
std::vector<Aabb> generate(std::size_t n, std::uint32_t frame, std::uint64_t seed, Make make) {
  Random random(seed, frame);
  std::vector<Aabb> boxes;
  boxes.reserve(n);
  for (std::size_t i = 0; i < n; ++i) boxes.push_back(make(random, i));
  return boxes;
}

/// Unit cubes with centres uniform in a cube of volume 10 n.
inline std::vector<Aabb> uniform(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  const float side = cubeRoot(10.0 * static_cast<double>(n));
  return generate(n, frame, seed, [&](Random& random, std::size_t) {
    return boxAt(random.inCube(side), {1, 1, 1});
  });
}

/// Boxes of many shapes, every 50th a large one.
inline std::vector<Aabb> assorted(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  const float side = cubeRoot(10.0 * static_cast<double>(n));
  return generate(n, frame, seed, [&](Random& random, std::size_t i) {
    const float scale = i % 50 == 7 ? 5 : 1;
    // One after the other: compilers differ in the order of a call's arguments.
    Vec3 edges;
    for (float& edge : edges) edge = random.uniform(0.1F, 1.9F) * scale;
    return boxAt(random.inCube(side), edges);
  });
}

/// Unit cubes on integer corners: most pairs that meet touch in a face, an edge or a corner.
inline std::vector<Aabb> touching(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  const int side = static_cast<int>(cubeRoot(4.0 * static_cast<double>(n))) + 1;
  return generate(n, frame, seed, [&](Random& random, std::size_t) {
    // Around the origin, so that bounds of -0 meet bounds of +0.
    Vec3 corner;
    for (float& x : corner) x = static_cast<float>(random.integer(-side / 2, side / 2));
    Aabb box = boxAt(corner, {1, 1, 1});
    for (int axis = 0; axis < 3; ++axis) {
      if (box.max[axis] == 0 && random.integer(0, 1) == 0) box.max[axis] = -0.0F;
      if (box.min[axis] == 0 && random.integer(0, 1) == 0) box.min[axis] = -0.0F;
    }
    return box;
  });
}

inline std::vector<Aabb> identical(std::size_t n, std::uint32_t frame, std::uint64_t) {
  const auto offset = static_cast<float>(frame);
  return std::vector<Aabb>(n, boxAt({offset, 2, -3}, {1, 2, 3}));
}

/// Boxes without thickness, perpendicular to one axis or another.
inline std::vector<Aabb> flat(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  const float side = cubeRoot(2.0 * static_cast<double>(n));
  return generate(n, frame, seed, [&](Random& random, std::size_t i) {
    Vec3 edges = {2, 2, 2};
    edges[i % 3] = 0;
    return boxAt(random.inCube(side), edges);
  });
}

/// Points, several in the same place.
inline std::vector<Aabb> zeroSize(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  const int side = static_cast<int>(cubeRoot(static_cast<double>(n)));
  return generate(n, frame, seed, [&](Random& random, std::size_t) {
    Vec3 corner;
    for (float& x : corner) x = static_cast<float>(random.integer(0, side));
    return boxAt(corner, {0, 0, 0});
  });
}

/// Each box inside of all larger ones, in random order.
inline std::vector<Aabb> nested(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  return generate(n, frame, seed, [&](Random& random, std::size_t) {
    const float half = random.uniform(0, 100);
    return boxAt({-half, -half, -half}, {2 * half, 2 * half, 2 * half});
  });
}

inline std::vector<Aabb> scaled(std::vector<Aabb> boxes, float factor) {
  for (Aabb& box : boxes) {
    for (int axis = 0; axis < 3; ++axis) {
      box.min[axis] *= factor;
      box.max[axis] *= factor;
    }
  }
  return boxes;
}

inline std::vector<Aabb> huge(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  return scaled(assorted(n, frame, seed), 1e30F);
}

/// Denormal coordinates.
inline std::vector<Aabb> tiny(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  return scaled(touching(n, frame, seed), std::numeric_limits<float>::denorm_min());
}

/// So far from the origin that coordinates are whole numbers.
inline std::vector<Aabb> farAway(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  std::vector<Aabb> boxes = uniform(n, frame, seed);
  for (Aabb& box : boxes) {
    for (int axis = 0; axis < 3; ++axis) {
      box.min[axis] += 1e7F;
      box.max[axis] += 1e7F;
    }
  }
  return boxes;
}

/// Unit cubes in a ball of volume n: every box overlaps several others.
inline std::vector<Aabb> clustered(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  const float radius = cubeRoot(static_cast<double>(n) * 0.2387);
  return generate(n, frame, seed, [&](Random& random, std::size_t) {
    Vec3 corner;
    do {
      for (float& x : corner) x = random.uniform(-radius, radius);
    } while (std::hypot(corner[0], corner[1], corner[2]) > radius);
    return boxAt(corner, {1, 1, 1});
  });
}

/// Nothing moves.
inline std::vector<Aabb> still(std::size_t n, std::uint32_t, std::uint64_t seed) {
  return assorted(n, 0, seed);
}

/// Most boxes drift, one in twenty jumps.
inline std::vector<Aabb> drifting(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  std::vector<Aabb> boxes = assorted(n, 0, seed);
  const std::vector<Aabb> elsewhere = assorted(n, frame, seed);
  for (std::size_t i = 0; i < n; ++i) {
    if ((i + frame) % 20 == 0) boxes[i] = elsewhere[i];
    const float way = static_cast<float>(frame) * (i % 2 == 0 ? 0.05F : -0.02F);
    for (int axis = 0; axis < 3; ++axis) {
      boxes[i].min[axis] += way;
      boxes[i].max[axis] += way;
    }
  }
  return boxes;
}

/// All boxes leave for somewhere else every frame.
inline std::vector<Aabb> teleporting(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  std::vector<Aabb> boxes = clustered(n, frame, seed);
  const float away = 1000 * static_cast<float>(frame % 2);
  for (Aabb& box : boxes) {
    box.min[frame % 3] += away;
    box.max[frame % 3] += away;
  }
  return boxes;
}

/// From points to boxes that all overlap.
inline std::vector<Aabb> growing(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  std::vector<Aabb> boxes = uniform(n, 0, seed);
  for (Aabb& box : boxes) {
    const float edge = static_cast<float>(frame * frame);
    for (int axis = 0; axis < 3; ++axis) box.max[axis] = box.min[axis] + edge;
  }
  return boxes;
}

/// Half of the boxes here, half very far away.
inline std::vector<Aabb> twoClusters(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  std::vector<Aabb> boxes = clustered(n, frame, seed);
  for (std::size_t i = 0; i < n; i += 2) {
    boxes[i].min[1] += 1e5F;
    boxes[i].max[1] += 1e5F;
  }
  return boxes;
}

/// Unit squares on the plane z = 0: no variance at all on one axis.
inline std::vector<Aabb> onePlane(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  const float side = std::sqrt(4 * static_cast<float>(n));
  return generate(n, frame, seed, [&](Random& random, std::size_t) {
    Vec3 corner = random.inCube(side);
    corner[2] = 0;
    return boxAt(corner, {1, 1, 0});
  });
}

/// Clusters of rods and plates, each with a shape and an extent of its own on each axis, among unit
/// cubes: what is cut on some axes is cut again on others.
inline std::vector<Aabb> rodsAndPlates(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  constexpr std::array kExtents = {0.5F, 2.0F, 8.0F, 20.0F};
  constexpr std::array kEdges = {0.05F, 0.2F, 1.0F, 5.0F};
  constexpr std::size_t kCluster = 97;  // bodies
  const float side = cubeRoot(10.0 * static_cast<double>(n));
  const auto any = [](Random& random, const auto& of) {
    return of[static_cast<std::size_t>(random.integer(0, 3))];
  };
  Vec3 corner{};
  Vec3 extent{};
  Vec3 edges{};
  return generate(n, frame, seed, [&](Random& random, std::size_t i) {
    if (i % 4 == 0) return boxAt(random.inCube(side), {1, 1, 1});
    if (i % kCluster == 1) {
      corner = random.inCube(side);
      for (int axis = 0; axis < 3; ++axis) {
        extent[axis] = any(random, kExtents);
        edges[axis] = any(random, kEdges);
      }
    }
    Vec3 place = random.inCube(1);
    for (int axis = 0; axis < 3; ++axis) place[axis] = corner[axis] + place[axis] * extent[axis];
    return boxAt(place, edges);
  });
}

/// Bounds at the ends of the range of floats, beyond what any recording holds: sums and differences
/// of bounds overflow. For algorithms that only ever compare.
inline std::vector<Aabb> limits(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  constexpr float kMost = std::numeric_limits<float>::max();
  constexpr std::array kBounds = {-kMost, -kMost / 2, -1.0F, 0.0F, 1.0F, kMost / 2, kMost};
  return generate(n, frame, seed, [&](Random& random, std::size_t) {
    Aabb box;
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(random.integer(0, 6));
      const auto b = static_cast<std::size_t>(random.integer(0, 6));
      box.min[axis] = kBounds[std::min(a, b)];
      box.max[axis] = kBounds[std::max(a, b)];
    }
    return box;
  });
}

/// The usual, the easy and the awkward ones. `limits` is not among them: see there.
inline constexpr std::array kAll = {
    Input{"uniform", uniform},     Input{"assorted", assorted},
    Input{"touching", touching},   Input{"identical", identical, true},
    Input{"flat", flat},           Input{"zero size", zeroSize},
    Input{"nested", nested, true}, Input{"huge", huge},
    Input{"tiny", tiny},           Input{"far away", farAway},
    Input{"clustered", clustered}, Input{"still", still},
    Input{"drifting", drifting},   Input{"teleporting", teleporting},
    Input{"growing", growing},     Input{"two clusters", twoClusters},
    Input{"one plane", onePlane},  Input{"rods and plates", rodsAndPlates},
};

}  // namespace broadmark::inputs
