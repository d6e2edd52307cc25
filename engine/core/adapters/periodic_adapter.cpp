// Periodic worlds for algorithms that know nothing of them.
//
//   bodies       0 … n - 1: the wrapped boxes
//   images       n … n + capacity - 1: a slot for each image below the periodic box, of any body;
//                unused slots are absent bodies
//
// A frame updates the slots of changed bodies: O(changed bodies). Slots of images that have gone
// are used again from the next frame on. Without a free slot, their number is doubled and the
// algorithm initialised again. The pairs that it finds are mapped back to bodies: O(pairs). Bodies
// that overlap in several ways would be found several times: one of the pairs of images is kept.

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

#include "adapters/adapter.h"
#include "adapters/mapped_pairs.h"
#include "adapters/remapping_debug_draw.h"
#include "broadmark/adapters.h"

namespace broadmark {
namespace {

/// The scene without a periodic box, with slots for images.
SceneInfo sceneWithImages(SceneInfo scene, std::size_t capacity) {
  scene.periodic = {};
  scene.objects += static_cast<std::uint32_t>(capacity);
  scene.all_present = false;
  scene.filter = {};
  scene.filter_changes = false;
  return scene;
}

class PeriodicAdapter final : public Adapter, private PairMap {
 public:
  PeriodicAdapter(const SceneInfo& scene, InstanceMaker make)
      : Adapter(make(sceneWithImages(scene, 0))), make_(std::move(make)) {}

  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    scene_ = scene;
    filter_ = scene.filter;
    execution_ = &execution;
    bodies_ = scene.objects;
    margin_ = algorithm_->margin();
    boxes_.assign(bodies_, kEmptyBox);
    owners_.resize(bodies_);
    std::iota(owners_.begin(), owners_.end(), 0U);
    axes_.assign(bodies_, 0);
    next_.assign(bodies_, kNone);
    std::size_t images = 0;
    for (const Aabb& box : first.boxes) {
      images += (std::size_t{1} << std::popcount(protrudingAxes(box, scene.periodic))) - 1;
    }
    addSlots(std::max<std::size_t>(2 * images, kMinSlots));
    for (std::uint32_t body = 0; body < bodies_; ++body) update(body, first.boxes[body]);
    startAlgorithm(first.index);
    has_grown_ = false;
  }

  void updateObjects(const Frame& frame) override {
    if (frame.filter != nullptr) filter_ = *frame.filter;
    changed_.clear();
    for (const std::uint32_t body : *frame.changed) update(body, frame.boxes[body]);
    free_.insert(free_.end(), freed_.begin(), freed_.end());
    freed_.clear();
    if (std::exchange(has_grown_, false)) {
      algorithm_ = make_(sceneWithImages(scene_, 0));
      startAlgorithm(frame.index);
    }
    std::ranges::sort(changed_);
    algorithm_->updateObjects({frame.index, boxes_, changed_});
  }

  void searchOverlaps() override {
    algorithm_->searchOverlaps();
    pairs_.collect(execution_->team());
  }
  [[nodiscard]] PairRuns overlaps() const override { return pairs_.runs(); }

  void drawStructure(DebugDraw& draw) const override {
    RemappingDebugDraw remapped(draw, owners_);
    algorithm_->drawStructure(remapped);
  }
  void visitCounters(const CounterVisitor& visit) const override {
    visit("periodic images", slots() - free_.size());
    algorithm_->visitCounters(visit);
  }

 private:
  static constexpr std::uint32_t kNone = kNoBody;
  static constexpr std::size_t kMinSlots = 64;

  void startAlgorithm(std::uint32_t frame) {
    changed_.clear();
    pairs_.attach(*algorithm_, *this);
    algorithm_->initialize(sceneWithImages(scene_, slots()), {frame, boxes_, changed_},
                           *execution_);
  }

  [[nodiscard]] std::size_t map(std::span<Pair> pairs) const override {
    const std::size_t mapped =
        mapInPlace(pairs, owners_, [this](Pair images) { return remains(images); });
    return filter_.retainWanted(pairs.first(mapped));
  }

  [[nodiscard]] std::size_t slots() const { return boxes_.size() - bodies_; }

  void addSlots(std::size_t count) {
    const std::size_t size = boxes_.size() + count;
    boxes_.resize(size, kEmptyBox);
    owners_.resize(size, kNone);
    axes_.resize(size, 0);
    next_.resize(size, kNone);
    free_.reserve(slots());
    freed_.reserve(slots());
    changed_.reserve(size);
    // The lowest slot is used first.
    for (std::size_t i = 1; i <= count; ++i) free_.push_back(static_cast<std::uint32_t>(size - i));
    has_grown_ = true;
  }

