// Moving bodies between cells.

#include "tide/loose_grid.h"

#include <fmt/format.h>

#include <cstring>
#include <map>

#include "prefetch.h"

namespace broadmark::tide {

void LooseGrid::build(std::span<const Aabb> boxes) {
  cells_.choose(boxes);
  lines_.clear(cells_.count());
  bodies_.resize(boxes.size());
  for (std::size_t body = 0; body < boxes.size(); ++body) {
    if (body + kPrefetchAhead < boxes.size()) {
      const std::uint32_t cell = cells_.cellOf(boxes[body + kPrefetchAhead]);
      if (cell != kNowhere) prefetch(&lines_[cell]);
    }
    const Aabb& box = boxes[body];
    bodies_[body].move(box, cells_.cellOf(box), 0);
    if (isEmpty(box)) continue;
    const Extent extent = cells_.extentOf(box);
    lines_.insert(bodies_[body].cell(), static_cast<std::uint32_t>(body),
                  cells_.boundsOf(extent, extent, Cells::levelOf(extent)));
  }
  frame_ = 1;
}

void LooseGrid::addMoves(std::span<const std::uint32_t> bodies, std::span<const Aabb> boxes) {
  moves_.resize(bodies.size());
  lines_.makeRoom(bodies.size());  // none may move while there are looks into it
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (i + kPrefetchFarAhead < bodies.size()) {
      prefetchFar(&boxes[bodies[i + kPrefetchFarAhead]]);
      prefetchFar(&bodies_[bodies[i + kPrefetchFarAhead]]);
    }
    if (i + kPrefetchAhead < bodies.size()) {
      prefetch(&boxes[bodies[i + kPrefetchAhead]]);
      prefetch(&bodies_[bodies[i + kPrefetchAhead]]);
    }
    const std::uint32_t body = bodies[i];
    const Aabb& box = boxes[body];
    const Extent extent = cells_.extentOf(box);
    std::uint32_t level = 0;
    std::uint32_t cell = kNowhere;
    if (!isEmpty(box)) {
      level = Cells::levelOf(extent);
      cell = cells_.cellOf(extent, level);
      cells_.reach(extent, level);
    }
    moves_[i] = {extent, body, level};
    bodies_[body].move(box, cell, frame_);
  }
}

/// Each batch takes one step after the other, in turns with those behind it: so what a step needs
/// comes from memory meanwhile.
void LooseGrid::search(const CollisionFilter& filter, PairBuffer& began, PairBuffer& ended) {
  const std::size_t batches = (moves_.size() + Batch::kMoves - 1) / Batch::kMoves;
  const auto under_way = [&](std::size_t batch) {
    return batch < batches ? &under_way_[batch % kSteps] : nullptr;
  };
  for (std::size_t now = 0; now < batches + kSteps - 1; ++now) {
    if (Batch* const batch = under_way(now)) takeMoves(now * Batch::kMoves, *batch);
    if (Batch* const batch = under_way(now - 1)) prepare(*batch);
    if (Batch* const batch = under_way(now - 2)) {
      if (moves_.size() >= kManyMoves) sendForLinesBehind(*batch);
      makeMoves(*batch);
    }
    // Not in the turn before: to read a line of which a part was just written takes long.
    if (Batch* const batch = under_way(now - 3)) lookIntoCells(*batch);
    if (Batch* const batch = under_way(now - 4)) tellChanges(*batch, filter, began, ended);
  }
}

/// The moves from the given one on.
void LooseGrid::takeMoves(std::size_t first, Batch& batch) {
  const std::span<const Move> moves = moves_;
  batch.moves = moves.subspan(first, std::min(Batch::kMoves, moves.size() - first));
  for (const Move& move : batch.moves) prefetch(&bodies_[move.body]);
}

/// Finds out what is to be done.
void LooseGrid::prepare(Batch& batch) const {
  batch.looks.count = 0;
  batch.search_count = 0;
  for (std::size_t i = 0; i < batch.moves.size(); ++i) {
    batch.bounds[i] = prepareMove(batch.moves[i], batch);
  }
}

/// Adds where to look for whose overlap with a body may change; returns what its bounds become.
Bounds LooseGrid::prepareMove(const Move& move, Batch& batch) const {
  const Body& body = bodies_[move.body];
  const bool was = body.cellBefore() != kNowhere;
  const bool is = body.cell() != kNowhere;
  if (!was && !is) return kNobody;
  const Extent before = cells_.extentOf(body.before);
  const Extent& now = move.to;
  // Around both places at once, unless it has moved far.
  const Steps far = 1 << Cells::kCellBits | now.edges();
  const auto is_near = [&](Steps from, Steps to) {
    return (to - from <= far) & (from - to <= far);
  };
  const bool near = isEveryAxis(is_near(before.min, now.min) & is_near(before.max, now.max));
  const Extent both = {smaller(before.min, now.min), larger(before.max, now.max)};
  // In a cell that it does not leave it is found at both places.
  const Extent& found = body.cell() == body.cellBefore() ? both : now;
  if (near) {
    lookAround({move.body, kBeginnings | kEnds}, both, batch);
  } else {
    if (was) lookAround({move.body, kEnds}, before, batch);
    if (is) lookAround({move.body, kBeginnings}, now, batch);
  }
  return cells_.boundsOf(found, now, move.level);
}

