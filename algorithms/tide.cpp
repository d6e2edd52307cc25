// Tide: an incremental broad phase. The cost of a frame grows with the number of moving bodies.
//
//                   few bodies move: loose grid                 many bodies move: full search
//   updateObjects   moveBodies: new box -> Body, MoveQuery      columns, in which all bodies move
//   searchOverlaps  findEvents, a pipeline of small batches:    columns; for events, compares the
//                     load -> make cell queries ->              pairs with those of the last frame
//                     apply moves -> run cell queries ->
//                     test boxes, emit events
//                   PairSet: erase ended, insert began
//                   CostModel: rebuild the grid?                CostModel: build a grid?
//
//                   bodies creep: candidates, the pairs of boxes enlarged by a margin
//   updateObjects   move: is each in its fat box still? If not, new fat boxes: MarginPolicy
//   updateStructures  columns, on the new fat boxes
//   searchOverlaps  test the candidates. CostModel: build a grid?
//
//   MoveQuery             CellQuery            CellBucket, 64 bytes         Body, 64 bytes
//   +-------------+       2x2x2 cells          +-----------------+          +------------+-------+
//   | old and new |  per  +---+---+    per     | 5 packed bounds | overlap  | box.min    | frame |
//   | box, cells  | ----> | x | x | ---------> | 5 body indices  | -------> | box.max    | cell  |
//   +-------------+ level +---+---+    cell    | next            |          | before.min |       |
//                         | x | x |            +--|--------------+          | before.max | cell  |
//                         +---+---+               +-> full overflow bucket  +------------+-------+
//
// A move query covers the old and the new box of a body: an overlap at only one of the two is an
// event, so events need no stored pairs. Bodies at rest are visited only near moving bodies.
//
// O(m · k) per frame, m moving bodies with k bodies around each; O(n) in a full search; O(m + c)
// with c candidates; 0 if nothing moves. Pairs as the answer cost O(1) more per event.
//
// Source: Broadmark. Loose cells: T. Ulrich, "Loose Octrees", Game Programming Gems, 2000. Levels:
// C. Ericson, "Real-Time Collision Detection", 2005, 7.2 (hierarchical hash grids). Candidates:
// L. Verlet, "Computer Experiments on Classical Fluids", 1967.

#include "tide.h"

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/adapters.h"
#include "broadmark/pair_set.h"
#include "cell_body.h"
#include "columns.h"
#include "sample.h"
#include "tide/candidate_pairs.h"
#include "tide/cost_model.h"
#include "tide/loose_grid.h"
#include "tide/margin_policy.h"
#include "variants.h"

