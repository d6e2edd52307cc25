// The adaptive KD tree: bodies in the cells of a binary space partition that follows them, with
// what did not change since the last frame left as it is. O(m log n + w) per frame, m the bodies
// that moved and w the pairs tested; O(n log n) where everything is new.
//
// A body keeps still while it stays in its stored box, which is its box when it last moved, grown
// by a margin on every side. The tree and the pairs kept are those of the stored boxes. While more
// than half of the bodies keep still (and the pairs kept are complete), pairs of two still bodies
// are kept from the last frame and only those with a moving body are searched for; else all are.
// With a margin, those of the kept pairs that overlap in this frame are the answer, so it is exact.
// Where events are asked for, a pair that is dropped may have ended and one that is found may have
// begun: the boxes of its two bodies, before and now, tell.
//
// Bodies that do not meet each other, as a level's, stay out of the tree until they move for the
// first time: kd/rest, in which each moving body looks for those that it overlaps. So a frame in
// which few of very many bodies move costs only what these do.
//
// kd/tree: the tree and its update. kd/search: the search. Both are shared out over the team. That
// and the bodies at rest go beyond the paper.
//
// Paper: Y. R. Serpa and M. A. F. Rodrigues, "Flexible Use of Temporal and Spatial Reasoning for
// Fast and Scalable CPU Broad-Phase Collision Detection Using KD-Trees", Computer Graphics Forum,
// 2019.

#include <algorithm>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kd/rest.h"
#include "kd/search.h"
#include "kd/tree.h"
#include "variants.h"