/// Adds looks into the cells where somebody may overlap the extent.
void LooseGrid::lookAround(Search search, const Extent& extent, Batch& batch) const {
  const std::size_t number = batch.search_count++;
  batch.searches[number] = search;
  for (std::uint32_t levels = cells_.usedLevels(); levels != 0; levels &= levels - 1) {
    const auto level = static_cast<std::uint32_t>(std::countr_zero(levels));
    const Cells::Level& at = cells_.level(level);
    const auto [first, last] = cells_.rangeAround(extent, level);
    // Nearly always: no more than two on each axis, all of them in the bulk.
    if (isEveryAxis((first >= at.first) & (last - at.first < at.counts) & (last - first <= 1)))
        [[likely]] {
      const Steps number_of_first = (first - at.first) * at.strides;
      const Steps is_two = last > first;
      const Extent in_first = Cells::countedFrom(first, extent, level);
      lookIntoEight(at,
                    {.at = number_of_first,
                     .next = number_of_first + (at.strides & is_two),
                     .is_two = is_two,
                     .low = in_first.min,
                     .high = in_first.max},
                    number, batch.looks);
    } else {
      lookAroundFarOff(level, extent, number, batch.looks);
    }
  }
}

void LooseGrid::lookAroundFarOff(std::uint32_t level, const Extent& extent, std::size_t search,
                                 Looks& looks) const {
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
        lookIntoEight(at,
                      {.at = number,
                       .next = is_two ? next : number,
                       .is_two = is_two,
                       .low = around.low - (offset << Cells::kCellBits),
                       .high = around.high - (offset << Cells::kCellBits)},
                      search, looks);
      }
    }
  }
}

/// Adds looks into two cells on each axis, as far as there are two. Without a branch, as nobody
/// could predict how many these are: all eight are written, each that is not wanted at the place
/// of the next one that is.
inline void LooseGrid::lookIntoEight(const Cells::Level& at, const TwoCells& cells,
                                     std::size_t search, Looks& looks) const {
  static_assert(sizeof(const Line*) == sizeof(std::uint64_t));
  const Two x = bytesOf<0>(cells) + reinterpret_cast<std::uintptr_t>(&lines_[at.first_cell]);
  const Two y = bytesOf<1>(cells);
  const Two z = bytesOf<2>(cells);
  constexpr std::int32_t kCell = 1 << Cells::kCellBits;
  const Two least = {Cells::boundsOnAxes(cells.high, cells.low),
                     Cells::boundsOnAxes(cells.high - kCell, cells.low - kCell)};
  const Two least_x = ofAxis(0, least) | Looks::withSearch(kSomebody, search);

  const std::size_t row = 1 - cells.is_two[0];
  const std::size_t layer = row << -cells.is_two[1];
  looks.makeRoom(8);
  const Line** const to_cells = looks.cells.data() + looks.count;
  Bounds* const to_least = looks.least.data() + looks.count;
  looks.count += layer << -cells.is_two[2];
  for (int k = 0; k < 2; ++k) {
    for (int j = 0; j < 2; ++j) {
      const std::size_t to = (k != 0 ? layer : 0) + (j != 0 ? row : 0);
      const Two lines = x + twice(y[j]) + twice(z[k]);
      const Two bounds = least_x | ofAxis(1, twice(least[j])) | ofAxis(2, twice(least[k]));
      std::memcpy(to_cells + to, &lines, sizeof(lines));
      std::memcpy(to_least + to, &bounds, sizeof(bounds));
      for (int i = 0; i < 2; ++i) prefetchFar(std::bit_cast<const Line*>(lines[i]));
    }
  }
}

/// Only in crowded cells there are lines that nobody knows of before another one has come.
void LooseGrid::sendForLinesBehind(const Batch& batch) const {
  for (std::size_t i = 0; i < batch.looks.count; ++i) {
    const Line* const cell = batch.looks.cells[i];
    prefetchFar(cell->next == kNowhere ? cell : &lines_[cell->next]);
  }
}