namespace broadmark::tide {
namespace {

/// Directly on BroadPhase: a layer would store pairs, which events do not need.
class Tide final : public BroadPhase {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"full_search_cost_scale",
           "cost of a full search, in percent of the predicted cost; the higher, the longer the "
           "grid is used",
           &full_search_cost_scale_, 1, 1'000'000});
    visit({"candidates_cost_scale",
           "cost of candidate pairs, in percent of the predicted cost; the lower, the sooner they "
           "are used",
           &candidates_cost_scale_, 1, 1'000'000});
    visit({"max_margin",
           "largest margin of candidate pairs, in percent of the mean edge; 0: no candidates",
           &max_margin_, 0, 100});
  }

  void reportEvents() override { reports_events_ = true; }
  [[gnu::cold]] void initialize(const SceneInfo& scene, const Frame& first,
                                ExecutionContext& execution) override;
  void updateObjects(const Frame& frame) override;
  void cleanCache() override;
  void updateStructures() override;
  void searchOverlaps() override;
  [[nodiscard]] PairRuns overlaps() const override {
    return mode_ == Mode::full ? full_search_->overlaps() : PairRuns(&pairs_run_, 1);
  }
  [[nodiscard]] PairEvents events() const override {
    if (mode_ == Mode::full) return full_search_->events();
    return {PairRuns(&began_run_, 1), PairRuns(&ended_run_, 1)};
  }

  [[gnu::cold]] void drawStructure(DebugDraw& draw) const override;
  [[gnu::cold]] void visitCounters(const CounterVisitor& visit) const override;
  [[nodiscard]] std::string validate() const override;

 private:
  enum class Mode { grid, candidates, full };

  bool continueCandidates(const Frame& frame);
  [[gnu::noinline]] void startCandidates(const Frame& frame);
  void switchToFullSearch(const Frame& frame);
  void runFullSearch(std::uint32_t frame, std::span<const Aabb> boxes);
  void buildGrid(std::span<const Aabb> boxes);
  void calibrateMoveCost(std::span<const Aabb> boxes);
  void searchGrid();
  void searchCandidates();
  void copyPairs(PairRuns pairs);
  void countPairs();

  [[nodiscard]] std::unique_ptr<BroadPhase> makeSearch() const;

  std::int64_t full_search_cost_scale_ = 100;
  std::int64_t candidates_cost_scale_ = 100;
  std::int64_t max_margin_ = 10;
  bool reports_events_ = false;
  SceneInfo scene_;
  ExecutionContext* execution_ = nullptr;
  Mode mode_ = Mode::grid;  ///< of this frame
  CostModel costs_;

  std::unique_ptr<BroadPhase> full_search_;
  std::vector<std::uint32_t> bodies_;  ///< all ids

  MarginPolicy margins_;
  std::optional<CandidatePairs> candidates_;
  bool candidates_are_due_ = false;  ///< they have fat boxes, but are not searched
  bool candidates_begin_ = false;    ///< in the next frame
  PairBuffer found_;                 ///< in candidates, unless events are reported

  std::optional<LooseGrid> grid_;
  bool grid_is_current_ = false;  ///< has the boxes of the last frame
  std::vector<Aabb> boxes_;       ///< copied from the grid
  std::vector<std::uint32_t> calibration_bodies_;

  PairBuffer began_;
  PairBuffer ended_;
  PairSet pairs_;  ///< unused if events are reported
  PairRun began_run_;
  PairRun ended_run_;
  PairRun pairs_run_;
  std::uint64_t pair_count_ = 0;
  std::uint64_t moves_ = 0;
  std::uint64_t builds_ = 0;
  std::uint64_t searches_ = 0;  ///< for candidates
};

void Tide::initialize(const SceneInfo& scene, const Frame& first, ExecutionContext& execution) {
  scene_ = scene;
  execution_ = &execution;
  margins_ = MarginPolicy(static_cast<double>(max_margin_) / 100);
  costs_ = CostModel(reports_events_ ? kEventCosts : kPairCosts,
                     static_cast<double>(full_search_cost_scale_) / 100, first.boxes.size(),
                     isChangingWorld(scene), static_cast<double>(candidates_cost_scale_) / 100);
  bodies_.resize(first.boxes.size());
  std::iota(bodies_.begin(), bodies_.end(), 0U);
  full_search_ = makeSearch();
  if (reports_events_) full_search_ = withEvents(std::move(full_search_));
  full_search_->initialize(scene, first, execution);
  mode_ = Mode::full;
  if (!reports_events_) runFullSearch(first.index, first.boxes);
  countPairs();
  grid_.emplace(execution.isa());
  buildGrid(first.boxes);
  if (!reports_events_) copyPairs(full_search_->overlaps());
}

std::unique_ptr<BroadPhase> Tide::makeSearch() const {
  return isChangingWorld(scene_) ? compacted(columns::create()) : columns::create();
}

/// Chooses the mode of the frame. The choice has hysteresis: a grid is built only once its absence
/// has cost as much as a build.
void Tide::updateObjects(const Frame& frame) {
  moves_ = frame.changed->size();
  builds_ = searches_ = 0;
  if (std::exchange(candidates_begin_, false)) {
    mode_ = Mode::candidates;
    grid_is_current_ = false;
  }
  if (mode_ == Mode::candidates && !grid_is_current_ && continueCandidates(frame)) return;
  startCandidates(frame);
  if (grid_is_current_ && !costs_.fullSearchIsCheaper(moves_)) {
    mode_ = Mode::grid;
    grid_->resetWork();
    grid_->moveBodies(*frame.changed, frame.boxes);
    return;
  }
  grid_is_current_ = false;
  if (mode_ != Mode::full) {
    switchToFullSearch(frame);
    return;
  }
  full_search_->updateObjects(frame);
  if (costs_.gridPays(moves_)) buildGrid(frame.boxes);
}

