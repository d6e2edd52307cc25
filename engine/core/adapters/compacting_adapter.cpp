// Changing worlds, for algorithms that handle only boxes.
//
// The bodies that take part get contiguous indices, and the algorithm sees only these bodies:
// O(changed bodies) a frame. Its pairs are mapped back to body ids, and unwanted pairs are dropped:
// O(pairs).
//
// Bodies without possible partners are filtered out beforehand. A body takes no part if all layers
// that collide with its own are empty. Bodies of non-colliding layers (a level, say) take no part
// either while no body that collides with them is near: O(their number) in a frame with changes.
// Worlds are put side by side.

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "adapters/occupancy_bitmap.h"
#include "adapters/remapping_debug_draw.h"
#include "adapters/world_lattice.h"
#include "broadmark/adapters.h"
#include "broadmark/non_colliding_layers.h"

namespace broadmark {
namespace {

/// Wraps an algorithm that accepts another number of bodies in each frame.
class CompactingAdapter final : public BroadPhase {
 public:
  explicit CompactingAdapter(std::unique_ptr<BroadPhase> algorithm)
      : algorithm_(std::move(algorithm)) {}

  void visitParameters(const ParameterVisitor& visit) override {
    algorithm_->visitParameters(visit);
  }
  [[nodiscard]] float margin() const override { return algorithm_->margin(); }
  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    team_ = &execution.team();
    margin_ = algorithm_->margin();
    filter_ = scene.filter;
    matrix_ = filter_.matrix();
    std::vector<std::uint32_t> all(scene.objects);
    std::iota(all.begin(), all.end(), 0U);
    findNonColliding(scene, all);
    worlds_.emplace(scene);
    present_.assign(scene.objects, 0);
    places_.assign(scene.objects, kAbsent);
    boxes_.reserve(scene.objects);
    if (worlds_->moves()) true_boxes_.reserve(scene.objects);
    bodies_.reserve(scene.objects);
    changed_.reserve(scene.objects);
    appearing_.reserve(scene.objects);
    applyChanges({first.index, first.boxes, all});
    changed_.clear();
    SceneInfo compacted = scene;
    compacted.all_present = true;
    compacted.filter = {};
    compacted.world = worlds_->world();
    algorithm_->initialize(compacted, {first.index, boxes_, changed_}, execution);
  }

  void updateObjects(const Frame& frame) override {
    applyChanges(frame);
    algorithm_->updateObjects({frame.index, boxes_, changed_});
  }

  void cleanCache() override {
    for (PairBuffer& pairs : pairs_) pairs.clear();
    runs_.clear();
    algorithm_->cleanCache();
  }
  void updateStructures() override { algorithm_->updateStructures(); }
  void searchOverlaps() override {
    algorithm_->searchOverlaps();
    const PairRuns found = algorithm_->overlaps();
    if (pairs_.size() < found.size()) pairs_.resize(found.size());
    team_->run(found.size(), [&](int, Range runs) {
      for (std::size_t i = runs.begin; i < runs.end; ++i) translate(found[i], pairs_[i]);
    });
    runs_.clear();
    for (std::size_t i = 0; i < found.size(); ++i) runs_.push_back(pairs_[i].run());
  }
  [[nodiscard]] PairRuns overlaps() const override { return runs_; }
  [[nodiscard]] TransferTimes transfers() const override { return algorithm_->transfers(); }
  void drawStructure(DebugDraw& draw) const override {
    RemappingDebugDraw renamed(draw, bodies_);
    algorithm_->drawStructure(renamed);
  }

  void visitCounters(const CounterVisitor& visit) const override {
    visit("bodies taking part", boxes_.size());
    algorithm_->visitCounters(visit);
  }
  void visitSetup(const CounterVisitor& visit) const override { algorithm_->visitSetup(visit); }
  [[nodiscard]] std::string validate() const override {
    for (std::size_t place = 0; place < bodies_.size(); ++place) {
      if (places_[bodies_[place]] != place) return "a body is not where it is said to be";
    }
    return algorithm_->validate();
  }

 private:
  static constexpr std::uint32_t kAbsent = 0xFFFF'FFFF;

  void findNonColliding(const SceneInfo& scene, std::span<const std::uint32_t> bodies) {
    const NonCollidingLayers layers(filter_, bodies);
    const auto colliding = static_cast<std::size_t>(std::ranges::count_if(
        bodies, [&](std::uint32_t body) { return layers.collideWith(body); }));
    if (layers.bodyCount() < colliding) return;  // a proximity test would cost more than it saves
    non_colliding_ = layers;
    for (const std::uint32_t body : bodies) {
      if (non_colliding_.contains(body)) non_colliding_bodies_.push_back(body);
      if (non_colliding_.collideWith(body)) colliding_bodies_.push_back(body);
    }
    near_.emplace(scene.world);
  }

  void applyChanges(const Frame& frame) {
    changed_.clear();
    appearing_.clear();
    if (frame.changed->empty()) return;
    const bool layers_changed = countPresent(frame);
    markColliding(frame);
    // Removals first, so that no gap stays and no index is used twice.
    for (const std::uint32_t body : *frame.changed) consider(body, frame.boxes[body]);
    for (const std::uint32_t body : non_colliding_bodies_) consider(body, frame.boxes[body]);
    if (layers_changed) {
      for (std::uint32_t body = 0; body < places_.size(); ++body) consider(body, frame.boxes[body]);
    }
    for (const std::uint32_t body : appearing_) place(body, frame.boxes[body]);
    for (const std::uint32_t body : *frame.changed) {
      if (places_[body] != kAbsent) place(body, frame.boxes[body]);
    }
    std::ranges::sort(changed_);
    changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
    std::erase_if(changed_, [this](std::uint32_t place) { return place >= boxes_.size(); });
  }

