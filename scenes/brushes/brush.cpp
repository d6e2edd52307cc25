// Painting: brushes place bodies in unoccupied space.

#include "broadmark/scenes/brush.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "broadmark/error.h"
#include "broadmark/scenes/registry.h"
#include "broadmark/scenes/simulation.h"
#include "entries.h"

namespace broadmark::scenes {
namespace {

/// Overlap tolerated from brushes that place bodies side by side, as a fraction of a box's size:
/// rounding may make touching bodies overlap.
constexpr float kTouch = 1e-4F;
/// Positions tried per body by scattering brushes.
constexpr int kMaxAttempts = 100;

/// The box shrunk by a share of its size, and by rounding errors of its position.
Aabb shrunk(Aabb box, float share) {
  if (share == 0) return box;
  constexpr float kRounding = 4 * std::numeric_limits<float>::epsilon();
  for (int axis = 0; axis < 3; ++axis) {
    const float skin = share * (box.max[axis] - box.min[axis]) +
                       kRounding * std::max(std::abs(box.min[axis]), std::abs(box.max[axis]));
    box.min[axis] += skin;
    box.max[axis] -= skin;
  }
  return box;
}

/// The exponent of the smallest power of two above all edges.
int exponentOf(const Aabb& box) {
  int exponent = 0;
  std::frexp(longestEdge(box), &exponent);
  return exponent;
}

/// Cells per unit of length in a grid of that exponent.
double cellsPerUnit(int exponent) { return std::ldexp(1.0, -exponent - 1); }

std::int64_t cellAlong(double coordinate, double cells_per_unit) {
  return static_cast<std::int64_t>(std::floor(coordinate * cells_per_unit));
}

std::uint64_t cellAt(const std::array<std::int64_t, 3>& indices) {
  std::uint64_t hash = 0;
  for (const std::int64_t index : indices) {
    hash = (hash ^ static_cast<std::uint64_t>(index)) * 0x9E3779B97F4A7C15U;
    hash ^= hash >> 32;
  }
  return hash;
}

std::size_t checkedCount(double count) {
  const double whole = std::floor(count);
  if (whole >= 0 && whole <= static_cast<double>(kMaxBodies)) {
    return static_cast<std::size_t>(whole);
  }
  throw InputError(fmt::format("the brush would place {:.4g} bodies: a scene has at most {}", whole,
                               kMaxBodies));
}

}  // namespace

Paint::Paint() : object_type(choiceOf(objectTypes())) {}

void Paint::visitParameters(const ParameterVisitor& visit) {
  visit({"object_type", "shape of the bodies", &object_type});
  visit({"scale", "factor on the size of the bodies, in world units", &scale, 1e-3, 1e3});
  visit({"mass", "mass of a body", &mass, 1e-3, 1e6});
  visit({"frozen", "whether the bodies are immovable obstacles", &frozen});
  visit({"overlap", "whether the bodies may overlap each other and existing bodies", &overlap});
  visit({"seed", "seed of the random numbers", &seed, 0, 4'294'967'295});
}

OccupiedSpace::OccupiedSpace(std::span<const AuthoredBody> bodies) {
  for (const AuthoredBody& body : bodies) add(body);
}

void OccupiedSpace::add(const AuthoredBody& body) {
  const Aabb box = tightBox(body.shape, body.pose);
  const int exponent = exponentOf(box);
  const double scale = cellsPerUnit(exponent);
  const auto along = [&](int axis) { return cellAlong(box.min[axis], scale); };
  grids_[exponent][cellAt({along(0), along(1), along(2)})].push_back(box);
}

bool OccupiedSpace::overlaps(const AuthoredBody& body, float tolerance) const {
  const Aabb box = shrunk(tightBox(body.shape, body.pose), tolerance);
  return std::ranges::any_of(
      grids_, [&](const auto& grid) { return overlapsIn(grid.second, grid.first, box); });
}

bool OccupiedSpace::overlapsIn(const Grid& grid, int exponent, const Aabb& box) {
  const auto any_overlaps = [&](const std::vector<Aabb>& boxes) {
    return std::ranges::any_of(boxes, [&](const Aabb& b) { return broadmark::overlaps(b, box); });
  };
  const double scale = cellsPerUnit(exponent);
  std::array<std::int64_t, 3> low;
  std::array<std::int64_t, 3> high;
  double cells = 1;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = cellAlong(box.min[axis] - std::ldexp(1.0, exponent), scale);
    high[axis] = cellAlong(box.max[axis], scale);
    cells *= static_cast<double>(high[axis] - low[axis] + 1);
  }
  if (cells > static_cast<double>(grid.size())) {
    return std::ranges::any_of(grid, [&](const auto& cell) { return any_overlaps(cell.second); });
  }
  for (std::int64_t x = low[0]; x <= high[0]; ++x) {
    for (std::int64_t y = low[1]; y <= high[1]; ++y) {
      for (std::int64_t z = low[2]; z <= high[2]; ++z) {
        const auto cell = grid.find(cellAt({x, y, z}));
        if (cell != grid.end() && any_overlaps(cell->second)) return true;
      }
    }
  }
  return false;
}

Stroke paint(const Brush& brush, const Paint& paint, const Vec3& at, const OccupiedSpace& occupied,
             std::size_t max_bodies) {
  Random random(static_cast<std::uint64_t>(paint.seed));
  const ObjectType type = entryOf(objectTypes(), paint.object_type.value, "object type");
  const std::size_t count = checkedCount(brush.count(paint.scale * paint.scale * paint.scale));
  OccupiedSpace own;
  Stroke stroke;
  const float tolerance = brush.scatters() ? 0 : 2 * kTouch;
  const int attempts = brush.scatters() && !paint.overlap ? kMaxAttempts : 1;
  for (std::size_t i = 0; i < std::min(count, max_bodies); ++i) {
    AuthoredBody body;
    body.shape = type.shape(i, paint.scale, random);
    body.mass = paint.mass;
    body.frozen = paint.frozen;
    bool placed = false;
    for (int attempt = 0; attempt < attempts && !placed; ++attempt) {
      const Vec3 offset = brush.place(i, random);
      for (std::size_t axis = 0; axis < 3; ++axis)
        body.pose.position[axis] = at[axis] + offset[axis];
      if (!paint.overlap && (occupied.overlaps(body, tolerance) || own.overlaps(body, tolerance)))
        continue;
      placed = true;
      if (!paint.overlap) own.add(body);
      stroke.bodies.push_back(body);
    }
    stroke.left_out += placed ? 0 : 1;
  }
  return stroke;
}

Stroke paint(const Brush& brush, const Paint& paint, const Vec3& at,
             std::span<const AuthoredBody> present) {
  return scenes::paint(brush, paint, at,
                       OccupiedSpace(paint.overlap ? std::span<const AuthoredBody>() : present));
}

}  // namespace broadmark::scenes
