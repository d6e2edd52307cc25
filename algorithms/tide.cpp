// Tide: the cost of a frame follows the bodies that move. Who moves is looked for in a loose grid,
// at the place where it was and at the one where it is, and what overlaps at one of the two only is
// a pair that ends or begins. No pairs are kept for that: a frame is done with once its events are
// known. Bodies at rest are not looked at, but for those around the ones that move.
//
// When many move it is quicker to find all pairs anew: then `columns` does it, until few move
// again (tide/cost_model.h).
//
// O(m · k), m the bodies that move, k those around one of them; O(n) where that is quicker. A frame
// in which nothing moves costs nothing. Where pairs are asked for and not events, they are kept in
// a set, O(1) for each that begins or ends.
//
// Source: Broadmark; for the grid see tide/loose_grid.h.

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
#include "tide/cost_model.h"
#include "tide/loose_grid.h"
#include "variants.h"

namespace broadmark::tide {
namespace {

/// Directly on BroadPhase: events need no pairs.
class Tide final : public BroadPhase {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"full_search_cost_scale",
           "cost of a full search, in percent of the prediction: the grid is kept longer if it is "
           "higher",
           &full_search_cost_scale_, 1, 1'000'000});
  }

  void reportEvents() override { reports_events_ = true; }
  void initialize(const SceneInfo& scene, const Frame& first, Execution& execution) override;
  void updateObjects(const Frame& frame) override;
  void cleanCache() override;
  void updateStructures() override;
  void searchOverlaps() override;
  [[nodiscard]] PairRuns overlaps() const override {
    return is_anew_ ? anew_->overlaps() : PairRuns(&pairs_run_, 1);
  }
  [[nodiscard]] PairEvents events() const override {
    if (is_anew_) return anew_->events();
    return {PairRuns(&began_run_, 1), PairRuns(&ended_run_, 1)};
  }

  void drawStructure(DebugDraw& draw) const override;
  void visitCounters(const CounterVisitor& visit) const override;
  [[nodiscard]] std::string validate() const override;

 private:
  void findAnew(std::uint32_t frame, std::span<const Aabb> boxes);
  void beginAnew(const Frame& frame);
  void buildGrid(std::span<const Aabb> boxes);
  void tryMoves(std::span<const Aabb> boxes);
  void searchGrid();
  void takePairs();
  void countPairs();

  std::int64_t full_search_cost_scale_ = 100;
  bool reports_events_ = false;
  CollisionFilter filter_;
  std::vector<std::uint32_t> bodies_;  ///< all ids
  std::vector<std::uint32_t> tried_;   ///< some

  std::unique_ptr<BroadPhase> anew_;  ///< finds all pairs
  bool is_anew_ = false;              ///< this frame is its

  std::optional<LooseGrid> grid_;
  bool grid_is_ready_ = false;  ///< knows where bodies are
  CostModel costs_;
  std::uint64_t pair_count_ = 0;
  std::uint64_t moves_ = 0;
  std::uint64_t builds_ = 0;
  std::vector<Aabb> boxes_;  ///< for building it anew
  PairBuffer began_;
  PairBuffer ended_;
  PairSet pairs_;  ///< unless it reports events
  PairRun began_run_;
  PairRun ended_run_;
  PairRun pairs_run_;
};

void Tide::initialize(const SceneInfo& scene, const Frame& first, Execution& execution) {
  filter_ = scene.filter;
  costs_ = CostModel(reports_events_ ? kCostsOfEvents : kCostsOfPairs,
                     static_cast<double>(full_search_cost_scale_) / 100, first.boxes.size());
  bodies_.resize(first.boxes.size());
  std::iota(bodies_.begin(), bodies_.end(), 0U);
  anew_ = columns::create();
  if (isChangingWorld(scene)) anew_ = compacted(std::move(anew_));
  if (reports_events_) anew_ = withEvents(std::move(anew_));
  anew_->initialize(scene, first, execution);
  is_anew_ = true;
  if (!reports_events_) findAnew(first.index, first.boxes);
  countPairs();
  grid_.emplace(execution.isa());
  buildGrid(first.boxes);
  if (!reports_events_) takePairs();
}

/// All pairs of a frame, of which all bodies may have moved.
void Tide::findAnew(std::uint32_t frame, std::span<const Aabb> boxes) {
  anew_->updateObjects({frame, boxes, bodies_});
  anew_->cleanCache();
  anew_->updateStructures();
  anew_->searchOverlaps();
}