  /// Whether a layer has gained its first possible partner, or lost its last one.
  bool countPresent(const Frame& frame) {
    for (const std::uint32_t body : *frame.changed) {
      const std::uint8_t is_there = isEmpty(frame.boxes[body]) ? 0 : 1;
      population_[filter_.layerOf(body)] += is_there;
      population_[filter_.layerOf(body)] -= std::exchange(present_[body], is_there);
    }
    const std::uint32_t before = std::exchange(active_layers_, 0);
    for (std::size_t layer = 0; layer < LayerMatrix::kLayers; ++layer) {
      for (std::size_t other = 0; other < LayerMatrix::kLayers; ++other) {
        const bool has_partner = matrix_.collide(layer, other) && population_[other] > 0;
        active_layers_ |= std::uint32_t{has_partner} << layer;
      }
    }
    return active_layers_ != before;
  }

  void markColliding(const Frame& frame) {
    if (non_colliding_bodies_.empty()) return;
    near_->clear();
    for (const std::uint32_t body : colliding_bodies_) {
      if (present_[body] != 0) near_->mark(frame.boxes[body]);
    }
  }

  [[nodiscard]] bool takesPart(std::uint32_t body, const Aabb& box) {
    if (present_[body] == 0 || (active_layers_ >> filter_.layerOf(body) & 1) == 0) return false;
    return !non_colliding_.contains(body) || near_->isNear(box);
  }

  void consider(std::uint32_t body, const Aabb& box) {
    const bool took_part = places_[body] != kAbsent;
    if (took_part == takesPart(body, box)) return;
    if (took_part) {
      remove(places_[body]);
    } else {
      appearing_.push_back(body);
    }
  }

  void place(std::uint32_t body, const Aabb& box) {
    if (places_[body] == kAbsent) {
      places_[body] = static_cast<std::uint32_t>(boxes_.size());
      boxes_.emplace_back();
      if (worlds_->moves()) true_boxes_.emplace_back();
      bodies_.push_back(body);
    }
    const std::uint32_t place = places_[body];
    boxes_[place] = worlds_->moves() ? worlds_->moved(body, box) : box;
    if (worlds_->moves()) true_boxes_[place] = box;
    changed_.push_back(place);
  }

  /// The last body fills the gap.
  void remove(std::uint32_t place) {
    places_[bodies_[place]] = kAbsent;
    const std::uint32_t last = bodies_.back();
    if (last != bodies_[place]) {
      bodies_[place] = last;
      boxes_[place] = boxes_.back();
      if (worlds_->moves()) true_boxes_[place] = true_boxes_.back();
      places_[last] = place;
      changed_.push_back(place);
    }
    bodies_.pop_back();
    boxes_.pop_back();
    if (worlds_->moves()) true_boxes_.pop_back();
  }

  void translate(PairRun found, PairBuffer& wanted) const {
    wanted.clear();
    Pair* const room = wanted.room(found.size());
    std::size_t count = 0;
    for (const Pair pair : found) {
      if (pair.a >= pair.b || pair.b >= bodies_.size()) [[unlikely]] {
        room[count++] = {kAbsent, kAbsent};  // keeps an invalid pair invalid
        continue;
      }
      const Pair bodies = orderedPair(bodies_[pair.a], bodies_[pair.b]);
      room[count] = bodies;
      count += isWanted(pair, bodies) ? 1 : 0;
    }
    wanted.advance(count);
  }

  /// Rounding of moved boxes can create an overlap: tests the true boxes.
  [[nodiscard]] bool isWanted(Pair places, Pair bodies) const {
    if (!filter_.wanted(bodies.a, bodies.b)) return false;
    return !worlds_->moves() || broadmark::overlaps(enlarged(true_boxes_[places.a], margin_),
                                                    enlarged(true_boxes_[places.b], margin_));
  }

  std::unique_ptr<BroadPhase> algorithm_;
  ThreadTeam* team_ = nullptr;
  float margin_ = 0;
  CollisionFilter filter_;

  // Which bodies take part.
  LayerMatrix matrix_;
  std::vector<std::uint8_t> present_;                           ///< by body: 1 if present
  std::array<std::size_t, LayerMatrix::kLayers> population_{};  ///< present, by layer
  std::uint32_t active_layers_ = 0;   ///< bit by layer: a body that it collides with is present
  NonCollidingLayers non_colliding_;  ///< empty where filtering does not pay
  std::vector<std::uint32_t> non_colliding_bodies_;
  std::vector<std::uint32_t> colliding_bodies_;  ///< bodies that collide with non-colliding layers
  std::optional<OccupancyBitmap> near_;          ///< of the colliding bodies
  std::vector<std::uint32_t> appearing_;         ///< bodies that take part from this frame on

  std::optional<WorldLattice> worlds_;
  std::vector<Aabb> boxes_;             ///< of the participating bodies, side by side, unordered
  std::vector<Aabb> true_boxes_;        ///< the same, unmoved; empty if no box is moved
  std::vector<std::uint32_t> bodies_;   ///< by index: the body's id
  std::vector<std::uint32_t> places_;   ///< by body: its index, or kAbsent
  std::vector<std::uint32_t> changed_;  ///< indices with changed boxes in this frame, ascending
  std::vector<PairBuffer> pairs_;       ///< a buffer for each run of the algorithm's answer
  std::vector<PairRun> runs_;
};

}  // namespace

bool isChangingWorld(const SceneInfo& scene) {
  return !scene.all_present || !scene.filter.wantsAll();
}

std::unique_ptr<BroadPhase> compacted(std::unique_ptr<BroadPhase> algorithm) {
  return std::make_unique<CompactingAdapter>(std::move(algorithm));
}

}  // namespace broadmark
