// Tracy: a uniform grid whose every cell is an incremental sweep and prune. A body that stays where
// it is costs at most a look at a bit; what moves is sorted anew, from its last place to the new
// one, and each swap of a start and an end is an event at which a pair may begin or end. Pairs are
// kept from frame to frame. O(n + s), s the swaps: for each moved body about the distance times the
// endpoints per unit of length in a cell. The grid does what no incremental sweep can: keep apart
// bodies that overlap on one or two axes only.
//
// A frame: find the bodies that have moved and the cells that they touch now; notify these cells;
// let each of them find the pairs that began and ended in it (tracy/cell.h, with the proof that
// each change is reported once, so that nothing has to be counted); apply these to the pair set.
// All of it is shared out: first bodies, then cells, then pairs by their lower body. No two workers
// touch the same cell or the same part of the set.
//
// These changes are the events, too. A grid that is built anew finds all pairs: then they are
// compared with those that were there.
//
// If many bodies each touched very many cells, the cells' lists would be as long as the product of
// both. When the average body touches more than kMostCellsPerBody cells, the grid is rebuilt with
// half the cells per axis, or fewer; later, when they would fit, with more.
//
// Paper: D. J. Tracy, S. R. Buss, B. M. Woods, "Efficient Large-Scale Sweep and Prune Methods with
// AABB Insertion and Removal", IEEE VR 2009.

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/pair_set.h"
#include "tracy/cell.h"
#include "tracy/mailbox.h"
#include "variants.h"
#include "work_shares.h"