namespace broadmark::kd {
namespace {

/// Whether `box` lies in `stored`, and that is no larger than for a body that moved about within
/// the margin: to shrink is to move.
bool isStill(const Aabb& box, const Aabb& stored, float margin) {
  const float slack = 2 * margin;
  int still = 1;
  for (int axis = 0; axis < 3; ++axis) {
    still &= static_cast<int>(stored.min[axis] <= box.min[axis]);
    still &= static_cast<int>(box.min[axis] - slack <= stored.min[axis]);
    still &= static_cast<int>(box.max[axis] <= stored.max[axis]);
    still &= static_cast<int>(stored.max[axis] <= box.max[axis] + slack);
  }
  return still != 0;
}

/// Directly on BroadPhase: pairs are kept from frame to frame, which a layer's buffers are not.
class Kd final : public BroadPhase {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"objects_per_leaf", "bodies above which a leaf of the tree is split", &objects_per_leaf_,
           1, 1'000'000});
    visit({"margin",
           "distance that a body may move, in world units, before its place in the tree and its "
           "pairs are looked at again",
           &margin_, 0, 1'000'000});
  }

  void initialize(const SceneInfo& scene, const Frame& first, Execution& execution) override {
    team_ = &execution.team();
    world_ = scene.world;
    filter_ = scene.filter;
    boxes_.assign(first.boxes.begin(), first.boxes.end());
    for (const Aabb& box : boxes_) stored_.push_back(storedFor(box));
    moving_.resize(stored_.size());
    for (int worker = 0; worker < team_->size(); ++worker) workers_.emplace_back(execution.isa());
    for (Worker& worker : workers_) {
      worker.moved.reserve(stored_.size() / workers_.size() + 1);
      worker.arrived.reserve(stored_.size() / workers_.size() + 1);
    }
    runs_.resize(workers_.size());
    kernels_ = &overlapKernels(execution.isa());
    std::vector<std::uint32_t> bodies = first.presentBodies();
    rest_.build(stored_, bodies, filter_, team_->size());
    std::erase_if(bodies, [this](std::uint32_t body) { return rest_.holds(body); });
    tree_.build(stored_, moving_, bodies, static_cast<std::size_t>(objects_per_leaf_), *team_);
    if (reports_events_) findFirstEvents();
  }

  void updateObjects(const Frame& frame) override {
    const std::span<const std::uint32_t> changed = *frame.changed;
    forgetMoved();
    team_->run(changed.size(), [&](int part, Range range) {
      Worker& worker = workers_[static_cast<std::size_t>(part)];
      for (const std::uint32_t body : changed.subspan(range.begin, range.size())) {
        takeOver(worker, body, frame.boxes[body]);
      }
    });
    moved_ = 0;
    for (Worker& worker : workers_) {
      moved_ += worker.moved.size() + worker.arrived.size();
      rest_.removed(std::exchange(worker.woken, 0));
    }
    // Before the first search there are no pairs to keep.
    incremental_ = searched_ && 2 * moved_ < tree_.size() + rest_.size();
  }

  /// Drops the pairs that are searched for again.
  void cleanCache() override {
    if (reports_events_) forWorkers([this](Worker& worker, Range) { findEnded(worker); });
    forWorkers([this](Worker& worker, Range part) {
      if (incremental_) {
        if (moved_ > 0) worker.pairs.retain([this](Pair p) { return isKept(p); });
      } else {
        worker.pairs.clear();
        fillMoving(part, 1);
      }
      worker.kept = worker.pairs.size();
    });
  }

  void updateStructures() override {
    tree_.beginUpdate(!incremental_);
    if (incremental_ && moved_ > 0) {
      team_->run([this](int part) {
        for (const std::uint32_t body : workers_[static_cast<std::size_t>(part)].moved) {
          tree_.touch(body);
        }
      });
    }
    for (const Worker& worker : workers_) tree_.admit(worker.arrived);
    tree_.update();
  }

  void searchOverlaps() override {
    const Searcher::Scene scene = {tree_, stored_, moving_,
                                   filter_.wantsAll() ? nullptr : &filter_};
    team_->run([&](int part) {
      Worker& worker = workers_[static_cast<std::size_t>(part)];
      worker.searcher.search(scene, part, team_->size(), worker.pairs);
      searchRest(worker, part);
      if (reports_events_) {
        findBegun(worker);
      } else {
        runs_[static_cast<std::size_t>(part)] =
            margin_ > 0 ? trueOverlaps(worker) : worker.pairs.run();
      }
    });
    searched_ = true;
    if (!reports_events_) return;
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      began_[i] = workers_[i].began.run();
      ended_[i] = workers_[i].ended.run();
    }
  }

  [[nodiscard]] PairRuns overlaps() const override { return runs_; }

  void reportEvents() override { reports_events_ = true; }
  [[nodiscard]] PairEvents events() const override { return {began_, ended_}; }

  void drawStructure(DebugDraw& draw) const override { tree_.draw(draw, world_); }

  void visitCounters(const CounterVisitor& visit) const override {
    std::uint64_t kept = 0;
    std::uint64_t skipped = 0;
    std::uint64_t boxes_tested = 0;
    for (const Worker& worker : workers_) {
      kept += worker.kept;
      skipped += worker.searcher.skippedSubtrees();
      boxes_tested += worker.searcher.boxesTested() + worker.rest.boxes_tested;
    }
    visit("moved bodies", moved_);
    visit("bodies at rest", rest_.size());
    visit("boxes looked at", boxes_tested);
    tree_.visitCounters(visit);
    visit("subtrees skipped in searches", skipped);
    visit("pairs kept", kept);
  }

  [[nodiscard]] std::string validate() const override {
    for (std::uint32_t body = 0; body < stored_.size(); ++body) {
      const int places = (tree_.holds(body) ? 1 : 0) + (rest_.holds(body) ? 1 : 0);
      if (places != (stored_[body] == Tree::kGone ? 0 : 1)) return "a body came or went unseen";
    }
    const std::string fault = rest_.validate(stored_);
    return fault.empty() ? tree_.validate() : fault;
  }

 private:
  struct alignas(64) Worker {
    explicit Worker(Isa isa) : searcher(isa) {}

    Searcher searcher;
    PairBuffer pairs;                    ///< of stored boxes; kept from frame to frame
    PairBuffer answer;                   ///< those of them that overlap, if there is a margin
    std::vector<std::uint32_t> moved;    ///< in this frame: bodies in the tree, vanished ones too
    std::vector<std::uint32_t> arrived;  ///< in this frame: bodies not yet in the tree
    std::size_t woken = 0;               ///< in this frame: bodies no longer at rest
    // Of events only.
    std::vector<std::uint32_t> changed;  ///< in this frame: its share of the bodies
    PairBuffer began;
    PairBuffer ended;
    Rest::Scratch rest;
    std::size_t kept = 0;
  };

  [[nodiscard]] Aabb storedFor(const Aabb& box) const {
    return isEmpty(box) ? Tree::kGone : enlarged(box, static_cast<float>(margin_));
  }

  /// Marks no body as moving: what is now was before.
  void forgetMoved() {
    forWorkers([this](Worker& worker, Range part) {
      if (incremental_) {
        for (const std::uint32_t body : worker.moved) moving_[body] = 0;
        for (const std::uint32_t body : worker.arrived) moving_[body] = 0;
      } else {
        fillMoving(part, 0);
      }
      worker.moved.clear();
      worker.arrived.clear();
      for (const std::uint32_t body : worker.changed) before_[body] = boxOf(body);
      worker.changed.clear();
    });
  }

  void fillMoving(Range bodies, std::uint8_t value) {
    std::fill(moving_.begin() + static_cast<std::ptrdiff_t>(bodies.begin),
              moving_.begin() + static_cast<std::ptrdiff_t>(bodies.end), value);
  }

  void takeOver(Worker& worker, std::uint32_t body, const Aabb& box) {
    const auto margin = static_cast<float>(margin_);
    if (reports_events_) {
      before_[body] = boxOf(body);
      worker.changed.push_back(body);
    }
    if (margin > 0) boxes_[body] = box;  // without a margin stored boxes are the boxes
    const bool is_in_tree = tree_.holds(body);
    const bool is_at_rest = !is_in_tree && rest_.holds(body);
    if ((is_in_tree || is_at_rest) && isStill(box, stored_[body], margin)) return;
    stored_[body] = storedFor(box);
    moving_[body] = 1;
    if (is_at_rest) {
      rest_.remove(body);
      ++worker.woken;
    }
    // One that vanishes from its rest passes through the tree: its pairs are dropped as all are.
    (is_in_tree ? worker.moved : worker.arrived).push_back(body);
  }

  /// In this frame.
  [[nodiscard]] Aabb boxOf(std::uint32_t body) const {
    if (margin_ > 0) return boxes_[body];
    return stored_[body] == Tree::kGone ? kEmptyBox : stored_[body];
  }
  [[nodiscard]] bool overlapped(Pair pair) const {
    return broadmark::overlaps(before_[pair.a], before_[pair.b]);
  }
  [[nodiscard]] bool overlapNow(Pair pair) const {
    return broadmark::overlaps(boxOf(pair.a), boxOf(pair.b));
  }

  /// All pairs of the initial pose begin.
  void findFirstEvents() {
    began_.resize(workers_.size());
    ended_.resize(workers_.size());
    before_.assign(stored_.size(), kEmptyBox);
    cleanCache();
    updateStructures();
    searchOverlaps();
    for (std::uint32_t body = 0; body < before_.size(); ++body) before_[body] = boxOf(body);
  }

  /// Before pairs are dropped. With a margin those that are kept may end, too.
  void findEnded(Worker& worker) {
    worker.ended.clear();
    const bool kept_may_end = margin_ > 0;
    if (moved_ == 0 && !kept_may_end) return;
    for (const Pair pair : worker.pairs.run()) {
      if (!kept_may_end && isKept(pair)) continue;
      if (overlapped(pair) && !overlapNow(pair)) worker.ended.add(pair.a, pair.b);
    }
  }

  void findBegun(Worker& worker) {
    worker.began.clear();
    for (const Pair pair : worker.pairs.run().subspan(margin_ > 0 ? 0 : worker.kept)) {
      if (overlapNow(pair) && !overlapped(pair)) worker.began.add(pair.a, pair.b);
    }
  }

  /// Adds the pairs of bodies in the tree and bodies at rest.
  void searchRest(Worker& worker, int part) {
    worker.rest.boxes_tested = 0;
    if (rest_.size() == 0) return;
    const auto search = [&](std::span<const std::uint32_t> bodies) {
      for (const std::uint32_t body : bodies) {
        if (!tree_.holds(body) || !rest_.meets(body)) continue;
        rest_.search(body, stored_[body], part, *kernels_, worker.rest, worker.pairs);
      }
    };
    if (incremental_) {
      search(worker.moved);
      search(worker.arrived);
    } else {
      const auto [begin, end] = share(tree_.size(), team_->size(), part);
      search(tree_.bodies().subspan(begin, end - begin));
    }
  }

  /// Calls work(worker, its share of the bodies) for all workers at once.
  template <class Work>
  void forWorkers(Work work) {
    team_->run(stored_.size(), [&](int part, Range bodies) {
      work(workers_[static_cast<std::size_t>(part)], bodies);
    });
  }

  [[nodiscard]] bool isKept(Pair pair) const { return (moving_[pair.a] | moving_[pair.b]) == 0; }

  PairRun trueOverlaps(Worker& worker) const {
    const PairRun pairs = worker.pairs.run();
    worker.answer.clear();
    Pair* const room = worker.answer.room(pairs.size());
    std::size_t count = 0;
    for (const Pair pair : pairs) {
      room[count] = pair;
      count += broadmark::overlaps(boxes_[pair.a], boxes_[pair.b]) ? 1 : 0;
    }
    worker.answer.advance(count);
    return worker.answer.run();
  }

  /// Half of the original's 512: with wide vectors, to test all pairs of so few bodies takes less
  /// than to sort them.
  std::int64_t objects_per_leaf_ = 256;
  double margin_ = 0;

  ThreadTeam* team_ = nullptr;
  Aabb world_;
  CollisionFilter filter_;
  std::vector<Aabb> boxes_;           ///< of this frame, if there is a margin
  std::vector<Aabb> stored_;          ///< of when each body last moved, enlarged; or kGone
  std::vector<std::uint8_t> moving_;  ///< 1: the pairs of this body are searched for
  std::size_t moved_ = 0;
  bool searched_ = false;
  bool incremental_ = false;  ///< pairs of two bodies that keep still are kept
  Tree tree_;
  Rest rest_;
  const OverlapKernels* kernels_ = nullptr;
  std::deque<Worker> workers_;
  std::vector<PairRun> runs_;
  bool reports_events_ = false;
  std::vector<Aabb> before_;  ///< in the frame before, if events are reported
  std::vector<PairRun> began_;
  std::vector<PairRun> ended_;
};

}  // namespace

std::vector<Algorithm> variants() {
  const Algorithm family = {
      .family = "KD",
      .traits = {.incremental = true,
                 .events = true,
                 .changing_worlds = ChangingWorlds::native,
                 .instance_per_world = true},
      .description = {
          .principle = "tree",
          .optimisations = "incremental tree and pairs",
          .time = "O(m log n + w), m bodies moved, w pairs tested",
          .space = "O(n + k)",
          .source = "Serpa and Rodrigues 2019, Flexible Use of Temporal and Spatial Reasoning"}};
  return {
      variantOf<Kd>(family, "kd",
                    "keeps bodies in an adaptive KD tree, and the pairs of those that keep still",
                    {.vectorised = true}),
      variantOf<Kd>(family, "kd-mt", "adaptive KD tree, on several threads",
                    {.parallel = true, .vectorised = true})};
}

}  // namespace broadmark::kd
