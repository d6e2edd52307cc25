// Tracy: a uniform grid with an incremental sweep and prune in every cell. A body that does not
// move costs at most the test of a bit. The endpoints of a moved body are re-sorted by insertion
// sort; each swap of a start with an end is an event at which a pair may begin or end. Pairs are
// retained between frames. The grid separates what no incremental sweep can: bodies that overlap on
// one or two axes only.
//
// A frame: find the moved bodies and the cells that they touch; notify these cells; let each cell
// find the pairs that began or ended in it (tracy/cell.h proves that each change is reported once,
// so pairs need no reference counts); apply these to the pair set. Each step is parallel: over
// bodies, then cells, then pairs by their lower body. Workers share neither cells nor parts of the
// set.
//
// The same changes are the events. A rebuild finds all pairs: then they are compared with the
// previous pairs.
//
// O(n + s) per frame, s swaps: per moved body about the distance times the endpoints per unit of
// length in a cell. Many bodies that each touch many cells would make the lists as long as the
// product of both. When the mean body touches more than kMaxCellsPerBody cells, the grid is rebuilt
// with half the cells per axis, or fewer; later, when they would fit, with more.
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

/// Mean over all bodies; evenly spread small bodies touch 1 to 3 cells.
constexpr std::uint64_t kMaxCellsPerBody = 8;
constexpr double kMaxCellsPerAxis = 1024;
/// Above this ratio of bodies to moved bodies, cells look up each moved body; below, a scan of all
/// bodies in the cell is faster.
constexpr std::size_t kMinBodiesPerMover = 64;

struct alignas(64) Worker {
  CellWork work;
  Mailbox mailbox;
  std::vector<std::uint32_t> moved;  ///< in this frame, of the worker's share
  std::uint64_t cells_touched = 0;   ///< by the worker's share
};

CellRange cellsOf(const CellGrid& grid, const Aabb& box) {
  if (isEmpty(box)) return {.first = {1, 1, 1, 0}, .last = {0, 0, 0, 0}};
  return grid.touched(box);
}

