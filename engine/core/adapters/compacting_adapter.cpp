// Changing worlds for algorithms that handle only boxes.
//
// The algorithm sees only the active bodies, under contiguous indices: O(changed bodies) per frame.
// Its pairs are mapped back to body ids, and unwanted pairs are dropped: O(pairs).
//
// Bodies without possible partners are inactive. These are bodies with a layer that collides only
// with empty layers, and bodies of non-colliding layers (static geometry, say) with no colliding
// body near them: O(their number) per frame with changes. Worlds are laid out side by side.

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "adapters/adapter.h"
#include "adapters/mapped_pairs.h"
#include "adapters/occupancy_bitmap.h"
#include "adapters/remapping_debug_draw.h"
#include "adapters/world_lattice.h"
#include "broadmark/adapters.h"
#include "broadmark/non_colliding_layers.h"

namespace broadmark {
namespace {

/// Wraps an algorithm that accepts a varying number of bodies.
class CompactingAdapter final : public Adapter, private PairMap {
 public:
  explicit CompactingAdapter(std::unique_ptr<BroadPhase> algorithm)
      : Adapter(std::move(algorithm)) {}

  [[gnu::cold]] void initialize(const SceneInfo& scene, const Frame& first,
                                ExecutionContext& execution) override {
    team_ = &execution.team();
    margin_ = algorithm_->margin();
    filter_ = scene.filter;
    matrix_ = filter_.matrix();
    for (std::uint32_t body = 0; body < scene.objects; ++body) {
      layers_.push_back(static_cast<std::uint8_t>(filter_.layerOf(body)));
    }
    std::vector<std::uint32_t> all(scene.objects);
    std::iota(all.begin(), all.end(), 0U);
    findNonColliding(scene, all);
    worlds_.emplace(scene);
    present_.assign(scene.objects, 0);
    index_of_.assign(scene.objects, kAbsent);
    boxes_.reserve(scene.objects);
    if (worlds_->translates()) true_boxes_.reserve(scene.objects);
    bodies_.reserve(scene.objects);
    changed_.reserve(scene.objects + std::size_t{1});
    is_changed_.reserve(scene.objects);
    activated_.reserve(scene.objects);
    applyChanges({first.index, first.boxes, all});
    changed_.clear();
    SceneInfo compacted = scene;
    compacted.all_present = true;
    compacted.filter = {};
    compacted.filter_changes = false;
    compacted.world = worlds_->world();
    pairs_.attach(*algorithm_, *this);
    algorithm_->initialize(compacted, {first.index, boxes_, changed_}, execution);
  }

  void updateObjects(const Frame& frame) override {
    if (!frame.filter_changed.empty()) filter_ = *frame.filter;
    applyChanges(frame);
    algorithm_->updateObjects({frame.index, boxes_, changed_});
  }

  void cleanCache() override {
    pairs_.clear();
    algorithm_->cleanCache();
  }
  void searchOverlaps() override {
    algorithm_->searchOverlaps();
    pairs_.collect(*team_);
  }
  [[nodiscard]] PairRuns overlaps() const override { return pairs_.runs(); }
  void drawStructure(DebugDraw& draw) const override {
    RemappingDebugDraw remapped(draw, bodies_);
    algorithm_->drawStructure(remapped);
  }

  void visitCounters(const CounterVisitor& visit) const override {
    visit("bodies taking part", boxes_.size());
    algorithm_->visitCounters(visit);
  }
  [[nodiscard]] std::string validate() const override {
    std::size_t reordered = 0;
    for (std::size_t index = 0; index < bodies_.size(); ++index) {
      if (index_of_[bodies_[index]] != index) return "a body's index is wrong";
      reordered += bodies_[index] != index ? 1 : 0;
    }
    if (reordered != reordered_) return "the number of reordered bodies is wrong";
    return algorithm_->validate();
  }

 private:
  static constexpr std::uint32_t kAbsent = 0xFFFF'FFFF;

  void findNonColliding(const SceneInfo& scene, std::span<const std::uint32_t> bodies) {
    const NonCollidingLayers layers(filter_, bodies);
    const auto colliding = static_cast<std::size_t>(std::ranges::count_if(
        bodies, [&](std::uint32_t body) { return layers.collideWith(layers_[body]); }));
    if (layers.bodyCount() < colliding) return;  // a proximity test would cost more than it saves
    non_colliding_ = layers;
    non_colliding_bodies_.reserve(bodies.size());
    colliding_bodies_.reserve(bodies.size());
    listBodies();
    occupancy_.emplace(scene.world, bodies.size());
  }

