#include "inspector/mismatch.h"

#include <fmt/format.h>

#include <algorithm>

namespace broadmark {

const char* wrongPairName(WrongPair::Kind kind) {
  switch (kind) {
    case WrongPair::Kind::missed:
      return "missed";
    case WrongPair::Kind::extra:
      return "extra";
    case WrongPair::Kind::invalid:
      return "invalid";
    case WrongPair::Kind::allowed:
      return "allowed";
  }
  return "";
}

std::string pairName(Pair pair) { return fmt::format("{}-{}", pair.a, pair.b); }

std::vector<WrongPair> wrongPairs(const FrameDifference& difference, const std::vector<Aabb>& boxes,
                                  float margin) {
  std::vector<WrongPair> wrong;
  const auto add = [&](const std::vector<Pair>& pairs, auto kind_of) {
    for (const Pair pair : pairs) wrong.push_back({kind_of(pair), pair});
  };
  add(difference.missed, [](Pair) { return WrongPair::Kind::missed; });
  add(difference.extra, [&](Pair pair) {
    const bool excused = pair.a < boxes.size() && pair.b < boxes.size() &&
                         overlaps(enlarged(boxes[pair.a], margin), enlarged(boxes[pair.b], margin));
    return excused ? WrongPair::Kind::allowed : WrongPair::Kind::extra;
  });
  add(difference.invalid, [](Pair) { return WrongPair::Kind::invalid; });
  std::ranges::stable_sort(wrong, {}, &WrongPair::kind);
  return wrong;
}

const char* relationName(AxisRelation::Kind kind) {
  switch (kind) {
    case AxisRelation::Kind::overlap:
      return "overlap";
    case AxisRelation::Kind::touch:
      return "touch";
    case AxisRelation::Kind::gap:
      return "gap";
  }
  return "";
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

std::optional<RunProgress::Stop> nextKnownMismatch(const std::vector<LaneReport>& lanes,
                                                   std::uint32_t frame) {
  std::optional<RunProgress::Stop> next;
  for (const LaneReport& lane : lanes) {
    for (std::uint32_t index = frame + 1; index <= lane.frames.size(); ++index) {
      if (!lane.frames[index - 1].mismatch) continue;
      if (!next || index < next->frame) next = {.frame = index, .lane = lane.spec.number};
      break;
    }
  }
  return next;
}

}  // namespace broadmark