  void set(std::uint32_t id, const Aabb& box) {
    if (sameBits(box, boxes_[id])) return;
    boxes_[id] = box;
    changed_.push_back(id);
  }

  /// Brings a body and its images up to date.
  void update(std::uint32_t body, const Aabb& box) {
    set(body, box);
    const unsigned protruding = protrudingAxes(box, scene_.periodic);
    unsigned present = 1;  // bit per combination of axes
    std::uint32_t* link = &next_[body];
    while (*link != kNone) {
      const std::uint32_t slot = *link;
      if ((axes_[slot] & ~protruding) == 0) {
        set(slot, image(box, axes_[slot], scene_.periodic));
        present |= 1U << axes_[slot];
        link = &next_[slot];
      } else {
        set(slot, kEmptyBox);
        owners_[slot] = kNone;
        *link = std::exchange(next_[slot], kNone);
        freed_.push_back(slot);
      }
    }
    for (unsigned axes = 1; axes <= protruding; ++axes) {
      if ((axes & ~protruding) != 0 || (present >> axes & 1) != 0) continue;
      if (free_.empty()) addSlots(slots());
      const std::uint32_t slot = free_.back();
      free_.pop_back();
      owners_[slot] = body;
      axes_[slot] = static_cast<std::uint8_t>(axes);
      next_[slot] = std::exchange(next_[body], slot);
      set(slot, image(box, axes, scene_.periodic));
    }
  }

  /// Of all pairs of images of the same two bodies, one remains.
  [[nodiscard]] bool remains(Pair images) const {
    // A pair within the margin could be one that overlaps in another way, too.
    if (margin_ > 0 && !broadmark::overlaps(boxes_[images.a], boxes_[images.b])) return false;
    return images.b < bodies_ || isFirstOfImages(images);
  }

  /// Whether, along each axis, the bodies overlap in no other way that comes first: neither of them
  /// lower, then the one with the lower id, then the other one.
  [[nodiscard]] bool isFirstOfImages(Pair images) const {
    if (owners_[images.a] > owners_[images.b]) std::swap(images.a, images.b);
    const std::uint32_t a = owners_[images.a];
    const std::uint32_t b = owners_[images.b];
    if (a == b || (axes_[images.a] & axes_[images.b]) != 0) return false;
    const unsigned protruding_a = protrudingAxes(boxes_[a], scene_.periodic);
    const Aabb lower_a = image(boxes_[a], protruding_a, scene_.periodic);
    for (int axis = 0; axis < 3; ++axis) {
      const bool a_is_lower = (axes_[images.a] >> axis & 1) != 0;
      const bool b_is_lower = (axes_[images.b] >> axis & 1) != 0;
      if ((a_is_lower || b_is_lower) && overlapAlong(boxes_[a], boxes_[b], axis)) return false;
      const bool a_protrudes = (protruding_a >> axis & 1) != 0;
      if (b_is_lower && a_protrudes && overlapAlong(lower_a, boxes_[b], axis)) return false;
    }
    return true;
  }
  static bool overlapAlong(const Aabb& a, const Aabb& b, int axis) {
    return a.min[axis] <= b.max[axis] && b.min[axis] <= a.max[axis];
  }

  InstanceMaker make_;
  SceneInfo scene_;
  CollisionFilter filter_;
  ExecutionContext* execution_ = nullptr;
  float margin_ = 0;
  std::uint32_t bodies_ = 0;

  // By id in the algorithm: a body or a slot.
  std::vector<Aabb> boxes_;
  std::vector<std::uint32_t> owners_;  ///< the body
  std::vector<std::uint8_t> axes_;     ///< along which an image lies lower; 0: a body
  std::vector<std::uint32_t> next_;    ///< next image of the same body, or kNone

  std::vector<std::uint32_t> free_;     ///< slots
  std::vector<std::uint32_t> freed_;    ///< slots, in this frame
  std::vector<std::uint32_t> changed_;  ///< ids with other boxes than in the frame before
  bool has_grown_ = false;              ///< there are more slots than the algorithm knows
  MappedPairs pairs_;
};

}  // namespace

std::unique_ptr<BroadPhase> withImages(const SceneInfo& scene, const InstanceMaker& make) {
  return std::make_unique<PeriodicAdapter>(scene, make);
}

}  // namespace broadmark
