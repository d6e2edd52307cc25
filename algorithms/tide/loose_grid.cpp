#include "tide/loose_grid.h"

#include <bit>
#include <map>
#include <string>
#include <utility>

#include "prefetch.h"

namespace broadmark::tide {

void LooseGrid::build(std::span<const Aabb> boxes) {
  layout_.fit(boxes);
  buckets_.reset(layout_.cellCount());
  bodies_.resize(boxes.size());
  for (std::size_t body = 0; body < boxes.size(); ++body) {
    if (body + kPrefetchDistance < boxes.size()) {
      const std::uint32_t cell = layout_.cellOf(boxes[body + kPrefetchDistance]);
      if (cell != kInvalidIndex) prefetch(&buckets_[cell]);
    }
    const Aabb& box = boxes[body];
    bodies_[body].move(box, layout_.cellOf(box), 0);
    if (isEmpty(box)) continue;
    const GridBox grid_box = layout_.quantize(box);
    buckets_.put(bodies_[body].cell(), static_cast<std::uint32_t>(body),
                 layout_.packBounds(grid_box, grid_box, GridLayout::levelOf(grid_box)), true);
  }
  frame_ = 1;
}

void LooseGrid::moveBodies(std::span<const std::uint32_t> bodies, std::span<const Aabb> boxes) {
  moves_.resize(2 * bodies.size());
  buckets_.reserve(bodies.size());  // cell queries hold pointers to buckets
  const std::size_t moves = kernels_->move_bodies(layout_, frame_, bodies.data(), bodies.size(),
                                                  boxes.data(), bodies_.data(), moves_.data());
  moves_.resize(moves);
}

/// A software pipeline: a stage prefetches for the next stage of its batch, and the other batches
/// hide the latency.
void LooseGrid::findEvents(const CollisionFilter& filter, PairBuffer& began, PairBuffer& ended) {
  const std::size_t batches = (moves_.size() + Batch::kMoves - 1) / Batch::kMoves;
  const auto in_flight = [&](std::size_t batch) {
    return batch < batches ? &pipeline_[batch % kStages] : nullptr;
  };
  for (std::size_t now = 0; now < batches + kStages - 1; ++now) {
    if (Batch* const batch = in_flight(now)) loadBatch(now * Batch::kMoves, *batch);
    if (Batch* const batch = in_flight(now - 1)) makeQueries(*batch);
    if (Batch* const batch = in_flight(now - 2)) {
      if (moves_.size() >= kMinMovesForOverflowPrefetch) prefetchOverflow(*batch);
      applyMoves(*batch);
    }
    // Not in the same stage: a vector load of a line that was just written in part stalls.
    if (Batch* const batch = in_flight(now - 3)) runQueries(*batch);
    if (Batch* const batch = in_flight(now - 4)) emitEvents(*batch, filter, began, ended);
  }
}

void LooseGrid::loadBatch(std::size_t first, Batch& batch) {
  const std::span<const MoveQuery> moves = moves_;
  batch.moves = moves.subspan(first, std::min(Batch::kMoves, moves.size() - first));
  for (const MoveQuery& move : batch.moves) {
    // The other accesses in between hide this sequence from the hardware prefetcher.
    prefetch(&move + kMovesAhead);
    prefetchL2(&bodies_[move.body]);
  }
}

void LooseGrid::makeQueries(Batch& batch) const {
  batch.queries.resize(0);
  for (std::uint32_t i = 0; i < batch.moves.size(); ++i) {
    const GridBox& region = batch.moves[i].region;
    for (std::uint32_t levels = layout_.usedLevels(); levels != 0; levels &= levels - 1) {
      const auto level = static_cast<std::uint32_t>(std::countr_zero(levels));
      const std::size_t queries = batch.queries.size();
      if (!kernels_->make_query(layout_, buckets_.data(), region, level, addQuery(i, batch))) {
        batch.queries.resize(queries);
        makeWrappedQueries(level, region, i, batch);
      }
    }
  }
  // All at once, so that the page walks overlap.
  for (const CellQuery& query : batch.queries) {
    for (const CellBucket* const bucket : query.buckets) prefetchL2(bucket);
  }
}

void LooseGrid::makeWrappedQueries(std::uint32_t level, const GridBox& box, std::uint32_t move,
                                   Batch& batch) const {
  const GridLayout::Level& grid = layout_.level(level);
  const GridLayout::WrappedRange range = layout_.wrappedRange(box, level);
  for (std::int32_t z = 0; z < range.counts[2]; z += 2) {
    for (std::int32_t y = 0; y < range.counts[1]; y += 2) {
      for (std::int32_t x = 0; x < range.counts[0]; x += 2) {
        const GridCoord offset = {x, y, z, 0};
        GridCoord cell = range.first + offset;
        cell -= (cell >= grid.dims) & grid.dims;
        const GridCoord index = cell * grid.strides;
        const GridCoord has_second = range.counts - offset > 1;
        const GridCoord next = (index + grid.strides) & (cell + 1 < grid.dims);
        const GridCoord from_first = offset << GridLayout::kCellBits;
        setBuckets({.first = &buckets_[grid.base + sumOfAxes(index)],
                    .offset = (next - index) & has_second,
                    .has_second = has_second,
                    .query = {range.query.min - from_first, range.query.max - from_first}},
                   addQuery(move, batch));
      }
    }
  }
}

/// Its buckets are not set.
inline CellQuery& LooseGrid::addQuery(std::uint32_t move, Batch& batch) {
  const auto index = static_cast<std::uint32_t>(batch.queries.size());
  batch.queries.resize(index + 1);
  CellQuery& query = batch.queries[index];
  query.move = move;
  query.root = index;
  return query;
}

/// Overflow buckets are known only once the cells' own buckets are in the cache.
void LooseGrid::prefetchOverflow(const Batch& batch) const {
  for (const CellQuery& query : batch.queries) {
    for (const CellBucket* const bucket : query.buckets) {
      prefetchL2(bucket->next == kInvalidIndex ? bucket : &buckets_[bucket->next]);
    }
  }
}

void LooseGrid::applyMoves(const Batch& batch) {
  const std::size_t departures = departures_.size();
  departures_.resize(departures + batch.moves.size());
  Departure* next = departures_.data() + departures;
  for (const MoveQuery& move : batch.moves) {
    const bool changes = move.cell != move.cell_before;
    *next = {move.body, move.cell_before};
    next += unsigned{changes} & unsigned{move.cell_before != kInvalidIndex};
    work_.cell_changes += changes ? 1 : 0;
    if (move.cell != kInvalidIndex) [[likely]] {
      buckets_.put(move.cell, move.body, move.bounds, changes);
    }
  }
  departures_.resize(static_cast<std::size_t>(next - departures_.data()));
}

/// The cells' own buckets first, then their overflow buckets, list by list.
void LooseGrid::runQueries(Batch& batch) {
  std::size_t hits = 0;
  for (std::size_t first = 0; first < batch.queries.size();) {
    const std::size_t count = batch.queries.size() - first;
    hits_.resize(hits + count);
    overflows_.resize(count);
    const Kernels::Counts counts = kernels_->run_queries(batch.queries.data() + first, count,
                                                         static_cast<std::uint32_t>(first),
                                                         hits_.data() + hits, overflows_.data());
    hits += counts.hits;
    for (std::size_t i = 0; i < counts.overflows; ++i) queryOverflow(overflows_[i], batch);
    first += count;
  }
  work_.cell_queries += batch.queries.size();
  collectCandidates(batch, hits);
}

void LooseGrid::queryOverflow(const Hit& overflow, Batch& batch) const {
  batch.queries.resize(batch.queries.size() + 1);
  const CellQuery& previous = batch.queries[overflow.query];
  CellQuery& query = batch.queries[batch.queries.size() - 1];
  query = previous;
  for (std::uint32_t bucket = 0; bucket < CellQuery::kBuckets; ++bucket) {
    if ((overflow.bits >> 8 * bucket & CellQuery::kOverflowBits & 0xFF) == 0) continue;
    query.buckets[bucket] = &buckets_[previous.buckets[bucket]->next];
  }
  query.active = (overflow.bits >> 7) * CellQuery::kBucketBits;
}

/// Lists the bodies hit, except the moving body itself. The loop is unrolled three times without a
/// branch, since a query seldom hits more than three bodies and the number is unpredictable.
void LooseGrid::collectCandidates(Batch& batch, std::size_t hits) const {
  // One extra element: writes are unconditional.
  batch.candidates.resize(hits * CellQuery::kBuckets * CellBucket::kSlots + 1);
  Candidate* end = batch.candidates.data();
  for (std::size_t i = 0; i < hits; ++i) {
    const Hit& hit = hits_[i];
    const CellQuery& query = batch.queries[hit.query];
    const std::uint32_t body = batch.moves[query.move].body;
    std::uint64_t slots = hit.bits;
    const auto add = [&] {
      // Once no slot is left, reads the first one again and does not advance.
      const std::uint64_t any = slots | (hit.bits & (0U - std::uint64_t{slots == 0}));
      const auto bit = static_cast<std::uint32_t>(std::countr_zero(any));
      const std::uint32_t bucket = bit / 8;
      const std::uint32_t other = query.buckets[bucket]->bodies[bit % 8];
      *end = {other, hit.query * CellQuery::kBuckets + bucket};
      end += unsigned{slots != 0} & unsigned{other != body};
      slots &= slots - 1;
    };
    add();
    add();
    add();
    while (slots != 0) [[unlikely]]
      add();
  }
  batch.candidates.resize(static_cast<std::size_t>(end - batch.candidates.data()));
  for (const Candidate& candidate : batch.candidates) prefetchL2(&bodies_[candidate.other]);
}

/// Branchless, since events are unpredictable: write unconditionally, advance only on a match.
void LooseGrid::emitEvents(const Batch& batch, const CollisionFilter& filter, PairBuffer& began,
                           PairBuffer& ended) {
  const bool wants_all = filter.wantsAll();
  Pair* const first_began = began.room(batch.candidates.size());
  Pair* const first_ended = ended.room(batch.candidates.size());
  Pair* next_began = first_began;
  Pair* next_ended = first_ended;
  for (const Candidate& candidate : batch.candidates) {
    const std::uint32_t body = batch.moves[batch.queryOf(candidate).move].body;
    EventMask event = eventOf(batch, candidate);
    if (!wants_all && event != 0 && !filter.wanted(body, candidate.other)) event = 0;
    const Pair pair = orderedPair(body, candidate.other);
    *next_began = pair;
    *next_ended = pair;
    next_began += event & kBeginEvents;
    next_ended += event / kEndEvents;
  }
  began.advance(static_cast<std::size_t>(next_began - first_began));
  ended.advance(static_cast<std::size_t>(next_ended - first_ended));
  work_.tests += batch.candidates.size();
}

/// kBeginEvents or kEndEvents if the overlap of the two bodies begins or ends, else 0.
EventMask LooseGrid::eventOf(const Batch& batch, const Candidate& candidate) const {
  const CellQuery& query = batch.queryOf(candidate);
  const MoveQuery& move = batch.moves[query.move];
  const Body& body = bodies_[move.body];
  const Body& other = bodies_[candidate.other];
  const Aabb* other_before = &other.box;
  EventMask events = move.events;
  if (other.frame() == frame_) [[unlikely]] {
    // Both bodies are moving: only the later one reports the pair.
    if (candidate.other > move.body) return 0;
    other_before = &other.before;
    // A body that changed cells is found in both: its old cell reports ends, its new cell begins.
    if (other.cellBefore() != other.cell()) {
      const CellBucket* const cell =
          batch.queries[query.root].buckets[candidate.bucket % CellQuery::kBuckets];
      events &= buckets_.indexOf(cell) == other.cell() ? kBeginEvents : kEndEvents;
    }
  }
  const unsigned was{overlapOnAxes(body.before, *other_before)};
  const unsigned is{overlapOnAxes(body.box, other.box)};
  static_assert(kBeginEvents == 1 && kEndEvents == 2);
  return events & ((is & ~was) | (was & ~is) << 1);
}

void LooseGrid::endFrame() {
  for (std::size_t i = 0; i < departures_.size(); ++i) {
    if (i + kPrefetchDistance < departures_.size()) {
      prefetch(&buckets_[departures_[i + kPrefetchDistance].cell]);
    }
    buckets_.remove(departures_[i].cell, departures_[i].body);
  }
  departures_.resize(0);
  moves_.resize(0);
  ++frame_;
}

WorkCounts LooseGrid::measureMoves(std::span<const std::uint32_t> bodies,
                                   std::span<const Aabb> boxes) {
  const WorkCounts work_before = std::exchange(work_, {});
  PairBuffer no_events;
  moveBodies(bodies, boxes);
  findEvents({}, no_events, no_events);
  endFrame();
  return std::exchange(work_, work_before);
}

void LooseGrid::copyBoxes(std::vector<Aabb>& boxes) const {
  boxes.resize(bodies_.size());
  for (std::size_t body = 0; body < boxes.size(); ++body) {
    boxes[body] = bodies_[body].box;
    boxes[body].min[3] = boxes[body].max[3] = 0;
  }
}

void LooseGrid::draw(DebugDraw& draw) const {
  std::map<std::array<std::int32_t, 4>, std::uint32_t> populations;
  for (const Body& body : bodies_) {
    if (isEmpty(body.box)) continue;
    const GridBox box = layout_.quantize(body.box);
    const std::uint32_t level = GridLayout::levelOf(box);
    GridCoord cell = box.min >> GridLayout::cellShift(level);
    cell[3] = static_cast<std::int32_t>(level);
    ++populations[std::bit_cast<std::array<std::int32_t, 4>>(cell)];
  }
  for (const auto& [cell, population] : populations) {
    const auto level = static_cast<std::uint32_t>(cell[3]);
    draw.cell(layout_.cellBox(std::bit_cast<GridCoord>(cell), level), cell[3], population);
  }
}

std::string LooseGrid::validate() const {
  std::size_t present = 0;
  for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
    const Body& body = bodies_[i];
    if (isEmpty(body.box)) continue;
    ++present;
    const GridBox box = layout_.quantize(body.box);
    const std::uint32_t level = GridLayout::levelOf(box);
    if (!isEveryAxis(box.size() <= layout_.level(level).max_size)) {
      return "body " + std::to_string(i) + " is larger than the maximum of its level";
    }
    const PackedBounds bounds = layout_.packBounds(box, box, level);
    bool is_stored = false;
    for (std::uint32_t index = body.cell(); index != kInvalidIndex; index = buckets_[index].next) {
      const CellBucket& bucket = buckets_[index];
      for (std::uint32_t slot = 0; slot < bucket.count(); ++slot) {
        is_stored |= bucket.bodies[slot] == i && packedOverlap(bucket.bounds[slot], bounds);
      }
    }
    if (!is_stored) return "body " + std::to_string(i) + " is not in its cell";
  }
  return buckets_.validate(present);
}

}  // namespace broadmark::tide
