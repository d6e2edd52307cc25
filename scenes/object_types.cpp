// The object types: shapes for the bodies of a scene.

#include <array>

#include "broadmark/scenes/registry.h"

namespace broadmark::scenes {
namespace {

Shape cube(std::size_t, double scale, Random&) {
  const auto half = static_cast<float>(scale / 2);
  return BoxShape{{half, half, half}};
}

Shape ball(std::size_t, double scale, Random&) {
  return SphereShape{static_cast<float>(scale / 2)};
}

using Edges = std::array<double, 3>;

/// Assorted boxes have very different sizes and proportions, as in the original Broadmark. Of every
/// 80 bodies the first 19 are these; the others have random edges.
constexpr std::size_t kPeriod = 80;

/// The first bodies of every period: from the end of the row above to `end`, exclusive.
constexpr struct {
  std::size_t end;
  Edges edges;
} kFixed[] = {
    {4, {0.5, 0.5, 0.5}},   {8, {1.9, 1.9, 1.9}},                            // cubes
    {11, {15.2, 0.4, 0.4}}, {12, {0.4, 15.2, 0.4}}, {13, {0.4, 0.4, 15.2}},  // bars
    {14, {1.9, 5.7, 0.1}},  {15, {1.9, 0.1, 5.7}},  {16, {0.1, 1.9, 0.3}},   // planks
    {17, {3.8, 3.8, 0.1}},  {18, {3.8, 0.1, 3.8}},  {19, {0.1, 3.8, 3.8}},   // plates
};

Edges edgesOf(std::size_t position, Random& random) {
  for (const auto& row : kFixed) {
    if (position < row.end) return row.edges;
  }
  Edges edges;
  for (double& edge : edges) edge = 0.803 * (0.1 + 1.8 * random.uniform());
  return edges;
}

Shape assortedBox(std::size_t index, double scale, Random& random) {
  const Edges edges = edgesOf(index % kPeriod, random);
  BoxShape box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.half_extents[axis] = static_cast<float>(scale * edges[axis] / 2);
  }
  return box;
}

}  // namespace

std::vector<ObjectType> objectTypes() {
  return {{{"cubes", "Cubes"}, cube},
          {{"spheres", "Spheres"}, ball},
          {{"assorted", "Assorted"}, assortedBox}};
}

}  // namespace broadmark::scenes
