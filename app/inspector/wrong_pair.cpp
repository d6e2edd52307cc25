#include "inspector/wrong_pair.h"

#include <fmt/format.h>

namespace broadmark {

std::string pairName(Pair pair) { return fmt::format("{}-{}", pair.a, pair.b); }

std::vector<WrongPair> wrongPairs(const FrameDifference& difference) {
  std::vector<WrongPair> wrong;
  const auto add = [&](WrongPair::Kind kind, const std::vector<Pair>& pairs) {
    for (const Pair pair : pairs) wrong.push_back({kind, pair});
  };
  add(WrongPair::Kind::missed, difference.missed_pairs);
  add(WrongPair::Kind::false_pair, difference.false_pairs);
  add(WrongPair::Kind::invalid, difference.invalid_pairs);
  add(WrongPair::Kind::allowed_extra, difference.allowed_extra_pairs);
  return wrong;
}

AxisRelation relationOn(std::size_t axis, const Aabb& a, const Aabb& b) {
  // In doubles the difference of two floats never vanishes unless they are equal.
  const double gap = std::max(static_cast<double>(a.min[axis]) - static_cast<double>(b.max[axis]),
                              static_cast<double>(b.min[axis]) - static_cast<double>(a.max[axis]));
  AxisRelation relation{.gap = gap};
  if (gap < 0) relation.kind = AxisRelation::Kind::overlap;
  if (gap == 0) relation.kind = AxisRelation::Kind::touch;
  return relation;
}

std::size_t decidingAxis(const Aabb& a, const Aabb& b) {
  std::size_t widest = 0;
  for (std::size_t axis = 1; axis < 3; ++axis) {
    if (relationOn(axis, a, b).gap > relationOn(widest, a, b).gap) widest = axis;
  }
  return widest;
}

std::optional<std::uint32_t> PairTrack::overlapBegan() const {
  std::size_t first = size();
  while (first > 0 && overlapsAt(first - 1)) --first;
  if (first == size()) return {};
  return a.first + static_cast<std::uint32_t>(first);
}

}  // namespace broadmark