/// Whether this frame is one of candidates, too: no body leaves its fat box, or new ones pay.
bool Tide::continueCandidates(const Frame& frame) {
  if (candidates_->move(*frame.changed, frame.boxes)) {
    margins_.count();
    return true;
  }
  const float margin = margins_.marginToContinue(moves_, candidates_->size(), costs_);
  if (margin == 0) return false;
  candidates_->restart(frame.boxes, margin);
  candidates_are_due_ = true;
  return true;
}

/// Prepares candidates for the next frame if they would pay.
void Tide::startCandidates(const Frame& frame) {
  const float margin = margins_.marginToStart(frame.boxes, moves_, costs_);
  if (margin == 0) return;
  if (!candidates_) candidates_.emplace(makeSearch(), scene_, frame, *execution_);
  candidates_->start(frame.boxes, margin);
  candidates_are_due_ = candidates_begin_ = true;
}

/// The full search missed the frames in the other modes. Its events are relative to its previous
/// frame, so the last of them is searched, too.
void Tide::switchToFullSearch(const Frame& frame) {
  const Mode before = std::exchange(mode_, Mode::full);
  if (reports_events_) {
    if (before == Mode::grid) grid_->copyBoxes(boxes_);
    runFullSearch(frame.index - 1, before == Mode::grid ? boxes_ : candidates_->boxes());
  }
  full_search_->updateObjects({frame.index, frame.boxes, bodies_});
}

void Tide::runFullSearch(std::uint32_t frame, std::span<const Aabb> boxes) {
  full_search_->updateObjects({frame, boxes, bodies_});
  full_search_->cleanCache();
  full_search_->updateStructures();
  full_search_->searchOverlaps();
}

void Tide::buildGrid(std::span<const Aabb> boxes) {
  grid_->build(boxes);
  grid_is_current_ = true;
  ++builds_;
  calibrateMoveCost(boxes);
}

/// Measures the work of moves in a new grid: samples of the bodies move, but stay where they are.
void Tide::calibrateMoveCost(std::span<const Aabb> boxes) {
  constexpr std::size_t kBatches = CostModel::kCalibrationBatches;
  const std::size_t moves = std::min(boxes.size(), CostModel::kCalibrationMoves) / kBatches;
  std::array<WorkCounts, kBatches> batches;
  for (std::size_t k = 0; k < kBatches; ++k) {
    std::vector<std::uint32_t>& bodies = calibration_bodies_;
    bodies.resize(moves);
    for (std::size_t i = 0; i < moves; ++i) {
      bodies[i] =
          static_cast<std::uint32_t>(sampleIndex(k * moves + i, kBatches * moves, boxes.size()));
    }
    std::ranges::sort(bodies);
    bodies.erase(std::ranges::unique(bodies).begin(), bodies.end());
    batches[k] = grid_->measureMoves(bodies, boxes);
  }
  costs_.calibrate(batches, moves);
}

void Tide::cleanCache() {
  if (mode_ == Mode::full) return full_search_->cleanCache();
  began_.clear();
  ended_.clear();
}

void Tide::updateStructures() {
  if (mode_ == Mode::full) full_search_->updateStructures();
  if (std::exchange(candidates_are_due_, false)) {
    candidates_->search();
    ++searches_;
  }
}

void Tide::searchOverlaps() {
  if (mode_ == Mode::full) {
    full_search_->searchOverlaps();
    if (grid_is_current_ && !reports_events_) copyPairs(full_search_->overlaps());
  } else if (mode_ == Mode::candidates) {
    searchCandidates();
  } else {
    searchGrid();
  }
  countPairs();
}

