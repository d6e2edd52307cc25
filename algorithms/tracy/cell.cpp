#include "tracy/cell.h"

#include <algorithm>
#include <bit>

#include "prefetch.h"

namespace broadmark::tracy {
namespace {

constexpr std::uint32_t kMinSlots = 64;

/// Three instructions without a branch; two comparisons take six.
bool overlapsOnAxis(const Aabb& a, const Aabb& b, int axis) {
  return std::max(a.min[axis], b.min[axis]) <= std::min(a.max[axis], b.max[axis]);
}

}  // namespace

void Cell::build(const CellPosition& position, std::span<const std::uint32_t> bodies,
                 const BodyStates& states, CellWork& work) {
  position_ = position;
  filter_ = states.filter.wantsAll() ? nullptr : &states.filter;
  size_ = static_cast<std::uint32_t>(bodies.size());
  if (bodies.empty()) return;
  capacity_ = std::max(kMinSlots, std::bit_ceil(size_));
  bodies_.reserve(capacity_);
  slots_.reserve(capacity_);
  crossings_.reserve(capacity_);
  free_.reserve(capacity_);
  for (const std::uint32_t body : bodies) {
    const Aabb& box = states.boxes[kNow][body];
    const Crossing crossing = crossingOf(states.ranges[kNow][body], position_);
    bodies_.push_back(body);
    slots_.push_back({{box, box}});
    crossings_.push_back({crossing, crossing});
  }
  std::vector<Endpoint>& sorted = work.endpoints;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sorted.clear();
    for (std::uint32_t slot = 0; slot < size_; ++slot) {
      const auto [start, end] = ends(slot, kNow)[axis];
      sorted.push_back(start);
      sorted.push_back(end);
    }
    std::ranges::sort(sorted);
    lists_[axis].build(sorted, capacity_);
    if (axis == 0) reportInitialPairs(sorted, work);
  }
}

/// Sweep and prune: each body against those that begin before it ends.
void Cell::reportInitialPairs(std::span<const Endpoint> endpoints, CellWork& work) const {
  for (std::size_t i = 0; i < endpoints.size(); ++i) {
    if (endpoints[i].isEnd()) continue;
    const std::uint32_t slot = endpoints[i].slot();
    for (std::size_t j = i + 1; endpoints[j].slot() != slot; ++j) {
      if (endpoints[j].isEnd()) continue;
      const std::uint32_t other = endpoints[j].slot();
      if (overlaps(box(slot, kNow), box(other, kNow)) && isHomeCell(slot, other, kNow)) {
        report(slot, other, work.begun);
      }
    }
  }
}

Cell::Ends Cell::ends(std::uint32_t slot, Moment moment) const {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const Crossing crossing = crossings_[slot][moment];
  const Aabb& aabb = box(slot, moment);
  Ends result;
  for (int axis = 0; axis < 3; ++axis) {
    const bool below = (crossing & crossesBelow(axis)) != 0;
    const bool above = (crossing & crossesAbove(axis)) != 0;
    result[axis] = {Endpoint::start(below ? -kInfinity : aabb.min[axis], slot),
                    Endpoint::end(above ? kInfinity : aabb.max[axis], slot)};
  }
  return result;
}

/// Applies the new boxes, and classifies the moved bodies as leaving, jumping or staying.
void Cell::classifyMoved(const BodyStates& states, CellWork& work) {
  work.leaving.clear();
  work.jumping.clear();
  work.staying.clear();
  work.entered.clear();
  if (states.few_moved) {
    for (const std::uint32_t body : work.moved) {
      const auto slot = std::ranges::find(bodies_, body) - bodies_.begin();
      classify(static_cast<std::uint32_t>(slot), states, work);
    }
    return;
  }
  for (std::uint32_t slot = 0; slot < bodies_.size(); ++slot) {
    const std::uint32_t body = bodies_[slot];
    if (body != kEmptySlot && states.hasMoved(body)) classify(slot, states, work);
  }
}