/// Puts bodies into their cells.
void LooseGrid::makeMoves(const Batch& batch) {
  for (std::size_t i = 0; i < batch.moves.size(); ++i) {
    const std::uint32_t index = batch.moves[i].body;
    const Body& body = bodies_[index];
    if (body.cell() == body.cellBefore()) {
      if (body.cell() == kNowhere) continue;
      lines_.setBounds(body.cell(), index, batch.bounds[i]);
      continue;
    }
    ++work_.cell_changes;
    if (body.cellBefore() != kNowhere) left_.push_back({index, body.cellBefore()});
    if (body.cell() != kNowhere) lines_.insert(body.cell(), index, batch.bounds[i]);
  }
}

/// Lists who else is there, in these cells, and reaches what was wanted: first those in the cells'
/// own lines, then in the lines behind them, and so on.
void LooseGrid::lookIntoCells(Batch& batch) {
  Looks& looks = batch.looks;
  std::size_t hits = 0;
  for (std::size_t first = 0; first < looks.count;) {
    const std::size_t count = looks.count - first;
    looks.makeRoom(count);
    hits_.resize(hits + count);
    followed_.resize(count);
    lines_behind_.resize(count);
    const Line* const* const lines = first == 0 ? looks.cells.data() : lines_behind_.data();
    const Kernels::Found found =
        kernels_->look(lines, looks.least.data() + first, count, static_cast<std::uint32_t>(first),
                       hits_.data() + hits, followed_.data());
    hits += found.hits;
    for (std::size_t i = 0; i < found.followed; ++i) {
      const std::uint32_t look = followed_[i];
      lines_behind_[i] = &lines_[lines[look - first]->next];
      looks.cells[looks.count] = looks.cells[look];
      looks.least[looks.count++] = looks.least[look];
    }
    first += count;
  }
  work_.lines += looks.count;
  addCandidates(batch, hits);
}

/// All but the bodies that are looking. In a line there are seldom more than two, and nobody could
/// predict whether there are.
void LooseGrid::addCandidates(Batch& batch, std::size_t hits) const {
  batch.candidates.resize(hits * Line::kPlaces + 1);  // the last one is written, and not kept
  Candidate* end = batch.candidates.data();
  for (std::size_t i = 0; i < hits; ++i) {
    const Hit& hit = hits_[i];
    const Line* const cell = batch.looks.cells[hit.look];
    const std::uint32_t search = batch.looks.searchOf(hit.look);
    const std::uint32_t body = batch.searches[search].body;
    std::uint32_t places = hit.places;
    const auto add = [&] {
      // Where nobody is left the first one is looked at again, and not kept.
      const std::uint32_t any = places | (hit.places & (0U - unsigned{places == 0}));
      const std::uint32_t other = hit.line->bodies[std::countr_zero(any)];
      prefetchFar(&bodies_[other]);
      *end = {cell, other, search};
      end += unsigned{places != 0} & unsigned{other != body};
      places &= places - 1;
    };
    add();
    add();
    while (places != 0) [[unlikely]] add();
  }
  batch.candidates.resize(static_cast<std::size_t>(end - batch.candidates.data()));
}

/// Two bodies that both move are a pair of the one that search() comes to last: the higher number.
std::uint32_t LooseGrid::change(const Search& search, const Candidate& candidate) const {
  const Body& body = bodies_[search.body];
  const Body& other = bodies_[candidate.other];
  const Aabb* before = &other.box;
  std::uint32_t wanted = search.wanted;
  if (other.frame() == frame_) [[unlikely]] {
    if (candidate.other > search.body) return 0;
    before = &other.before;
    // A cell that it left tells of ends only, one into which it came of beginnings only.
    if (other.cellBefore() != other.cell()) {
      wanted &= lines_.numberOf(candidate.cell) == other.cell() ? kBeginnings : kEnds;
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
    const Search& search = batch.searches[candidate.search];
    std::uint32_t changed = change(search, candidate);
    if (!wants_all && changed != 0 && !filter.wanted(search.body, candidate.other)) changed = 0;
    const Pair pair = orderedPair(search.body, candidate.other);
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
    if (i + kPrefetchAhead < left_.size()) prefetch(&lines_[left_[i + kPrefetchAhead].cell]);
    lines_.remove(left_[i].cell, left_[i].body);
  }
  left_.clear();
  moves_.resize(0);
  ++frame_;
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
  constexpr Rgb kCellColour = 0x3FA7A0;
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
    draw.cell(box, kCellColour, cell[3], population);
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
    const Bounds bounds = cells_.boundsOf(extent, extent, Cells::levelOf(extent)) & ~kNobody;
    bool is_there = false;
    for (std::uint32_t line = of.cell(); line != kNowhere; line = lines_[line].next) {
      for (std::uint32_t place = 0; place < lines_[line].count(); ++place) {
        is_there |=
            lines_[line].bodies[place] == body && reaches(lines_[line].bounds[place], bounds);
      }
    }
    if (!is_there) return fmt::format("body {} is not in its cell", body);
  }
  return lines_.validate(present);
}

}  // namespace broadmark::tide