/// Finds events, applies them to the pairs, and rebuilds a grid with crowded cells.
void Tide::searchGrid() {
  grid_->findEvents(scene_.filter, began_, ended_);
  grid_->endFrame();
  began_run_ = began_.run();
  ended_run_ = ended_.run();
  if (!reports_events_) {
    pairs_.erase(ended_run_);
    pairs_.insert(began_run_);
    pairs_run_ = pairs_.run();
  }
  const std::size_t changes = began_.size() + ended_.size();
  if (moves_ > 0 && costs_.rebuildPays(grid_->work(), changes, moves_)) {
    grid_->copyBoxes(boxes_);
    buildGrid(boxes_);
  }
}

/// Tests the candidates, and builds a grid once so few bodies move that it pays.
void Tide::searchCandidates() {
  if (reports_events_) {
    if (moves_ > 0) candidates_->findEvents(began_, ended_);
    began_run_ = began_.run();
    ended_run_ = ended_.run();
  } else {
    found_.clear();
    candidates_->findPairs(found_);
    pairs_run_ = found_.run();
  }
  const auto count = static_cast<double>(candidates_->size());
  if (!costs_.gridPays(moves_, costs_.candidatesCost(moves_, count))) return;
  buildGrid(candidates_->boxes());
  if (!reports_events_) copyPairs(PairRuns(&pairs_run_, 1));
}

/// A new grid continues from these pairs.
void Tide::copyPairs(PairRuns pairs) {
  pairs_.clear();
  for (const PairRun run : pairs) pairs_.insert(run);
  pairs_run_ = pairs_.run();
}

void Tide::countPairs() {
  if (reports_events_) {
    pair_count_ += pairCount(events().began) - pairCount(events().ended);
  } else {
    pair_count_ = pairCount(overlaps());
  }
  costs_.setPairs(pair_count_);
}

void Tide::drawStructure(DebugDraw& draw) const {
  if (mode_ == Mode::full) {
    full_search_->drawStructure(draw);
  } else if (mode_ == Mode::candidates) {
    candidates_->draw(draw);
  } else {
    grid_->draw(draw);
  }
}

void Tide::visitCounters(const CounterVisitor& visit) const {
  visit("moves", moves_);
  visit("grids built", builds_);
  if (mode_ == Mode::full) {
    full_search_->visitCounters(visit);
    return;
  }
  if (mode_ == Mode::candidates) {
    visit("candidates", candidates_->size());
    visit("searches", searches_);
    return;
  }
  visit("cell queries", grid_->work().cell_queries);
  visit("tests", grid_->work().tests);
  visit("cell changes", grid_->work().cell_changes);
  visit("pairs begun", began_.size());
  visit("pairs ended", ended_.size());
}

std::string Tide::validate() const {
  if (grid_is_current_) return grid_->validate();
  return mode_ == Mode::candidates ? candidates_->validate() : full_search_->validate();
}

}  // namespace

std::unique_ptr<BroadPhase> create() { return std::make_unique<Tide>(); }

std::vector<Algorithm> variants() {
  const Algorithm family = {
      .family = "Tide",
      .traits = {.incremental = true,
                 .events = true,
                 .changing_worlds = ChangingWorlds::native,
                 .instance_per_world = true,
                 .max_objects = std::min<std::uint64_t>(kMaxCellBodies - 1, LooseGrid::kMaxBodies),
                 .rare_parameters = {{{"full_search_cost_scale", "1000000"}, {"max_margin", "0"}},
                                     {{"candidates_cost_scale", "1"}}}},
      .description = {.principle = "grid",
                      .optimisations = "events without pairs, hierarchical grid, candidate pairs",
                      .time = "O(m · k), m moving bodies, k around each; O(n) if many move",
                      .space = "O(n)",
                      .source = "Broadmark; Ulrich 2000; Ericson 2005, 7.2; Verlet 1967"}};
  return {variantOf<Tide>(
      family, "tide",
      "loose grid queried around moving bodies; candidate pairs if slow; full search if many move",
      {.vectorised = true})};
}

}  // namespace broadmark::tide