void Cell::classify(std::uint32_t slot, const BodyStates& states, CellWork& work) {
  const std::uint32_t body = bodies_[slot];
  slots_[slot].boxes[kNow] = states.boxes[kNow][body];
  const CellRange& range = states.ranges[kNow][body];
  if (!range.contains(position_)) {
    work.leaving.push_back(slot);
    return;
  }
  crossings_[slot][kNow] = crossingOf(range, position_);
  (jumps(slot) ? work.jumping : work.staying).push_back(slot);
}

/// Whether removal and insertion are cheaper than insertion sort.
bool Cell::jumps(std::uint32_t slot) const {
  // The common case: the body moved no farther than its own length.
  if (overlaps(box(slot, kBefore), box(slot, kNow))) return false;
  const Ends from = ends(slot, kBefore);
  const Ends to = ends(slot, kNow);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t end = 0; end < 2; ++end) {
      if (!lists_[axis].isNear(from[axis][end], to[axis][end])) return true;
    }
  }
  return false;
}

void Cell::leave(std::uint32_t slot, CellWork& work) {
  unlink(slot, work);
  bodies_[slot] = kEmptySlot;
  free_.push_back(slot);
  --size_;
}

void Cell::enter(std::uint32_t body, const BodyStates& states, CellWork& work) {
  const std::uint32_t slot = takeSlot(body);
  slots_[slot].boxes = {states.boxes[kBefore][body], states.boxes[kNow][body]};
  crossings_[slot][kNow] = crossingOf(states.ranges[kNow][body], position_);
  link(slot, work);
  work.entered.push_back(slot);
}

std::uint32_t Cell::takeSlot(std::uint32_t body) {
  ++size_;
  if (!free_.empty()) {
    const std::uint32_t slot = free_.back();
    free_.pop_back();
    bodies_[slot] = body;
    return slot;
  }
  if (bodies_.size() == capacity_) grow();
  bodies_.push_back(body);
  slots_.emplace_back();
  crossings_.emplace_back();
  return static_cast<std::uint32_t>(bodies_.size() - 1);
}

void Cell::grow() {
  capacity_ = std::max(kMinSlots, 2 * capacity_);
  bodies_.reserve(capacity_);
  slots_.reserve(capacity_);
  crossings_.reserve(capacity_);
  free_.reserve(capacity_);
  for (SegmentedList& list : lists_) list.build(list.endpoints(), capacity_);
}

void Cell::unlink(std::uint32_t slot, CellWork& work) {
  reportOverlaps(slot, kNow, kBefore, work.ended);
  const Ends from = ends(slot, kBefore);
  for (std::size_t axis = 0; axis < 3; ++axis) lists_[axis].remove(from[axis][0], from[axis][1]);
}

void Cell::link(std::uint32_t slot, CellWork& work) {
  const Ends to = ends(slot, kNow);
  for (std::size_t axis = 0; axis < 3; ++axis) lists_[axis].insert(to[axis][0], to[axis][1]);
  reportOverlaps(slot, kBefore, kNow, work.begun);
}

/// Reports the pairs of a body that overlap at the moment `with` and not at the moment `without`.
void Cell::reportOverlaps(std::uint32_t slot, Moment without, Moment with,
                          std::vector<PairBuffer>& shares) const {
  lists_[0].forEachOverlapping(slot, [&](std::uint32_t other) { prefetch(&slots_[other]); });
  lists_[0].forEachOverlapping(slot, [&](std::uint32_t other) {
    if (overlaps(box(slot, with), box(other, with)) && isHomeCell(slot, other, with) &&
        !overlaps(box(slot, without), box(other, without))) {
      report(slot, other, shares);
    }
  });
}

void Cell::move(std::uint32_t slot, CellWork& work) {
  const Ends from = ends(slot, kBefore);
  const Ends to = ends(slot, kNow);
  for (int axis = 0; axis < 3; ++axis) {
    // In the order that keeps the start before the end.
    const std::size_t first = from[axis][1] < to[axis][1] ? 1 : 0;
    for (const std::size_t end : {first, 1 - first}) {
      if (from[axis][end] != to[axis][end])
        moveEndpoint(axis, from[axis][end], to[axis][end], work);
    }
  }
}

