// Algorithms that are wrong occasionally, to show how such a fault is found. A plug-in, never part
// of the program.
//
// "lossy-removal" and "lossy-layers" test all pairs. The first loses a pair whenever a body has
// vanished since the previous frame, the second all pairs of two layers. "stale-filter" retains the
// layers and tags of the initial pose.
//
// The other two store a fat box of each body (as Bullet's and Box2D's trees do) and all pairs of
// overlapping fat boxes. Only bodies that left their fat box, the moved ones, get a new fat box and
// a new query. Moved bodies are processed in batches, through a small buffer. Of two moved bodies
// only the lower one reports the pair, so that it is found once.
//
// The fault of "faulty": that last rule is right only if all new fat boxes are set before the first
// query, but that holds only within one batch. When i < j move in the same frame but in different
// batches, i is queried while j's fat box is still the old one, and j leaves the pair to i. Two
// bodies that begin to overlap in one frame can be lost if a third body moves, too, and splits the
// batch between them. It takes three bodies, an initial pose, and one frame, or two if they begin
// to overlap later. The pair stays lost until one of the two moves again.
//
// The fault of "faulty-extra": pairs of two bodies that moved in this frame are reported untested,
// that is, for their fat boxes.

#include "support/faulty_algorithm.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <numeric>
#include <thread>

#include "broadmark/plugin.h"
#include "broadmark/reference_pairs.h"

namespace broadmark::faulty {
namespace {

enum class Fault { missed, extra };

class FatBoxes final : public BoxBroadPhase {
 public:
  explicit FatBoxes(Fault fault) : fault_(fault) {}

  void visitParameters(const ParameterVisitor& visit) override {
    visit({.name = "fat_margin",
           .doc = "how much larger a fat box is, on every side, in world units",
           .value = &margin_,
           .min = 0,
           .max = 1000});
    visit({.name = "hold",
           .doc = "1: no frame ends once there is a file hold.txt, so that it is caught at work",
           .value = &hold_,
           .min = 0,
           .max = 1});
  }

  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    BoxBroadPhase::initialize(scene, first, execution);
    fat_.assign(first.boxes.begin(), first.boxes.end());
    has_moved_.assign(fat_.size(), 1);
    moved_.clear();
    for (std::uint32_t body = 0; body < fat_.size(); ++body) moved_.push_back(body);
    candidates_.clear();
    update(moved_.size());
  }

  void updateStructures() override {
    while (hold_ != 0 && ::access("hold.txt", F_OK) == 0) ::pause();
    moved_.clear();
    for (std::uint32_t body = 0; body < fat_.size(); ++body) {
      has_moved_[body] = merged(fat_[body], boxes()[body]) != fat_[body];
      if (has_moved_[body] != 0) moved_.push_back(body);
    }
    std::erase_if(candidates_, [&](const Pair pair) {
      return has_moved_[pair.a] != 0 || has_moved_[pair.b] != 0;
    });
    update(fault_ == Fault::missed ? kBuffer : moved_.size());
  }

  void drawStructure(DebugDraw& draw) const override {
    for (std::size_t body = 0; body < fat_.size(); ++body) {
      draw.box(fat_[body],
               has_moved_[body] != 0 ? StructureRole::moving_node : StructureRole::resting_node, 0);
    }
    for (const Pair pair : candidates_)
      draw.line(centre(pair.a), centre(pair.b), StructureRole::resting_node);
  }

 private:
  /// Small enough for three bodies to show the fault.
  static constexpr std::size_t kBuffer = 2;

  void findPairs() override {
    for (const Pair pair : candidates_) {
      if (broadmark::overlaps(boxes()[pair.a], boxes()[pair.b]) || isReportedUntested(pair)) {
        pairs().add(pair.a, pair.b);
      }
    }
  }

  /// New fat boxes and queries for the moved bodies, in batches.
  void update(std::size_t batch_size) {
    for (std::size_t first = 0; first < moved_.size(); first += batch_size) {
      const std::size_t last = std::min(first + batch_size, moved_.size());
      for (std::size_t i = first; i < last; ++i) {
        fat_[moved_[i]] = enlarged(boxes()[moved_[i]], static_cast<float>(margin_));
      }
      for (std::size_t i = first; i < last; ++i) query(moved_[i]);
    }
  }

  void query(std::uint32_t body) {
    for (std::uint32_t other = 0; other < fat_.size(); ++other) {
      const bool other_reports = other < body && has_moved_[other] != 0;
      if (other == body || other_reports || !broadmark::overlaps(fat_[body], fat_[other])) continue;
      candidates_.push_back(orderedPair(body, other));
    }
  }

  [[nodiscard]] bool isReportedUntested(const Pair pair) const {
    return fault_ == Fault::extra && has_moved_[pair.a] != 0 && has_moved_[pair.b] != 0;
  }

  [[nodiscard]] std::array<float, 3> centre(std::uint32_t body) const {
    std::array<float, 3> point{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      point[axis] = (fat_[body].min[axis] + fat_[body].max[axis]) / 2;
    }
    return point;
  }