  void listBodies() {
    non_colliding_bodies_.clear();
    colliding_bodies_.clear();
    for (std::uint32_t body = 0; body < layers_.size(); ++body) {
      if (non_colliding_.contains(layers_[body])) non_colliding_bodies_.push_back(body);
      if (non_colliding_.collideWith(layers_[body])) colliding_bodies_.push_back(body);
    }
  }

  void applyChanges(const Frame& frame) {
    changed_.clear();
    activated_.clear();
    if (frame.changed->empty() && frame.filter_changed.empty()) return;
    const bool layers_changed = updatePopulation(frame);
    markColliding(frame);
    // Removals first: later insertions then neither leave gaps nor reuse an index.
    for (const std::uint32_t body : *frame.changed) updateActivity(body, frame.boxes[body]);
    for (const std::uint32_t body : non_colliding_bodies_) updateActivity(body, frame.boxes[body]);
    if (layers_changed) {
      for (std::uint32_t body = 0; body < index_of_.size(); ++body)
        updateActivity(body, frame.boxes[body]);
    }
    for (const std::uint32_t body : activated_) store(body, frame.boxes[body]);
    for (const std::uint32_t body : *frame.changed) {
      if (index_of_[body] != kAbsent) store(body, frame.boxes[body]);
    }
    sortChanged();
  }

  /// Ascending, each once, and without those that a removal has moved since.
  void sortChanged() {
    constexpr std::size_t kMaxSortedShare = 32;  // about where a sort costs as much
    if (kMaxSortedShare * changed_.size() < boxes_.size()) {
      std::ranges::sort(changed_);
      changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
      std::erase_if(changed_, [this](std::uint32_t index) { return index >= boxes_.size(); });
      return;
    }
    is_changed_.assign(boxes_.size(), 0);
    for (const std::uint32_t index : changed_) {
      if (index < is_changed_.size()) is_changed_[index] = 1;
    }
    changed_.resize(is_changed_.size() + 1);  // written before it is known whether it counts
    std::size_t count = 0;
    for (std::size_t index = 0; index < is_changed_.size(); ++index) {
      changed_[count] = static_cast<std::uint32_t>(index);
      count += is_changed_[index];
    }
    changed_.resize(count);
  }

  /// Returns whether a layer gained its first possible partner, or lost its last one, or a body has
  /// another layer: in a LiveFilter, at the latest when its box changes.
  bool updatePopulation(const Frame& frame) {
    bool layers_changed = false;
    bool population_changed = false;
    for (const std::span<const std::uint32_t> bodies : {*frame.changed, frame.filter_changed}) {
      for (const std::uint32_t body : bodies) {
        const auto layer = static_cast<std::uint8_t>(filter_.layerOf(body));
        const std::uint8_t present = isEmpty(frame.boxes[body]) ? 0 : 1;
        layers_changed |= layer != layers_[body];
        population_changed |= present != present_[body];
        population_[layer] += present;
        population_[std::exchange(layers_[body], layer)] -= std::exchange(present_[body], present);
      }
    }
    if (!layers_changed && !population_changed) return false;
    if (layers_changed && occupancy_) listBodies();
    const std::uint32_t before = std::exchange(active_layers_, 0);
    for (std::size_t layer = 0; layer < LayerMatrix::kLayers; ++layer) {
      for (std::size_t other = 0; other < LayerMatrix::kLayers; ++other) {
        const bool has_partner = matrix_.collide(layer, other) && population_[other] > 0;
        active_layers_ |= std::uint32_t{has_partner} << layer;
      }
    }
    return layers_changed || active_layers_ != before;
  }

  void markColliding(const Frame& frame) {
    if (non_colliding_bodies_.empty()) return;
    occupancy_->clear();
    for (const std::uint32_t body : colliding_bodies_) {
      if (present_[body] != 0) occupancy_->mark(frame.boxes[body]);
    }
  }

  [[nodiscard]] bool isActive(std::uint32_t body, const Aabb& box) {
    if (present_[body] == 0 || (active_layers_ >> layers_[body] & 1) == 0) return false;
    return !non_colliding_.contains(layers_[body]) || occupancy_->isNear(box);
  }

