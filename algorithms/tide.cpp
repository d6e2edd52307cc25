// Tide: the cost of a frame follows the bodies that move. Who moves is looked for in a loose grid,
// at the place where it was and at the one where it is, and what overlaps at one of the two only is
// a pair that ends or begins. No pairs are kept for that: a frame is done with once its events are
// known. Bodies at rest are not looked at, but for those around the ones that move.
//
// When many move it is quicker to find all pairs anew: then `columns` does it, until few move
// again.
//
// O(m · k), m the bodies that move, k those around one of them; O(n) from the share of the
// parameter on. A frame in which nothing moves costs nothing. Where pairs are asked for and not
// events, they are kept in a set, O(1) for each that begins or ends.
//
// Source: Broadmark; for the grid see tide/loose_grid.h.

#include <algorithm>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/adapters.h"
#include "broadmark/pair_set.h"
#include "columns.h"
#include "marked_body.h"
#include "tide/loose_grid.h"
#include "variants.h"

namespace broadmark::tide {
namespace {

/// After so many frames in a row in which few bodies moved the grid is built again: that takes
/// about as long as finding all pairs twice.
constexpr int kQuietFrames = 4;

/// Directly on BroadPhase: events need no pairs.
class Tide final : public BroadPhase {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"from_scratch", "percentage of bodies that move from which on all pairs are found anew",
           &from_scratch_, 0, 100});
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
  [[nodiscard]] bool isMany(std::size_t moves, std::int64_t percentage) const {
    return 100 * moves > static_cast<std::size_t>(percentage) * bodies_.size();
  }
  void findAnew(std::uint32_t frame, std::span<const Aabb> boxes);
  void beginAnew(const Frame& frame);
  void buildGrid(std::span<const Aabb> boxes);
  void takePairs();
  void followCrowds();

  std::int64_t from_scratch_ = 12;
  bool reports_events_ = false;
  CollisionFilter filter_;
  std::vector<std::uint32_t> bodies_;  ///< all ids

  std::unique_ptr<BroadPhase> anew_;  ///< finds all pairs
  bool is_anew_ = false;              ///< this frame is its
  int quiet_frames_ = 0;              ///< of its last ones

  std::optional<LooseGrid> grid_;
  double usual_work_ = 0;   ///< for a move, twice what the first frame took; 0: not known yet
  double excess_work_ = 0;  ///< beyond that, since the grid was built
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
  bodies_.resize(first.boxes.size());
  std::iota(bodies_.begin(), bodies_.end(), 0U);
  anew_ = columns::create();
  if (isChangingWorld(scene)) anew_ = compacted(std::move(anew_));
  if (reports_events_) anew_ = withEvents(std::move(anew_));
  anew_->initialize(scene, first, execution);
  if (!reports_events_) findAnew(first.index, first.boxes);
  grid_.emplace(execution.isa());
  buildGrid(first.boxes);
  is_anew_ = true;
  quiet_frames_ = kQuietFrames;
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
  const bool grid_is_ready = !is_anew_ || quiet_frames_ == kQuietFrames;
  if (grid_is_ready && !isMany(moves_, from_scratch_)) {
    is_anew_ = false;
    grid_->resetWork();
    grid_->addMoves(*frame.changed, frame.boxes);
    return;
  }
  if (!is_anew_) {
    beginAnew(frame);
    return;
  }
  anew_->updateObjects(frame);
  // Well below the limit, or the next frame might be above it again.
  quiet_frames_ = isMany(moves_, from_scratch_ / 2) ? 0 : quiet_frames_ + 1;
  if (quiet_frames_ == kQuietFrames) buildGrid(frame.boxes);
}

void Tide::buildGrid(std::span<const Aabb> boxes) {
  grid_->build(boxes);
  usual_work_ = excess_work_ = 0;
  ++builds_;
}

/// From now on all pairs are found anew. Its last frame was some time ago.
void Tide::beginAnew(const Frame& frame) {
  is_anew_ = true;
  quiet_frames_ = 0;
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
    if (quiet_frames_ == kQuietFrames && !reports_events_) takePairs();
    return;
  }
  grid_->search(filter_, began_, ended_);
  grid_->settle();
  began_run_ = began_.run();
  ended_run_ = ended_.run();
  if (!reports_events_) {
    for (const Pair pair : ended_run_) pairs_.erase(pair);
    for (const Pair pair : began_run_) pairs_.insert(pair);
    pairs_run_ = pairs_.run();
  }
  if (moves_ > 0) followCrowds();
}

void Tide::takePairs() {
  pairs_.clear();
  for (const PairRun run : anew_->overlaps()) {
    for (const Pair pair : run) pairs_.insert(pair);
  }
  pairs_run_ = pairs_.run();
}

/// Bodies may crowd where the grid has too few cells for them. Once the work beyond the usual has
/// cost as much as a new grid does, there is one.
void Tide::followCrowds() {
  constexpr double kWorkOfBuilding = 15;  // for a body, in lines that are looked into
  constexpr double kLeast = 16;           // for a move: never worth it
  const double work = static_cast<double>(grid_->work().lines + grid_->work().tests);
  const double moves = static_cast<double>(moves_);
  if (usual_work_ == 0) usual_work_ = 2 * std::max(work / moves, kLeast);
  excess_work_ += std::max(0.0, work - usual_work_ * moves);
  if (excess_work_ < kWorkOfBuilding * static_cast<double>(bodies_.size())) return;
  grid_->boxes(boxes_);
  buildGrid(boxes_);
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
  visit("lines looked into", grid_->work().lines);
  visit("tests", grid_->work().tests);
  visit("cell changes", grid_->work().cell_changes);
  visit("pairs begun", began_.size());
  visit("pairs ended", ended_.size());
}

std::string Tide::validate() const {
  if (is_anew_ && quiet_frames_ < kQuietFrames) return anew_->validate();
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
                 .max_objects =
                     std::min<std::uint64_t>(kMaxMarkedBodies - 1, LooseGrid::kMostBodies)},
      .description = {.principle = "grid",
                      .optimisations = "events without pairs, several sizes of cells",
                      .time = "O(m · k), m bodies that move, k around each; O(n) if many move",
                      .space = "O(n)",
                      .source = "Broadmark; Ulrich 2000, Ericson 2005, 7.2"}};
  return {variantOf(family, [] { return std::make_unique<Tide>(); }, "tide",
                    "those that move in a loose grid, from scratch when many do",
                    {.vectorised = true})};
}

}  // namespace broadmark::tide