  Fault fault_;
  double margin_ = 1.5;
  std::int64_t hold_ = 0;
  std::vector<Aabb> fat_;
  std::vector<char> has_moved_;  ///< by body; not bool: read in the innermost loop
  std::vector<std::uint32_t> moved_;
  std::vector<Pair> candidates_;
};

/// Brute force; `spoil(answer, scene, boxes, before)` then removes some wanted pairs.
template <class Spoil>
class LossyBruteForce final : public BoxBroadPhase {
 public:
  explicit LossyBruteForce(Spoil spoil) : spoil_(spoil) {}

  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    BoxBroadPhase::initialize(scene, first, execution);
    scene_ = scene;
    before_ = boxes();
  }
  void findPairs() override {
    std::vector<Pair> answer;
    for (std::uint32_t b = 0; b < boxes().size(); ++b) {
      for (std::uint32_t a = 0; a < b; ++a) {
        if (scene_.filter.wanted(a, b) && broadmark::overlaps(boxes()[a], boxes()[b])) {
          answer.push_back({a, b});
        }
      }
    }
    spoil_(answer, scene_, boxes(), before_);
    for (const Pair pair : answer) pairs().add(pair.a, pair.b);
    before_ = boxes();
  }

 private:
  Spoil spoil_;
  SceneInfo scene_;
  std::vector<Aabb> before_;
};

void losePairAtRemoval(std::vector<Pair>& answer, const SceneInfo&, const std::vector<Aabb>& boxes,
                       const std::vector<Aabb>& before) {
  for (std::size_t body = 0; body < boxes.size(); ++body) {
    if (answer.empty() || !isEmpty(boxes[body]) || isEmpty(before[body])) continue;
    answer.pop_back();
    return;
  }
}

void losePairsOfTwoLayers(std::vector<Pair>& answer, const SceneInfo& scene,
                          const std::vector<Aabb>&, const std::vector<Aabb>&) {
  std::erase_if(answer, [&](const Pair pair) {
    return scene.filter.groupsOf(pair.a).layer != scene.filter.groupsOf(pair.b).layer;
  });
}

class StaleFilter final : public BoxBroadPhase {
 public:
  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    BoxBroadPhase::initialize(scene, first, execution);
    std::vector<std::uint32_t> all(scene.objects);
    std::iota(all.begin(), all.end(), 0U);
    filter_ = scene.filter.of(all);
  }
  void findPairs() override {
    for (const Pair pair : bruteForcePairs(boxes(), filter_)) pairs().add(pair.a, pair.b);
  }

 private:
  CollisionFilter filter_;
};

template <class Spoil>
Algorithm changingVariant(const std::string& id, const std::string& summary, Spoil spoil) {
  return {.id = id,
          .family = "Faulty",
          .summary = summary,
          .traits = {.changing_worlds = ChangingWorlds::native},
          .description = {.principle = "brute force",
                          .optimisations = "",
                          .time = "O(n²)",
                          .space = "O(n + k)",
                          .source = "a test of Broadmark's, wrong on purpose"},
          .create = [spoil] { return std::make_unique<LossyBruteForce<Spoil>>(spoil); }};
}

/// Stores ids in 16 bits.
class ShortIds final : public BoxBroadPhase {
  void findPairs() override {
    for (const Pair pair : sweptPairs(boxes())) {
      pairs().add(static_cast<std::uint16_t>(pair.a), static_cast<std::uint16_t>(pair.b));
    }
  }
};

/// Loses a pair in every frame after the fortieth.
class LateFault final : public BoxBroadPhase {
 public:
  void updateObjects(const Frame& frame) override {
    BoxBroadPhase::updateObjects(frame);
    is_late_ = frame.index > 40;
  }

 private:
  void findPairs() override {
    std::vector<Pair> answer = sweptPairs(boxes());
    if (is_late_ && !answer.empty()) answer.pop_back();
    for (const Pair pair : answer) pairs().add(pair.a, pair.b);
  }

  bool is_late_ = false;
};

template <class Kind>
Algorithm rareVariant(const std::string& id, const std::string& summary) {
  return {.id = id,
          .family = "Faulty",
          .summary = summary,
          .description = {.principle = "sweep",
                          .optimisations = "",
                          .time = "O(n log n + candidates)",
                          .space = "O(n + k)",
                          .source = "a test of Broadmark's, wrong on purpose"},
          .create = [] { return std::make_unique<Kind>(); }};
}

Algorithm staleVariant() {
  Algorithm variant =
      changingVariant("stale-filter", "ignores changes of layers and tags", losePairsOfTwoLayers);
  variant.create = [] { return std::make_unique<StaleFilter>(); };
  return variant;
}

Algorithm variant(const std::string& id, const std::string& summary, Fault fault) {
  return {.id = id,
          .family = "Faulty",
          .summary = summary,
          .traits = {.incremental = true},
          .description = {.principle = "brute force",
                          .optimisations = "fat boxes",
                          .time = "O(n·m), m the number of bodies that left their fat box",
                          .space = "O(n + k)",
                          .source = "a test of Broadmark's, wrong on purpose"},
          .create = [fault] { return std::make_unique<FatBoxes>(fault); }};
}

}  // namespace

std::vector<Algorithm> variants() {
  return {variant("faulty", "loses a pair once in some hundred frames", Fault::missed),
          variant("faulty-extra", "reports false pairs", Fault::extra),
          changingVariant("lossy-removal", "loses a pair when a body vanishes", losePairAtRemoval),
          changingVariant("lossy-layers", "loses all pairs of two layers", losePairsOfTwoLayers),
          staleVariant()};
}

std::vector<Algorithm> rareVariants() {
  return {rareVariant<ShortIds>("short-ids", "wrong with more than 65,536 bodies"),
          rareVariant<LateFault>("late-fault", "wrong after 40 frames")};
}

std::vector<Algorithm> allVariants() {
  std::vector<Algorithm> all = variants();
  for (Algorithm& variant : rareVariants()) all.push_back(std::move(variant));
  return all;
}

}  // namespace broadmark::faulty

BROADMARK_PLUGIN(broadmark::faulty::allVariants);