  void updateActivity(std::uint32_t body, const Aabb& box) {
    const bool was_active = index_of_[body] != kAbsent;
    if (was_active == isActive(body, box)) return;
    if (was_active) {
      remove(index_of_[body]);
    } else {
      activated_.push_back(body);
    }
  }

  void store(std::uint32_t body, const Aabb& box) {
    if (index_of_[body] == kAbsent) {
      index_of_[body] = static_cast<std::uint32_t>(boxes_.size());
      boxes_.emplace_back();
      if (worlds_->translates()) true_boxes_.emplace_back();
      bodies_.push_back(body);
      reordered_ += bodies_.size() - 1 != body ? 1 : 0;
    }
    const std::uint32_t index = index_of_[body];
    boxes_[index] = worlds_->translates() ? worlds_->translated(body, box) : box;
    if (worlds_->translates()) true_boxes_[index] = box;
    changed_.push_back(index);
  }

  /// The last body fills the gap.
  void remove(std::uint32_t index) {
    index_of_[bodies_[index]] = kAbsent;
    const std::uint32_t last = bodies_.back();
    reordered_ -= last != bodies_.size() - 1 ? 1 : 0;
    if (last != bodies_[index]) {
      reordered_ -= bodies_[index] != index ? 1 : 0;
      reordered_ += last != index ? 1 : 0;
      bodies_[index] = last;
      boxes_[index] = boxes_.back();
      if (worlds_->translates()) true_boxes_[index] = true_boxes_.back();
      index_of_[last] = index;
      changed_.push_back(index);
    }
    bodies_.pop_back();
    boxes_.pop_back();
    if (worlds_->translates()) true_boxes_.pop_back();
  }

  [[nodiscard]] std::size_t map(std::span<Pair> pairs) const override {
    std::size_t mapped = pairs.size();
    if (worlds_->translates()) {
      mapped =
          mapInPlace(pairs, bodies_, [this](Pair indices) { return trueBoxesOverlap(indices); });
    } else if (reordered_ > 0 || bodies_.size() < index_of_.size()) {
      mapped = mapInPlace(pairs, bodies_, [](Pair) { return true; });
    }
    return filter_.retainWanted(pairs.first(mapped));
  }

  /// Rounding of translated boxes can create an overlap.
  [[nodiscard]] bool trueBoxesOverlap(Pair indices) const {
    return broadmark::overlaps(enlarged(true_boxes_[indices.a], margin_),
                               enlarged(true_boxes_[indices.b], margin_));
  }

  ThreadTeam* team_ = nullptr;
  float margin_ = 0;
  CollisionFilter filter_;

  // The criteria for active bodies.
  LayerMatrix matrix_;
  std::vector<std::uint8_t> layers_;                            ///< by body
  std::vector<std::uint8_t> present_;                           ///< by body: 1 if present
  std::array<std::size_t, LayerMatrix::kLayers> population_{};  ///< present bodies, by layer
  std::uint32_t active_layers_ = 0;   ///< bit per layer: a possible partner is present
  NonCollidingLayers non_colliding_;  ///< empty if filtering does not pay
  std::vector<std::uint32_t> non_colliding_bodies_;
  std::vector<std::uint32_t> colliding_bodies_;  ///< bodies that collide with non-colliding layers
  std::optional<OccupancyBitmap> occupancy_;     ///< of the colliding bodies
  std::vector<std::uint32_t> activated_;         ///< bodies newly active in this frame

  std::optional<WorldLattice> worlds_;
  std::vector<Aabb> boxes_;               ///< of the active bodies, unordered
  std::vector<Aabb> true_boxes_;          ///< the same, untranslated; empty if no box is translated
  std::vector<std::uint32_t> bodies_;     ///< body id, by index
  std::vector<std::uint32_t> index_of_;   ///< index by body id; kAbsent: inactive
  std::size_t reordered_ = 0;             ///< active bodies with another index than their id
  std::vector<std::uint32_t> changed_;    ///< indices with changed boxes in this frame, ascending
  std::vector<std::uint8_t> is_changed_;  ///< by index, for sortChanged()
  MappedPairs pairs_;
};

}  // namespace

bool isChangingWorld(const SceneInfo& scene) {
  return !scene.all_present || !scene.filter.wantsAll() || scene.filter_changes ||
         scene.periodic.repeats();
}

std::unique_ptr<BroadPhase> compacted(std::unique_ptr<BroadPhase> algorithm) {
  return std::make_unique<CompactingAdapter>(std::move(algorithm));
}

}  // namespace broadmark