/// Directly on BroadPhase: the pair set is retained between frames.
class Tracy final : public BroadPhase {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"objects_per_cell", "target number of bodies per grid cell, for evenly spread bodies",
           &objects_per_cell_, 1, 1e9});
  }

  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
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
    if (reports_events_) previous_pairs_.resize(team_size);
    pair_runs_.reserve(team_size);

    states_.boxes[kBefore].assign(first.boxes.begin(), first.boxes.end());
    states_.boxes[kNow] = states_.boxes[kBefore];
    states_.filter = scene.filter;
    for (std::vector<CellRange>& ranges : states_.ranges) ranges.resize(count);
    states_.moved.assign((count + kWordBits - 1) / kWordBits, 0);

    const double cells =
        std::ceil(std::cbrt(static_cast<double>(count) / static_cast<double>(objects_per_cell_)));
    target_cells_ = static_cast<std::int32_t>(std::clamp(cells, 1.0, kMaxCellsPerAxis));
    rebuild(coarsenToFit(target_cells_));
    searchOverlaps();
    if (!reports_events_) cleanCache();
  }

  void reportEvents() override { reports_events_ = true; }

  void updateObjects(const Frame& frame) override {
    team_->run(states_.moved.size(), [&](int worker, Range words) {
      std::vector<std::uint32_t>& moved = workerOf(worker).moved;
      for (const std::uint32_t body : moved) states_.moved[body / kWordBits] = 0;
      // Shares are whole words of bits, so workers write to different words.
      const std::span<const std::uint32_t> changed = *frame.changed;
      moved.assign(std::ranges::lower_bound(changed, words.begin * kWordBits),
                   std::ranges::lower_bound(changed, words.end * kWordBits));
      for (const std::uint32_t body : moved) applyBox(body, frame.boxes[body]);
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
    states_.few_moved = kMinBodiesPerMover * moved < states_.boxes[kNow].size();
    team_->run([this](int worker) { findCells(worker); });
    if (const std::int32_t cells = chooseCellsPerAxis(); cells != grid_.counts()[0]) {
      rebuild(cells);
      return;
    }
    team_->run([this](int worker) { notifyCells(worker); });
    balanceCells();
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
      if (reports_events_ && rebuilds_ > 0) diffWithPrevious(part);
    });
    pair_runs_.clear();
    for (const PairSet& pairs : pairs_) pair_runs_.push_back(pairs.run());
    if (reports_events_) collectEventRuns();
  }

  [[nodiscard]] PairRuns overlaps() const override { return pair_runs_; }
  [[nodiscard]] PairEvents events() const override { return {begun_runs_, ended_runs_}; }

  void drawStructure(DebugDraw& draw) const override;
  void visitCounters(const CounterVisitor& visit) const override;
  [[nodiscard]] std::string validate() const override;

 private:
  static constexpr std::size_t kWordBits = 64;

  Worker& workerOf(int worker) { return workers_[static_cast<std::size_t>(worker)]; }

  void applyBox(std::uint32_t body, const Aabb& box) {
    states_.boxes[kBefore][body] = std::exchange(states_.boxes[kNow][body], box);
    states_.moved[body / kWordBits] |= std::uint64_t{1} << body % kWordBits;
  }

  void findCells(int worker) {
    std::uint64_t& touched = workerOf(worker).cells_touched;
    for (const std::uint32_t body : workerOf(worker).moved) {
      CellRange& now = states_.ranges[kNow][body];
      states_.ranges[kBefore][body] = std::exchange(now, cellsOf(grid_, states_.boxes[kNow][body]));
      touched += now.count();
      touched -= states_.ranges[kBefore][body].count();
    }
  }

  void notifyCells(int worker) {
    Mailbox& mailbox = workerOf(worker).mailbox;
    for (const std::uint32_t body : workerOf(worker).moved) {
      const CellRange& before = states_.ranges[kBefore][body];
      const CellRange& now = states_.ranges[kNow][body];
      grid_.forEachCell(before, [&](std::size_t cell, CellBody) {
        if (states_.few_moved) {
          mailbox.notify(cell, body);
        } else {
          mailbox.notify(cell);
        }
      });
      if (now == before) continue;
      grid_.forEachCell(now, [&](std::size_t cell, CellBody) {
        if (!before.contains(grid_.position(cell))) mailbox.notifyArrival(cell, body);
      });
    }
  }

  void balanceCells() {
    dirty_cells_.clear();
    for (const Worker& worker : workers_) {
      std::ranges::copy(worker.mailbox.cells(), std::back_inserter(dirty_cells_));
    }
    std::ranges::sort(dirty_cells_);
    const auto duplicates = std::ranges::unique(dirty_cells_);
    dirty_cells_.erase(duplicates.begin(), duplicates.end());
    // A moved body passes a constant fraction of the bodies in its cell.
    const auto cost = [&](std::size_t i) {
      const std::uint64_t size = cells_[dirty_cells_[i]].size();
      return 1 + size * (64 + size);
    };
    shares_.measure(dirty_cells_.size(), 1, cost, *team_);
  }

  void updateCells(int worker) {
    const Range mine = shares_.of(worker);
    for (std::size_t i = mine.begin; i < mine.end; ++i) {
      const std::uint32_t cell = dirty_cells_[i];
      CellWork& work = workerOf(worker).work;
      work.moved.clear();
      for (const Worker& from : workers_) {
        from.mailbox.moved().forEach(cell, [&](std::uint32_t body) { work.moved.push_back(body); });
      }
      cells_[cell].update(states_, work, [&](auto enter) {
        for (const Worker& from : workers_) from.mailbox.arrivals().forEach(cell, enter);
      });
      for (Worker& from : workers_) from.mailbox.erase(cell);
    }
  }

  /// Summed over all bodies.
  std::uint64_t cellsTouchedIn(const CellGrid& grid) {
    std::atomic<std::uint64_t> total = 0;
    team_->run(states_.boxes[kNow].size(), [&](int, Range part) {
      std::uint64_t touched = 0;
      for (std::size_t i = part.begin; i < part.end; ++i)
        touched += cellsOf(grid, states_.boxes[kNow][i]).count();
      total += touched;
    });
    return total;
  }

  [[nodiscard]] std::uint64_t maxCellsTouched() const {
    return kMaxCellsPerBody * states_.boxes[kNow].size();
  }

  /// Halves the number of cells until the bodies do not touch too many of them.
  std::int32_t coarsenToFit(std::int32_t cells_per_axis) {
    while (cells_per_axis > 1 &&
           cellsTouchedIn(CellGrid(world_, cells_per_axis)) > maxCellsTouched()) {
      cells_per_axis /= 2;
    }
    return cells_per_axis;
  }

  std::int32_t chooseCellsPerAxis() {
    const std::int32_t current = grid_.counts()[0];
    std::uint64_t touched = 0;
    for (const Worker& worker : workers_) touched += worker.cells_touched;
    if (touched > maxCellsTouched()) return coarsenToFit(current / 2);
    if (current == target_cells_) return current;
    // Hysteresis: refine only well below the limit.
    const std::int32_t finer = std::min(2 * current + 1, target_cells_);
    return 2 * cellsTouchedIn(CellGrid(world_, finer)) <= maxCellsTouched() ? finer : current;
  }

  /// After a rebuild, which reports all pairs as begun.
  void diffWithPrevious(std::size_t part) {
    const PairSet& before = previous_pairs_[part];
    for (Worker& worker : workers_) {
      worker.work.begun[part].retain([&](Pair pair) { return !before.contains(pair); });
    }
    for (const Pair pair : before.run()) {
      if (!pairs_[part].contains(pair)) workers_.front().work.ended[part].add(pair.a, pair.b);
    }
  }

  void collectEventRuns() {
    begun_runs_.clear();
    ended_runs_.clear();
    for (const Worker& worker : workers_) {
      for (const PairBuffer& pairs : worker.work.begun) begun_runs_.push_back(pairs.run());
      for (const PairBuffer& pairs : worker.work.ended) ended_runs_.push_back(pairs.run());
    }
  }

  /// From scratch, with another grid; all pairs are reported as begun.
  void rebuild(std::int32_t cells_per_axis) {
    ++rebuilds_;
    if (reports_events_) pairs_.swap(previous_pairs_);
    grid_ = CellGrid(world_, cells_per_axis);
    cells_.clear();
    cells_.resize(grid_.size());
    dirty_cells_.reserve(workers_.size() * cells_.size());
    for (Worker& worker : workers_) {
      worker.mailbox.resize(cells_.size());
      worker.cells_touched = 0;
    }
    for (PairSet& pairs : pairs_) pairs.clear();

    // Counting sort of the bodies by cell.
    std::vector<std::size_t> ends(cells_.size() + 1, 0);
    for (std::size_t body = 0; body < states_.boxes[kNow].size(); ++body) {
      CellRange& range = states_.ranges[kNow][body];
      range = cellsOf(grid_, states_.boxes[kNow][body]);
      states_.ranges[kBefore][body] = range;
      grid_.forEachCell(range, [&](std::size_t cell, CellBody) { ++ends[cell]; });
      workers_.front().cells_touched += range.count();
    }
    std::inclusive_scan(ends.begin(), ends.end(), ends.begin());
    std::vector<std::uint32_t> bodies(ends.back());
    for (auto body = static_cast<std::uint32_t>(states_.boxes[kNow].size()); body-- > 0;) {
      grid_.forEachCell(states_.ranges[kNow][body],
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
        cells_[cell].build(grid_.position(cell), bodies_in(cell), states_, workerOf(worker).work);
      }
    });
  }

  /// Half of the paper's 200: as fast if all bodies move, and faster if few do.
  std::int64_t objects_per_cell_ = 100;
  ThreadTeam* team_ = nullptr;
  Aabb world_;
  std::int32_t target_cells_ = 1;  ///< per axis, unless bodies touch too many
  CellGrid grid_;
  BodyStates states_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> dirty_cells_;  ///< cells with messages
  WorkShares shares_;
  std::vector<Worker> workers_;
  std::vector<PairSet> pairs_;  ///< one per worker, by the lower body
  std::vector<PairRun> pair_runs_;
  std::uint64_t rebuilds_ = 0;
  bool reports_events_ = false;
  // For events.
  std::vector<PairSet> previous_pairs_;  ///< before the last rebuild
  std::vector<PairRun> begun_runs_;
  std::vector<PairRun> ended_runs_;
};

