// Moving bodies between cells.

#include "tide/loose_grid.h"

#include <fmt/format.h>

#include <bit>
#include <map>
#include <utility>

#include "prefetch.h"

namespace broadmark::tide {

void LooseGrid::build(std::span<const Aabb> boxes) {
  cells_.choose(boxes);
  lines_.clear(cells_.count());
  bodies_.resize(boxes.size());
  for (std::size_t body = 0; body < boxes.size(); ++body) {
    if (body + kPrefetchDistance < boxes.size()) {
      const std::uint32_t cell = cells_.cellOf(boxes[body + kPrefetchDistance]);
      if (cell != kNowhere) prefetch(&lines_[cell]);
    }
    const Aabb& box = boxes[body];
    bodies_[body].move(box, cells_.cellOf(box), 0);
    if (isEmpty(box)) continue;
    const Extent extent = cells_.extentOf(box);
    lines_.put(bodies_[body].cell(), static_cast<std::uint32_t>(body),
               cells_.boundsOf(extent, extent, Cells::levelOf(extent)), true);
  }
  frame_ = 1;
}

void LooseGrid::addMoves(std::span<const std::uint32_t> bodies, std::span<const Aabb> boxes) {
  searches_.resize(2 * bodies.size());
  lines_.makeRoom(bodies.size());  // none may move while there are looks into it
  const std::size_t searches = kernels_->add_searches(
      cells_, frame_, bodies.data(), bodies.size(), boxes.data(), bodies_.data(), searches_.data());
  searches_.resize(searches);
}

/// Each batch takes one step after the other, in turns with those behind it: so what a step needs
/// comes from memory meanwhile.
void LooseGrid::search(const CollisionFilter& filter, PairBuffer& began, PairBuffer& ended) {
  const std::size_t batches = (searches_.size() + Batch::kSearches - 1) / Batch::kSearches;
  const auto under_way = [&](std::size_t batch) {
    return batch < batches ? &under_way_[batch % kSteps] : nullptr;
  };
  for (std::size_t now = 0; now < batches + kSteps - 1; ++now) {
    if (Batch* const batch = under_way(now)) takeSearches(now * Batch::kSearches, *batch);
    if (Batch* const batch = under_way(now - 1)) lookAround(*batch);
    if (Batch* const batch = under_way(now - 2)) {
      if (searches_.size() >= kManySearches) sendForLinesBehind(*batch);
      makeMoves(*batch);
    }
    // Not in the turn before: to read a line of which a part was just written takes long.
    if (Batch* const batch = under_way(now - 3)) lookIntoCells(*batch);
    if (Batch* const batch = under_way(now - 4)) tellChanges(*batch, filter, began, ended);
  }
}

/// The searches from the given one on.
void LooseGrid::takeSearches(std::size_t first, Batch& batch) {
  const std::span<const Search> searches = searches_;
  batch.searches = searches.subspan(first, std::min(Batch::kSearches, searches.size() - first));
  for (const Search& search : batch.searches) {
    // No processor knows that these are read one after the other, as so much else is meanwhile.
    prefetch(&search + kSearchesAhead);
    prefetchL2(&bodies_[search.body]);
  }
}

/// Adds looks into the cells where somebody may overlap who is searched for.
void LooseGrid::lookAround(Batch& batch) const {
  batch.looks.resize(0);
  for (std::uint32_t i = 0; i < batch.searches.size(); ++i) {
    const Extent& extent = batch.searches[i].around;
    for (std::uint32_t levels = cells_.usedLevels(); levels != 0; levels &= levels - 1) {
      const auto level = static_cast<std::uint32_t>(std::countr_zero(levels));
      const std::size_t looks = batch.looks.size();
      if (!kernels_->set_look(cells_, lines_.data(), extent, level, addLook(i, batch))) {
        batch.looks.resize(looks);
        lookAroundFarOff(level, extent, i, batch);
      }
    }
  }
  // All at once: so what each waits for, to know where a page lies, is waited for together.
  for (const Look& look : batch.looks) {
    for (const Line* const line : look.lines) prefetchL2(line);
  }
}

void LooseGrid::lookAroundFarOff(std::uint32_t level, const Extent& extent, std::uint32_t search,
                                 Batch& batch) const {
  const Cells::Level& at = cells_.level(level);
  const Cells::Surroundings around = cells_.surroundings(extent, level);
  for (std::int32_t z = 0; z < around.counts[2]; z += 2) {
    for (std::int32_t y = 0; y < around.counts[1]; y += 2) {
      for (std::int32_t x = 0; x < around.counts[0]; x += 2) {
        const Steps offset = {x, y, z, 0};
        Steps cell = around.first + offset;
        cell -= (cell >= at.counts) & at.counts;
        const Steps number = cell * at.strides;
        const Steps is_two = around.counts - offset > 1;
        const Steps next = (number + at.strides) & (cell + 1 < at.counts);
        const Steps from_first = offset << Cells::kCellBits;
        setLines({.first = &lines_[at.first_cell + sumOfAxes(number)],
                  .next = (next - number) & is_two,
                  .is_two = is_two,
                  .extent = {around.extent.min - from_first, around.extent.max - from_first}},
                 addLook(search, batch));
      }
    }
  }
}

/// Has no lines yet.
inline Look& LooseGrid::addLook(std::uint32_t search, Batch& batch) {
  const auto number = static_cast<std::uint32_t>(batch.looks.size());
  batch.looks.resize(number + 1);
  Look& look = batch.looks[number];
  look.search = search;
  look.of_cells = number;
  return look;
}

/// Only in crowded cells there are lines that nobody knows of before another one has come.
void LooseGrid::sendForLinesBehind(const Batch& batch) const {
  for (const Look& look : batch.looks) {
    for (const Line* const line : look.lines) {
      prefetchL2(line->next == kNowhere ? line : &lines_[line->next]);
    }
  }
}

/// Puts bodies into their cells.
void LooseGrid::makeMoves(const Batch& batch) {
  const std::size_t left_before = left_.size();
  left_.resize(left_before + batch.searches.size());
  Left* left = left_.data() + left_before;
  for (const Search& search : batch.searches) {
    const bool changes = search.cell != search.cell_before;
    *left = {search.body, search.cell_before};
    left += unsigned{changes} & unsigned{search.cell_before != kNowhere};
    work_.cell_changes += changes ? 1 : 0;
    if (search.cell != kNowhere) [[likely]] {
      lines_.put(search.cell, search.body, search.bounds, changes);
    }
  }
  left_.resize(static_cast<std::size_t>(left - left_.data()));
}

/// Lists who else is there, in these cells, and is within limits: first those in the cells' own
/// lines, then in the lines behind them, and so on.
void LooseGrid::lookIntoCells(Batch& batch) {
  std::size_t hits = 0;
  for (std::size_t first = 0; first < batch.looks.size();) {
    const std::size_t count = batch.looks.size() - first;
    hits_.resize(hits + count);
    followed_.resize(count);
    const Kernels::Found found =
        kernels_->look(batch.looks.data() + first, count, static_cast<std::uint32_t>(first),
                       hits_.data() + hits, followed_.data());
    hits += found.hits;
    for (std::size_t i = 0; i < found.followed; ++i) addLookBehind(followed_[i], batch);
    first += count;
  }
  work_.looks += batch.looks.size();
  addCandidates(batch, hits);
}

void LooseGrid::addLookBehind(const Hit& followed, Batch& batch) const {
  batch.looks.resize(batch.looks.size() + 1);
  const Look& before = batch.looks[followed.look];
  Look& behind = batch.looks[batch.looks.size() - 1];
  behind = before;
  for (std::uint32_t line = 0; line < Look::kLines; ++line) {
    if ((followed.places >> 8 * line & Look::kFollowed & 0xFF) == 0) continue;
    behind.lines[line] = &lines_[before.lines[line]->next];
  }
  behind.wanted = (followed.places >> 7) * Look::kLine;
}

/// All but the bodies that are looking. A look seldom finds more than three, and nobody could
/// predict whether it does.
void LooseGrid::addCandidates(Batch& batch, std::size_t hits) const {
  // One more than there may be: it is written, and not kept.
  batch.candidates.resize(hits * Look::kLines * Line::kPlaces + 1);
  Candidate* end = batch.candidates.data();
  for (std::size_t i = 0; i < hits; ++i) {
    const Hit& hit = hits_[i];
    const Look& look = batch.looks[hit.look];
    const std::uint32_t body = batch.searches[look.search].body;
    std::uint64_t places = hit.places;
    const auto add = [&] {
      // Where nobody is left the first one is looked at again, and not kept.
      const std::uint64_t any = places | (hit.places & (0U - std::uint64_t{places == 0}));
      const auto bit = static_cast<std::uint32_t>(std::countr_zero(any));
      const std::uint32_t line = bit / 8;
      const std::uint32_t other = look.lines[line]->bodies[bit % 8];
      *end = {other, hit.look * Look::kLines + line};
      end += unsigned{places != 0} & unsigned{other != body};
      places &= places - 1;
    };
    add();
    add();
    add();
    while (places != 0) [[unlikely]] add();
  }
  batch.candidates.resize(static_cast<std::size_t>(end - batch.candidates.data()));
  for (const Candidate& candidate : batch.candidates) prefetchL2(&bodies_[candidate.other]);
}

/// Two bodies that both move are a pair of the one that search() comes to last: the higher number.
std::uint32_t LooseGrid::change(const Batch& batch, const Candidate& candidate) const {
  const Look& look = batch.lookOf(candidate);
  const Search& search = batch.searches[look.search];
  const Body& body = bodies_[search.body];
  const Body& other = bodies_[candidate.other];
  const Aabb* before = &other.box;
  std::uint32_t wanted = search.wanted;
  if (other.frame() == frame_) [[unlikely]] {
    if (candidate.other > search.body) return 0;
    before = &other.before;
    // A cell that it left tells of ends only, one into which it came of beginnings only.
    if (other.cellBefore() != other.cell()) {
      const Line* const cell = batch.looks[look.of_cells].lines[candidate.line % Look::kLines];
      wanted &= lines_.numberOf(cell) == other.cell() ? kBeginnings : kEnds;
    }
  }
  const unsigned was{overlapOnAxes(body.before, *before)};
  const unsigned is{overlapOnAxes(body.box, other.box)};
  static_assert(kBeginnings == 1 && kEnds == 2);
  return wanted & ((is & ~was) | (was & ~is) << 1);
}

/// Nobody could predict which these are, so all are written, and counted only if they are some.
void LooseGrid::tellChanges(const Batch& batch, const CollisionFilter& filter, PairBuffer& began,
                            PairBuffer& ended) {
  const bool wants_all = filter.wantsAll();
  Pair* const first_began = began.room(batch.candidates.size());
  Pair* const first_ended = ended.room(batch.candidates.size());
  Pair* next_began = first_began;
  Pair* next_ended = first_ended;
  for (const Candidate& candidate : batch.candidates) {
    const std::uint32_t body = batch.searches[batch.lookOf(candidate).search].body;
    std::uint32_t changed = change(batch, candidate);
    if (!wants_all && changed != 0 && !filter.wanted(body, candidate.other)) changed = 0;
    const Pair pair = orderedPair(body, candidate.other);
    *next_began = pair;
    *next_ended = pair;
    next_began += changed & kBeginnings;
    next_ended += changed / kEnds;
  }
  began.advance(static_cast<std::size_t>(next_began - first_began));
  ended.advance(static_cast<std::size_t>(next_ended - first_ended));
  work_.tests += batch.candidates.size();
}

void LooseGrid::settle() {
  for (std::size_t i = 0; i < left_.size(); ++i) {
    if (i + kPrefetchDistance < left_.size()) prefetch(&lines_[left_[i + kPrefetchDistance].cell]);
    lines_.remove(left_[i].cell, left_[i].body);
  }
  left_.resize(0);
  searches_.resize(0);
  ++frame_;
}

Work LooseGrid::tryMoves(std::span<const std::uint32_t> bodies, std::span<const Aabb> boxes) {
  const Work before = std::exchange(work_, {});
  PairBuffer none;
  addMoves(bodies, boxes);
  search({}, none, none);
  settle();
  return std::exchange(work_, before);
}

void LooseGrid::boxes(std::vector<Aabb>& into) const {
  into.resize(bodies_.size());
  for (std::size_t body = 0; body < into.size(); ++body) {
    into[body] = bodies_[body].box;
    into[body].min[3] = into[body].max[3] = 0;
  }
}

/// The cells that bodies are in, by level.
void LooseGrid::draw(DebugDraw& draw) const {
  std::map<std::array<std::int32_t, 4>, std::uint32_t> populations;
  for (const Body& body : bodies_) {
    if (isEmpty(body.box)) continue;
    const Extent extent = cells_.extentOf(body.box);
    const std::uint32_t level = Cells::levelOf(extent);
    Steps cell = extent.min >> Cells::shiftOf(level);
    cell[3] = static_cast<std::int32_t>(level);
    ++populations[std::bit_cast<std::array<std::int32_t, 4>>(cell)];
  }
  for (const auto& [cell, population] : populations) {
    const Aabb box = cells_.boxOf(std::bit_cast<Steps>(cell), static_cast<std::uint32_t>(cell[3]));
    draw.cell(box, cell[3], population);
  }
}

std::string LooseGrid::validate() const {
  std::size_t present = 0;
  for (std::uint32_t body = 0; body < bodies_.size(); ++body) {
    const Body& of = bodies_[body];
    if (isEmpty(of.box)) continue;
    ++present;
    const Extent extent = cells_.extentOf(of.box);
    if (!isEveryAxis(extent.edges() <= cells_.level(Cells::levelOf(extent)).reach)) {
      return fmt::format("body {} reaches farther than its level", body);
    }
    const Bounds bounds = cells_.boundsOf(extent, extent, Cells::levelOf(extent));
    bool is_there = false;
    for (std::uint32_t line = of.cell(); line != kNowhere; line = lines_[line].next) {
      for (std::uint32_t place = 0; place < lines_[line].count(); ++place) {
        is_there |=
            lines_[line].bodies[place] == body && areWithin(lines_[line].bounds[place], bounds);
      }
    }
    if (!is_there) return fmt::format("body {} is not in its cell", body);
  }
  return lines_.validate(present);
}

}  // namespace broadmark::tide