void Cell::moveEndpoint(int axis, Endpoint from, Endpoint to, CellWork& work) {
  const bool may_begin = from.isEnd() == (from < to);
  const Moment without = may_begin ? kBefore : kNow;
  const Moment with = may_begin ? kNow : kBefore;
  std::vector<PairBuffer>& shares = may_begin ? work.begun : work.ended;
  std::uint64_t swaps = 0;
  lists_[axis].move(from, to, [&](Endpoint passed) {
    ++swaps;
    if (passed.isEnd() == from.isEnd()) return;
    const std::uint32_t starts = from.isEnd() ? passed.slot() : from.slot();
    const std::uint32_t ends = from.isEnd() ? from.slot() : passed.slot();
    if (isReportedSwap(starts, ends, axis, without, with)) report(starts, ends, shares);
  });
  work.counts.swaps += swaps;
}

/// Whether the swap of the start of one body with the end of another reports the pair: an overlap
/// at the moment `with` and not at the moment `without`.
bool Cell::isReportedSwap(std::uint32_t starts, std::uint32_t ends, int axis, Moment without,
                          Moment with) const {
  // Early out: most pairs are separated on another axis.
  if (!overlapsOnAxis(box(starts, with), box(ends, with), axis == 0 ? 1 : 0)) return false;
  if (!overlaps(box(starts, with), box(ends, with)) || !isHomeCell(starts, ends, with))
    return false;
  for (int lower = 0; lower < axis; ++lower) {
    if (!overlapsOnAxis(box(starts, without), box(ends, without), lower)) return false;
  }
  return box(starts, without).min[axis] > box(ends, without).max[axis];
}

void Cell::report(std::uint32_t p, std::uint32_t q, std::vector<PairBuffer>& shares) const {
  const std::uint32_t a = bodies_[p];
  const std::uint32_t b = bodies_[q];
  if (filter_ == nullptr || filter_->wanted(a, b)) shares[std::min(a, b) % shares.size()].add(a, b);
}

void Cell::endFrame(const CellWork& work) {
  for (const auto* slots : {&work.staying, &work.jumping, &work.entered}) {
    for (const std::uint32_t slot : *slots) {
      slots_[slot].boxes[kBefore] = slots_[slot].boxes[kNow];
      crossings_[slot][kBefore] = crossings_[slot][kNow];
    }
  }
}

void Cell::forEachSegment(const std::function<void(float)>& visit) const {
  if (size_ == 0) return;
  lists_[0].forEachChunk([&](std::span<const Endpoint> chunk) {
    const Endpoint first = chunk.front();
    const Crossing outside = first.isEnd() ? crossesAbove(0) : crossesBelow(0);
    if ((crossings_[first.slot()][kNow] & outside) != 0) return;
    const Aabb& body = box(first.slot(), kNow);
    visit(first.isEnd() ? body.max[0] : body.min[0]);
  });
}

std::string Cell::validate(const BodyStates& states) const {
  std::uint32_t occupied = 0;
  for (std::uint32_t slot = 0; slot < bodies_.size(); ++slot) {
    const std::uint32_t body = bodies_[slot];
    if (body == kEmptySlot) continue;
    ++occupied;
    if (!states.ranges[kNow][body].contains(position_))
      return "a body is in a cell that it does not touch";
    const Crossing crossing = crossingOf(states.ranges[kNow][body], position_);
    if (crossings_[slot] != Crossings{crossing, crossing})
      return "the crossed sides of a cell are wrong";
    for (const Aabb& stored : slots_[slot].boxes) {
      if (stored != states.boxes[kNow][body]) return "a box is out of date";
    }
  }
  if (occupied != size_ || occupied + free_.size() != bodies_.size()) return "a slot is lost";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (size_ == 0) continue;
    if (std::string fault = lists_[axis].validate(); !fault.empty()) return fault;
    const std::vector<Endpoint> endpoints = lists_[axis].endpoints();
    if (endpoints.size() != 2 * std::size_t{size_}) return "the number of endpoints is wrong";
    for (const Endpoint endpoint : endpoints) {
      if (endpoint != ends(endpoint.slot(), kNow)[axis][endpoint.isEnd() ? 1 : 0]) {
        return "an endpoint is out of date";
      }
    }
  }
  return {};
}

}  // namespace broadmark::tracy