/// Level 0: the occupied cells; level 1: the chunks of their first axis.
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
  WorkCounts total;
  std::uint64_t begun = 0;
  std::uint64_t ended = 0;
  for (const Worker& worker : workers_) {
    const WorkCounts& counts = worker.work.counts;
    total.moves += counts.moves;
    total.swaps += counts.swaps;
    total.cell_changes += counts.cell_changes;
    total.jumps += counts.jumps;
    for (const PairBuffer& pairs : worker.work.begun) begun += pairs.size();
    for (const PairBuffer& pairs : worker.work.ended) ended += pairs.size();
  }
  visit("moves", total.moves);
  visit("swaps", total.swaps);
  visit("cell changes", total.cell_changes);
  visit("jumps", total.jumps);
  visit("pairs begun", begun);
  visit("pairs ended", ended);
  visit("grid rebuilds", rebuilds_);
}

std::string Tracy::validate() const {
  std::vector<std::uint64_t> cells_of_body(states_.boxes[kNow].size(), 0);
  std::vector<std::size_t> last_cell(cells_of_body.size(), cells_.size());
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    if (std::string fault = cells_[cell].validate(states_); !fault.empty()) return fault;
    bool is_duplicate = false;
    cells_[cell].forEachBody([&](std::uint32_t body) {
      is_duplicate = is_duplicate || std::exchange(last_cell[body], cell) == cell;
      ++cells_of_body[body];
    });
    if (is_duplicate) return "a body is in a cell twice";
    for (const Worker& worker : workers_) {
      if (worker.mailbox.hasMessages(cell)) return "a message is unread";
    }
  }
  std::uint64_t touched = 0;
  for (const Worker& worker : workers_) touched += worker.cells_touched;
  for (std::size_t body = 0; body < cells_of_body.size(); ++body) {
    const CellRange range = cellsOf(grid_, states_.boxes[kNow][body]);
    if (states_.ranges[kNow][body] != range) return "the cells of a body are out of date";
    if (cells_of_body[body] != range.count()) return "a body is missing in a cell that it touches";
    touched -= range.count();
  }
  if (touched != 0) return "the number of touched cells is wrong";
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
  return {variantOf<Tracy>(family, "tracy", "incremental sweep and prune in each cell of a grid"),
          variantOf<Tracy>(family, "tracy-mt",
                           "incremental sweep and prune in a grid, on several threads",
                           {.parallel = true})};
}

}  // namespace broadmark::tracy
