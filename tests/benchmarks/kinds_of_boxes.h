// Distributions of boxes that benchmarks select by name.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/names.h"
#include "torture/inputs.h"

namespace broadmark::benchmarks {
namespace kinds {

using namespace inputs;

inline float sideFor(std::size_t n) { return cubeRoot(10.0 * static_cast<double>(n)); }

/// Edges 0.1 to 1.9; every 200th box has an edge of 5 to 15.
inline std::vector<Aabb> sizes(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  return generate(n, frame, seed, [side = sideFor(n)](Random& random, std::size_t i) {
    Vec3 edges;
    for (float& edge : edges) edge = random.uniform(0.1F, 1.9F);
    if (i % 200 == 7) edges[i / 200 % 3] = random.uniform(5, 15);
    return boxAt(random.inCube(side), edges);
  });
}

/// Unit cubes, ten boxes with half the world's side, and a box that encloses all.
inline std::vector<Aabb> giants(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  return generate(n, frame, seed, [side = sideFor(n), n](Random& random, std::size_t i) {
    if (i == 0) return boxAt({-1, -1, -1}, {side + 3, side + 3, side + 3});
    const float edge = i % (n / 10 + 1) == 5 ? side / 2 : 1;
    return boxAt(random.inCube(side - edge), {edge, edge, edge});
  });
}

/// Edges with a power-law distribution, up to the world's side.
inline std::vector<Aabb> powerLaw(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  return generate(n, frame, seed, [side = sideFor(n)](Random& random, std::size_t) {
    const float edge = std::min(side, 0.3F / std::sqrt(random.uniform(1e-6F, 1)));
    return boxAt(random.inCube(side), {edge, edge, edge});
  });
}

/// A hundred dense clusters in an empty world.
inline std::vector<Aabb> clusters(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  const float spread = cubeRoot(static_cast<double>(n) / 200);
  return generate(n, frame, seed, [=, side = 6 * sideFor(n)](Random& random, std::size_t i) {
    Random cluster_random(i % 100, frame);
    const Vec3 centre = cluster_random.inCube(side);
    Vec3 corner = random.inCube(spread);
    for (std::size_t axis = 0; axis < 3; ++axis) corner[axis] += centre[axis];
    return boxAt(corner, {1, 1, 1});
  });
}

inline std::vector<Aabb> line(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  return generate(n, frame, seed, [n](Random& random, std::size_t) {
    return boxAt({random.uniform(0, 2 * static_cast<float>(n)), 0, 0}, {1, 1, 1});
  });
}

/// All boxes overlap.
inline std::vector<Aabb> spot(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  return generate(n, frame, seed, [](Random& random, std::size_t) {
    return boxAt(random.inCube(0.5F), {1, 1, 1});
  });
}

}  // namespace kinds

inline constexpr std::array kKinds = {
    inputs::Input{"uniform", kinds::uniform},    inputs::Input{"clustered", kinds::clustered},
    inputs::Input{"clusters", kinds::clusters},  inputs::Input{"assorted", kinds::sizes},
    inputs::Input{"power law", kinds::powerLaw}, inputs::Input{"giants", kinds::giants},
    inputs::Input{"plane", kinds::onePlane},     inputs::Input{"line", kinds::line},
    inputs::Input{"spot", kinds::spot}};

/// Throws std::invalid_argument.
inline const inputs::Input& kindOf(std::string_view name) {
  const auto found = std::ranges::find(kKinds, name, &inputs::Input::name);
  if (found != kKinds.end()) return *found;
  std::vector<std::string> names;
  for (const inputs::Input& kind : kKinds) names.emplace_back(kind.name);
  throw std::invalid_argument(unknownName("kind of boxes", name, names));
}

}  // namespace broadmark::benchmarks
