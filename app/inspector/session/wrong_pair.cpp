#include "inspector/session/wrong_pair.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace broadmark {

std::string pairName(Pair pair) { return fmt::format("{}-{}", pair.a, pair.b); }

std::vector<WrongPair> wrongPairs(const FrameDifference& difference) {
  std::vector<WrongPair> wrong;
  for (const WrongKind& kind : kWrongKinds) {
    for (const Pair pair : difference.*kind.pairs) wrong.push_back({&kind, pair});
  }
  return wrong;
}

AxisRelation axisRelation(std::size_t axis, const Aabb& a, const Aabb& b) {
  // In doubles the difference of two floats never vanishes unless they are equal.
  const double gap = std::max(static_cast<double>(a.min[axis]) - static_cast<double>(b.max[axis]),
                              static_cast<double>(b.min[axis]) - static_cast<double>(a.max[axis]));
  AxisRelation relation{.gap = gap};
  if (gap < 0) relation.type = AxisRelation::Type::overlap;
  if (gap == 0) relation.type = AxisRelation::Type::touch;
  return relation;
}

Aabb relationBox(const Aabb& a, const Aabb& b) {
  Aabb box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::tie(box.min[axis], box.max[axis]) =
        std::minmax({std::max(a.min[axis], b.min[axis]), std::min(a.max[axis], b.max[axis])});
  }
  return box;
}

std::size_t maxSeparationAxis(const Aabb& a, const Aabb& b) {
  std::size_t widest = 0;
  for (std::size_t axis = 1; axis < 3; ++axis) {
    if (axisRelation(axis, a, b).gap > axisRelation(widest, a, b).gap) widest = axis;
  }
  return widest;
}

std::string absenceText(const Trail& trail) {
  std::size_t absent = 0;
  while (absent < trail.boxes.size() && isEmpty(trail.boxes[trail.boxes.size() - 1 - absent])) {
    ++absent;
  }
  const std::size_t since = trail.first + trail.boxes.size() - absent;
  if (absent < trail.boxes.size()) return fmt::format("absent: vanished in frame {}", since);
  return since == 0 ? "absent since frame 0"
                    : fmt::format("absent since frame {} or earlier", since);
}

std::string filterText(const CollisionFilter& filter, Pair pair) {
  if (filter.wanted(pair.a, pair.b)) return "";
  const BodyGroups a = filter.groupsOf(pair.a);
  const BodyGroups b = filter.groupsOf(pair.b);
  if (!filter.matrix().collide(a.layer, b.layer)) {
    return a.layer == b.layer
               ? fmt::format("filtered: layer {} does not collide with itself", a.layer)
               : fmt::format("filtered: layers {} and {} do not collide", a.layer, b.layer);
  }
  if (a.world != b.world) {
    return fmt::format("filtered: one body in world {}, one in world {}", a.world, b.world);
  }
  return "filtered: bodies share a tag";
}

std::optional<std::uint32_t> PairTrails::overlapStart() const {
  std::size_t first = size();
  while (first > 0 && overlapsAt(first - 1)) --first;
  if (first == size()) return {};
  return a.first + static_cast<std::uint32_t>(first);
}

}  // namespace broadmark