namespace broadmark::tracy {
namespace {

/// On average; evenly spread small bodies touch 1 to 3.
constexpr std::uint64_t kMostCellsPerBody = 8;
constexpr double kMostCellsPerAxis = 1024;
/// When fewer bodies than one of so many have moved, each is looked up in its cells; otherwise it
/// takes less to look at all bodies of these cells.
constexpr std::size_t kFew = 64;

struct alignas(64) Worker {
  CellWork work;
  Mailbox mailbox;
  std::vector<std::uint32_t> moved;  ///< in this frame, of the worker's share of the bodies
  std::uint64_t cells_touched = 0;   ///< by the worker's share of the bodies
};

/// The cells that a box touches, none if it is empty.
CellRange cellsOf(const CellGrid& grid, const Aabb& box) {
  if (isEmpty(box)) return {.first = {1, 1, 1, 0}, .last = {0, 0, 0, 0}};
  return grid.touched(box);
}

/// Directly on BroadPhase: the pairs are a set that is kept from frame to frame.
class Tracy final : public BroadPhase {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"objects_per_cell", "bodies per grid cell, were they evenly spread", &objects_per_cell_,
           1, 1e9});
  }

  void initialize(const SceneInfo& scene, const Frame& first, Execution& execution) override {
    team_ = &execution.team();
    world_ = scene.world;
    const std::size_t count = first.boxes.size();
    const auto team_size = static_cast<std::size_t>(team_->size());
    workers_ = std::vector<Worker>(team_size);
    for (Worker& worker : workers_) {
      worker.work.begun = std::vector<PairBuffer>(team_size);
      worker.work.ended = std::vector<PairBuffer>(team_size);
      worker.moved.reserve(count / team_size + 2 * kWordBits);
    }
    pairs_.resize(team_size);
    if (reports_events_) pairs_before_.resize(team_size);
    runs_.reserve(team_size);

    bodies_.boxes[kBefore].assign(first.boxes.begin(), first.boxes.end());
    bodies_.boxes[kNow] = bodies_.boxes[kBefore];
    bodies_.filter = scene.filter;
    for (std::vector<CellRange>& ranges : bodies_.ranges) ranges.resize(count);
    bodies_.moved.assign((count + kWordBits - 1) / kWordBits, 0);

    const double wanted =
        std::ceil(std::cbrt(static_cast<double>(count) / static_cast<double>(objects_per_cell_)));
    wanted_cells_ = static_cast<std::int32_t>(std::clamp(wanted, 1.0, kMostCellsPerAxis));
    rebuild(affordable(wanted_cells_));
    searchOverlaps();
    if (!reports_events_) cleanCache();
  }

  void reportEvents() override { reports_events_ = true; }

  void updateObjects(const Frame& frame) override {
    team_->run(bodies_.moved.size(), [&](int worker, Range words) {
      std::vector<std::uint32_t>& moved = workerOf(worker).moved;
      for (const std::uint32_t body : moved) bodies_.moved[body / kWordBits] = 0;
      // Whole words of bits: no two workers write to the same.
      const std::span<const std::uint32_t> changed = *frame.changed;
      moved.assign(std::ranges::lower_bound(changed, words.begin * kWordBits),
                   std::ranges::lower_bound(changed, words.end * kWordBits));
      for (const std::uint32_t body : moved) takeOver(body, frame.boxes[body]);
    });
  }

  void cleanCache() override {
    for (Worker& worker : workers_) {
      for (PairBuffer& pairs : worker.work.begun) pairs.clear();
      for (PairBuffer& pairs : worker.work.ended) pairs.clear();
      worker.work.counts = {};
      worker.mailbox.clear();
    }
    rebuilds_ = 0;
  }

  void updateStructures() override {
    std::size_t moved = 0;
    for (const Worker& worker : workers_) moved += worker.moved.size();
    if (moved == 0) return;
    bodies_.few_moved = kFew * moved < bodies_.boxes[kNow].size();
    team_->run([this](int worker) { findCells(worker); });
    if (const std::int32_t cells = suitableCellsPerAxis(); cells != grid_.counts()[0]) {
      rebuild(cells);
      return;
    }
    team_->run([this](int worker) { tellCells(worker); });
    shareOutCells();
    team_->run([this](int worker) { updateCells(worker); });
  }

  void searchOverlaps() override {
    team_->run([this](int worker) {
      const auto part = static_cast<std::size_t>(worker);
      PairSet& pairs = pairs_[part];
      for (const Worker& from : workers_) {
        pairs.erase(from.work.ended[part].run());
      }
      for (const Worker& from : workers_) {
        pairs.insert(from.work.begun[part].run());
      }
      if (reports_events_ && rebuilds_ > 0) compareWithBefore(part);
    });
    runs_.clear();
    for (const PairSet& pairs : pairs_) runs_.push_back(pairs.run());
    if (reports_events_) gatherEvents();
  }

  [[nodiscard]] PairRuns overlaps() const override { return runs_; }
  [[nodiscard]] PairEvents events() const override { return {begun_runs_, ended_runs_}; }

  void drawStructure(DebugDraw& draw) const override;
  void visitCounters(const CounterVisitor& visit) const override;
  [[nodiscard]] std::string validate() const override;

 private:
  static constexpr std::size_t kWordBits = 64;

  Worker& workerOf(int worker) { return workers_[static_cast<std::size_t>(worker)]; }

  void takeOver(std::uint32_t body, const Aabb& box) {
    bodies_.boxes[kBefore][body] = std::exchange(bodies_.boxes[kNow][body], box);
    bodies_.moved[body / kWordBits] |= std::uint64_t{1} << body % kWordBits;
  }

  void findCells(int worker) {
    std::uint64_t& touched = workerOf(worker).cells_touched;
    for (const std::uint32_t body : workerOf(worker).moved) {
      CellRange& now = bodies_.ranges[kNow][body];
      bodies_.ranges[kBefore][body] = std::exchange(now, cellsOf(grid_, bodies_.boxes[kNow][body]));
      touched += now.count();
      touched -= bodies_.ranges[kBefore][body].count();
    }
  }

  /// The merge of a body's old cells and its new ones.
  void tellCells(int worker) {
    Mailbox& mailbox = workerOf(worker).mailbox;
    for (const std::uint32_t body : workerOf(worker).moved) {
      const CellRange& before = bodies_.ranges[kBefore][body];
      const CellRange& now = bodies_.ranges[kNow][body];
      grid_.forEachCell(before, [&](std::size_t cell, CellBody) {
        if (bodies_.few_moved) {
          mailbox.notify(cell, body);
        } else {
          mailbox.notify(cell);
        }
      });
      if (now == before) continue;
      grid_.forEachCell(now, [&](std::size_t cell, CellBody) {
        if (!before.contains(grid_.position(cell))) mailbox.announce(cell, body);
      });
    }
  }

  /// Of the cells that have messages.
  void shareOutCells() {
    concerned_.clear();
    for (const Worker& worker : workers_) {
      std::ranges::copy(worker.mailbox.cells(), std::back_inserter(concerned_));
    }
    std::ranges::sort(concerned_);
    const auto twice = std::ranges::unique(concerned_);
    concerned_.erase(twice.begin(), twice.end());
    // A body that moves passes a fixed part of those in its cell.
    const auto cost = [&](std::size_t i) {
      const std::uint64_t size = cells_[concerned_[i]].size();
      return 1 + size * (64 + size);
    };
    shares_.measure(concerned_.size(), 1, cost, *team_);
  }

  void updateCells(int worker) {
    const Range mine = shares_.of(worker);
    for (std::size_t i = mine.begin; i < mine.end; ++i) {
      const std::uint32_t cell = concerned_[i];
      CellWork& work = workerOf(worker).work;
      work.moved.clear();
      for (const Worker& from : workers_) {
        from.mailbox.moved().forEach(cell, [&](std::uint32_t body) { work.moved.push_back(body); });
      }
      cells_[cell].update(bodies_, work, [&](auto enter) {
        for (const Worker& from : workers_) from.mailbox.arrivals().forEach(cell, enter);
      });
      for (Worker& from : workers_) from.mailbox.forget(cell);
    }
  }

  /// Cells that all bodies touch, counted as often as they are touched, on a grid of another size.
  std::uint64_t cellsTouchedIn(const CellGrid& grid) {
    std::atomic<std::uint64_t> all = 0;
    team_->run(bodies_.boxes[kNow].size(), [&](int, Range part) {
      std::uint64_t touched = 0;
      for (std::size_t i = part.begin; i < part.end; ++i)
        touched += cellsOf(grid, bodies_.boxes[kNow][i]).count();
      all += touched;
    });
    return all;
  }

  [[nodiscard]] std::uint64_t mostCellsTouched() const {
    return kMostCellsPerBody * bodies_.boxes[kNow].size();
  }

  /// `cells_per_axis`, or as often halved as it takes.
  std::int32_t affordable(std::int32_t cells_per_axis) {
    while (cells_per_axis > 1 &&
           cellsTouchedIn(CellGrid(world_, cells_per_axis)) > mostCellsTouched()) {
      cells_per_axis /= 2;
    }
    return cells_per_axis;
  }

  std::int32_t suitableCellsPerAxis() {
    const std::int32_t present = grid_.counts()[0];
    std::uint64_t touched = 0;
    for (const Worker& worker : workers_) touched += worker.cells_touched;
    if (touched > mostCellsTouched()) return affordable(present / 2);
    if (present == wanted_cells_) return present;
    // Well below the limit, or the next frame might be above it again.
    const std::int32_t more = std::min(2 * present + 1, wanted_cells_);
    return 2 * cellsTouchedIn(CellGrid(world_, more)) <= mostCellsTouched() ? more : present;
  }

  /// All pairs have begun anew: leaves those that did, and adds those that ended.
  void compareWithBefore(std::size_t part) {
    const PairSet& before = pairs_before_[part];
    for (Worker& worker : workers_) {
      worker.work.begun[part].retain([&](Pair pair) { return !before.contains(pair); });
    }
    for (const Pair pair : before.run()) {
      if (!pairs_[part].contains(pair)) workers_.front().work.ended[part].add(pair.a, pair.b);
    }
  }

  void gatherEvents() {
    begun_runs_.clear();
    ended_runs_.clear();
    for (const Worker& worker : workers_) {
      for (const PairBuffer& pairs : worker.work.begun) begun_runs_.push_back(pairs.run());
      for (const PairBuffer& pairs : worker.work.ended) ended_runs_.push_back(pairs.run());
    }
  }

  /// Starts over with another grid; all pairs are found anew.
  void rebuild(std::int32_t cells_per_axis) {
    ++rebuilds_;
    if (reports_events_) pairs_.swap(pairs_before_);
    grid_ = CellGrid(world_, cells_per_axis);
    cells_.clear();
    cells_.resize(grid_.size());
    concerned_.reserve(workers_.size() * cells_.size());
    for (Worker& worker : workers_) {
      worker.mailbox.resize(cells_.size());
      worker.cells_touched = 0;
    }
    for (PairSet& pairs : pairs_) pairs.clear();

    // Bodies by cell: counted, then filled in from the back.
    std::vector<std::size_t> ends(cells_.size() + 1, 0);
    for (std::size_t body = 0; body < bodies_.boxes[kNow].size(); ++body) {
      CellRange& range = bodies_.ranges[kNow][body];
      range = cellsOf(grid_, bodies_.boxes[kNow][body]);
      bodies_.ranges[kBefore][body] = range;
      grid_.forEachCell(range, [&](std::size_t cell, CellBody) { ++ends[cell]; });
      workers_.front().cells_touched += range.count();
    }
    std::inclusive_scan(ends.begin(), ends.end(), ends.begin());
    std::vector<std::uint32_t> bodies(ends.back());
    for (auto body = static_cast<std::uint32_t>(bodies_.boxes[kNow].size()); body-- > 0;) {
      grid_.forEachCell(bodies_.ranges[kNow][body],
                        [&](std::size_t cell, CellBody) { bodies[--ends[cell]] = body; });
    }
    const auto bodies_in = [&](std::size_t cell) {
      return std::span(bodies).subspan(ends[cell], ends[cell + 1] - ends[cell]);
    };
    shares_.measure(
        cells_.size(), 1, [&](std::size_t cell) { return 1 + bodies_in(cell).size(); }, *team_);
    team_->run([&](int worker) {
      const Range mine = shares_.of(worker);
      for (std::size_t cell = mine.begin; cell < mine.end; ++cell) {
        cells_[cell].build(grid_.position(cell), bodies_in(cell), bodies_, workerOf(worker).work);
      }
    });
  }

  /// Half of the original's 200: as fast where all bodies move, and faster where few do.
  std::int64_t objects_per_cell_ = 100;
  ThreadTeam* team_ = nullptr;
  Aabb world_;
  std::int32_t wanted_cells_ = 1;  ///< per axis, bodies permitting
  CellGrid grid_;
  Bodies bodies_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> concerned_;  ///< in this frame: cells in which something has moved
  WorkShares shares_;
  std::vector<Worker> workers_;
  std::vector<PairSet> pairs_;  ///< one per worker, by the lower body
  std::vector<PairRun> runs_;
  std::uint64_t rebuilds_ = 0;
  bool reports_events_ = false;
  // Of events only.
  std::vector<PairSet> pairs_before_;  ///< the last rebuild
  std::vector<PairRun> begun_runs_;
  std::vector<PairRun> ended_runs_;
};