void Tide::updateObjects(const Frame& frame) {
  moves_ = frame.changed->size();
  builds_ = 0;
  if (grid_is_ready_ && !costs_.scratchIsQuicker(moves_)) {
    is_anew_ = false;
    grid_->resetWork();
    grid_->addMoves(*frame.changed, frame.boxes);
    return;
  }
  grid_is_ready_ = false;
  if (!is_anew_) {
    beginAnew(frame);
    return;
  }
  anew_->updateObjects(frame);
  if (costs_.gridPays(moves_)) buildGrid(frame.boxes);
}

void Tide::buildGrid(std::span<const Aabb> boxes) {
  grid_->build(boxes);
  grid_is_ready_ = true;
  ++builds_;
  tryMoves(boxes);
}

/// Tells what moves cost by some of bodies that stay where they are.
void Tide::tryMoves(std::span<const Aabb> boxes) {
  constexpr std::size_t kTries = CostModel::kTries;
  const std::size_t moves = std::min(boxes.size(), CostModel::kEnoughMoves) / kTries;
  std::array<Work, kTries> tries;
  for (std::size_t k = 0; k < kTries; ++k) {
    tried_.resize(moves);
    for (std::size_t i = 0; i < moves; ++i) {
      tried_[i] =
          static_cast<std::uint32_t>(sampleIndex(k * moves + i, kTries * moves, boxes.size()));
    }
    std::ranges::sort(tried_);
    tried_.erase(std::ranges::unique(tried_).begin(), tried_.end());
    tries[k] = grid_->tryMoves(tried_, boxes);
  }
  costs_.setGrid(tries, moves);
}

/// From now on all pairs are found anew. Its last frame was some time ago.
void Tide::beginAnew(const Frame& frame) {
  is_anew_ = true;
  if (reports_events_) {  // which are what differs from the frame before
    grid_->boxes(boxes_);
    findAnew(frame.index - 1, boxes_);
  }
  anew_->updateObjects({frame.index, frame.boxes, bodies_});
}

void Tide::cleanCache() {
  if (is_anew_) return anew_->cleanCache();
  began_.clear();
  ended_.clear();
}

void Tide::updateStructures() {
  if (is_anew_) anew_->updateStructures();
}

void Tide::searchOverlaps() {
  if (is_anew_) {
    anew_->searchOverlaps();
    if (grid_is_ready_ && !reports_events_) takePairs();
  } else {
    searchGrid();
  }
  countPairs();
}

void Tide::searchGrid() {
  grid_->search(filter_, began_, ended_);
  grid_->settle();
  began_run_ = began_.run();
  ended_run_ = ended_.run();
  if (!reports_events_) {
    pairs_.erase(ended_run_);
    pairs_.insert(began_run_);
    pairs_run_ = pairs_.run();
  }
  const std::size_t changes = began_.size() + ended_.size();
  if (moves_ > 0 && costs_.anotherGridPays(grid_->work(), changes, moves_)) {
    grid_->boxes(boxes_);
    buildGrid(boxes_);
  }
}

void Tide::takePairs() {
  pairs_.clear();
  for (const PairRun run : anew_->overlaps()) pairs_.insert(run);
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
  if (is_anew_) {
    anew_->drawStructure(draw);
  } else {
    grid_->draw(draw);
  }
}

void Tide::visitCounters(const CounterVisitor& visit) const {
  visit("moves", moves_);
  visit("grids built", builds_);
  if (is_anew_) {
    anew_->visitCounters(visit);
    return;
  }
  visit("looks", grid_->work().looks);
  visit("tests", grid_->work().tests);
  visit("cell changes", grid_->work().cell_changes);
  visit("pairs begun", began_.size());
  visit("pairs ended", ended_.size());
}

std::string Tide::validate() const {
  if (!grid_is_ready_) return anew_->validate();
  return grid_->validate();
}

}  // namespace

std::vector<Algorithm> variants() {
  const Algorithm family = {
      .family = "Tide",
      .traits = {.incremental = true,
                 .events = true,
                 .changing_worlds = ChangingWorlds::native,
                 .instance_per_world = true,
                 .max_objects = std::min<std::uint64_t>(kMaxCellBodies - 1, LooseGrid::kMostBodies),
                 .rare_parameters = {{"full_search_cost_scale", "1000000"}}},
      .description = {.principle = "grid",
                      .optimisations = "events without pairs, several sizes of cells",
                      .time = "O(m · k), m bodies that move, k around each; O(n) if many move",
                      .space = "O(n)",
                      .source = "Broadmark; Ulrich 2000, Ericson 2005, 7.2"}};
  return {variantOf<Tide>(family, "tide",
                          "those that move in a loose grid, from scratch when many do",
                          {.vectorised = true})};
}

}  // namespace broadmark::tide
