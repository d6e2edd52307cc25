// Room is looked up in one hash grid for each power of two of box sizes, so that neither a floor
// under thousands of small bodies nor dust among large ones makes a cell crowded: O(1) per body
// unless sizes differ by orders of magnitude, with a plain walk over all boxes as the limit.

#include "broadmark/scenes/brush.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/scenes/registry.h"

namespace broadmark::scenes {

#define BRUSH(name)   \
  namespace name {    \
  BrushEntry entry(); \
  }
#include "brush_list.inc"
#undef BRUSH

std::vector<BrushEntry> brushEntries() {
  return {
#define BRUSH(name) name::entry(),
#include "brush_list.inc"
#undef BRUSH
  };
}

namespace {

/// Share of its size that a box may lie inside another: rounding, where bodies are to touch.
constexpr float kTouch = 1e-4F;
/// How often a brush that scatters looks for room for a body.
constexpr int kTries = 100;

/// The box without a thin skin.
Aabb core(Aabb box) {
  for (int axis = 0; axis < 3; ++axis) {
    const float skin = kTouch * (box.max[axis] - box.min[axis]);
    box.min[axis] += skin;
    box.max[axis] -= skin;
  }
  return box;
}

/// Boxes that are longer than half of a reach and no longer than it, by the cell that their lower
/// corner lies in. Cells share as many buckets as there are boxes.
class Level {
 public:
  explicit Level(double reach) : reach_(reach), edge_(2 * reach) {}

  void add(const Aabb& box) {
    if (boxes_.size() == first_.size()) growTable();
    boxes_.push_back({box, kNone});
    chain(static_cast<std::uint32_t>(boxes_.size() - 1));
  }

  [[nodiscard]] bool overlaps(const Aabb& box) const {
    Cell low;
    Cell high;
    double cells = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = indexOf(box.min[axis] - reach_);
      high[axis] = indexOf(box.max[axis]);
      cells *= static_cast<double>(high[axis] - low[axis] + 1);
    }
    if (cells > static_cast<double>(boxes_.size())) {
      return std::ranges::any_of(
          boxes_, [&](const Entry& entry) { return broadmark::overlaps(entry.box, box); });
    }
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t z = low[2]; z <= high[2]; ++z) {
          if (overlapsInBucket(bucketOf({x, y, z}), box)) return true;
        }
      }
    }
    return false;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Entry {
    Aabb box;
    std::uint32_t next;  ///< in the same bucket
  };
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  [[nodiscard]] std::int64_t indexOf(double coordinate) const {
    return static_cast<std::int64_t>(std::floor(coordinate / edge_));
  }

  [[nodiscard]] std::size_t bucketOf(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t index : cell) {
      hash = (hash ^ static_cast<std::uint64_t>(index)) * 0x9E3779B97F4A7C15U;
      hash ^= hash >> 32;
    }
    return hash & (first_.size() - 1);
  }

  [[nodiscard]] bool overlapsInBucket(std::size_t bucket, const Aabb& box) const {
    for (std::uint32_t i = first_[bucket]; i != kNone; i = boxes_[i].next) {
      if (broadmark::overlaps(boxes_[i].box, box)) return true;
    }
    return false;
  }

  void chain(std::uint32_t index) {
    Entry& entry = boxes_[index];
    const auto& [x, y, z, unused] = entry.box.min;
    std::uint32_t& first = first_[bucketOf({indexOf(x), indexOf(y), indexOf(z)})];
    entry.next = std::exchange(first, index);
  }

  void growTable() {
    first_.assign(std::max<std::size_t>(2 * first_.size(), 64), kNone);
    for (std::uint32_t i = 0; i < boxes_.size(); ++i) chain(i);
  }

  double reach_;
  double edge_;
  std::vector<Entry> boxes_;
  std::vector<std::uint32_t> first_;  ///< by bucket; as many as a power of two
};

/// Boxes, and whether any of them overlaps another one.
class Occupied {
 public:
  void add(const Aabb& box) {
    const int exponent = exponentOf(box);
    levels_.try_emplace(exponent, std::ldexp(1.0, exponent)).first->second.add(box);
  }

  [[nodiscard]] bool overlaps(const Aabb& box) const {
    return std::ranges::any_of(levels_,
                               [&](const auto& level) { return level.second.overlaps(box); });
  }

 private:
  /// Of the least power of two above all edges.
  static int exponentOf(const Aabb& box) {
    float longest = 0;
    for (int axis = 0; axis < 3; ++axis) {
      longest = std::max(longest, box.max[axis] - box.min[axis]);
    }
    int exponent = 0;
    std::frexp(longest, &exponent);
    return exponent;
  }

  std::map<int, Level> levels_;
};

std::size_t checkedCount(double count) {
  const double whole = std::floor(count);
  if (whole >= 0 && whole <= static_cast<double>(kMostAuthoredBodies)) {
    return static_cast<std::size_t>(whole);
  }
  throw InputError(fmt::format("the brush would place {:.4g} bodies: a scene holds at most {}",
                               whole, kMostAuthoredBodies));
}

}  // namespace

Paint::Paint() : object_type(choiceOf(objectTypes())) {}

void Paint::visitParameters(const ParameterVisitor& visit) {
  visit({"object_type", "what the bodies are", &object_type});
  visit({"scale", "factor on the size of the bodies, in world units", &scale, 1e-3, 1e3});
  visit({"mass", "mass of a body", &mass, 1e-3, 1e6});
  visit({"frozen", "whether they are immovable obstacles", &frozen});
  visit({"overlap", "whether they may overlap each other and what is there", &overlap});
  visit({"seed", "start of the random numbers", &seed, 0, 4'294'967'295});
}

Stroke paint(const Brush& brush, const Paint& paint, const Vec3& at,
             std::span<const AuthoredBody> present) {
  Random random(static_cast<std::uint64_t>(paint.seed));
  const ObjectType type = entryOf(objectTypes(), paint.object_type, "object type");
  const std::size_t count = checkedCount(brush.count(paint.scale * paint.scale * paint.scale));
  Occupied occupied;
  if (!paint.overlap) {
    for (const AuthoredBody& body : present) occupied.add(core(tightBox(body.shape, body.pose)));
  }
  Stroke stroke;
  const int tries = brush.scatters() && !paint.overlap ? kTries : 1;
  for (std::size_t i = 0; i < count; ++i) {
    AuthoredBody body;
    body.shape = type.shape(i, paint.scale, random);
    body.mass = paint.mass;
    body.frozen = paint.frozen;
    bool placed = false;
    for (int attempt = 0; attempt < tries && !placed; ++attempt) {
      const Vec3 place = brush.place(i, random);
      for (std::size_t axis = 0; axis < 3; ++axis)
        body.pose.position[axis] = at[axis] + place[axis];
      const Aabb box = core(tightBox(body.shape, body.pose));
      if (!paint.overlap && occupied.overlaps(box)) continue;
      placed = true;
      if (!paint.overlap) occupied.add(box);
      stroke.bodies.push_back(body);
    }
    stroke.left_out += placed ? 0 : 1;
  }
  return stroke;
}

}  // namespace broadmark::scenes