/// Level 0: the occupied cells; level 1: how the first axis is cut into chunks in each of them.
void Tracy::drawStructure(DebugDraw& draw) const {
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    if (cells_[cell].size() == 0) continue;
    const Aabb bounds = grid_.cell(cell, world_);
    draw.cell(bounds, 0, cells_[cell].size());
    Aabb segment = bounds;
    cells_[cell].forEachSegment([&](float begin) {
      segment.max[0] = std::clamp(begin, bounds.min[0], bounds.max[0]);
      if (segment.max[0] > segment.min[0]) draw.box(segment, StructureRole::cell_part, 1);
      segment.min[0] = segment.max[0];
    });
    segment.max[0] = bounds.max[0];
    draw.box(segment, StructureRole::cell_part, 1);
  }
}

void Tracy::visitCounters(const CounterVisitor& visit) const {
  WorkCounts all;
  std::uint64_t begun = 0;
  std::uint64_t ended = 0;
  for (const Worker& worker : workers_) {
    const WorkCounts& counts = worker.work.counts;
    all.moves += counts.moves;
    all.swaps += counts.swaps;
    all.cell_changes += counts.cell_changes;
    all.jumps += counts.jumps;
    for (const PairBuffer& pairs : worker.work.begun) begun += pairs.size();
    for (const PairBuffer& pairs : worker.work.ended) ended += pairs.size();
  }
  visit("moves", all.moves);
  visit("swaps", all.swaps);
  visit("cell changes", all.cell_changes);
  visit("jumps", all.jumps);
  visit("pairs begun", begun);
  visit("pairs ended", ended);
  visit("grid rebuilds", rebuilds_);
}

std::string Tracy::validate() const {
  std::vector<std::uint64_t> cells_of_body(bodies_.boxes[kNow].size(), 0);
  std::vector<std::size_t> last_cell(cells_of_body.size(), cells_.size());
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    if (std::string fault = cells_[cell].validate(bodies_); !fault.empty()) return fault;
    bool twice = false;
    cells_[cell].forEachBody([&](std::uint32_t body) {
      twice = twice || std::exchange(last_cell[body], cell) == cell;
      ++cells_of_body[body];
    });
    if (twice) return "body twice in a cell";
    for (const Worker& worker : workers_) {
      if (worker.mailbox.concerns(cell)) return "messages left unread";
    }
  }
  std::uint64_t touched = 0;
  for (const Worker& worker : workers_) touched += worker.cells_touched;
  for (std::size_t body = 0; body < cells_of_body.size(); ++body) {
    const CellRange range = cellsOf(grid_, bodies_.boxes[kNow][body]);
    if (bodies_.ranges[kNow][body] != range) return "cells of a body out of date";
    if (cells_of_body[body] != range.count()) return "body missing from a cell that it touches";
    touched -= range.count();
  }
  if (touched != 0) return "cells miscounted";
  return {};
}

}  // namespace

std::vector<Algorithm> variants() {
  const Algorithm family = {.family = "Tracy",
                            .traits = {.incremental = true,
                                       .events = true,
                                       .changing_worlds = ChangingWorlds::native,
                                       .instance_per_world = true},
                            .description = {.principle = "grid, sorting",
                                            .optimisations = "segmented interval lists",
                                            .time = "O(n + s), s swaps of endpoints",
                                            .space = "O(n + k)",
                                            .source = "Tracy, Buss and Woods 2009"}};
  return {variantOf<Tracy>(family, "tracy", "incremental sweep and prune in the cells of a grid"),
          variantOf<Tracy>(family, "tracy-mt",
                           "incremental sweep and prune in a grid, on several threads",
                           {.parallel = true})};
}

}  // namespace broadmark::tracy
