// Box3D's b3DynamicTree, used as Box3D's own broad phase and world use it, which are not public: a
// box is enlarged by 0.05 when a body has left it, and the tree is rebuilt where boxes have
// changed. A move buffer holds the enlarged and new ones; each of these queries the tree for pairs
// that are not known yet. A pair ends when the enlarged boxes separate, which is tested for active
// bodies, as Box3D does when it updates its contacts.
#pragma once

#include <box3d/box3d.h>

#include "benchmarks/engine_loop/loop.h"
#include "broadmark/pair_set.h"

namespace broadmark::benchmarks {

class Box3dLoop final : public LoopBroadPhase {
 public:
  ~Box3dLoop() override { b3DynamicTree_Destroy(&tree_); }

  void change(const Step& step) override {
    step_ = &step;
    proxies_.resize(step.boxes.size());
    fat_boxes_.resize(step.boxes.size(), kEmptyBox);
    for (const std::uint32_t body : step.removed) {
      b3DynamicTree_DestroyProxy(&tree_, proxies_[body]);
      fat_boxes_[body] = kEmptyBox;
    }
    for (const std::uint32_t body : step.added) {
      fatten(body);
      proxies_[body] = b3DynamicTree_CreateProxy(&tree_, boundsOf(fat_boxes_[body]),
                                                 B3_DEFAULT_CATEGORY_BITS, body);
    }
    for (const std::uint32_t body : step.moved) {
      if (contains(fat_boxes_[body], step.boxes[body])) continue;
      fatten(body);
      b3DynamicTree_EnlargeProxy(&tree_, proxies_[body], boundsOf(fat_boxes_[body]));
    }
  }

  void findPairs() override {
    is_buffered_.resize(fat_boxes_.size(), 0);
    for (const std::uint32_t body : buffer_) is_buffered_[body] = 1;
    found_.clear();
    for (const std::uint32_t body : buffer_) {
      querying_ = body;
      b3DynamicTree_Query(&tree_, boundsOf(fat_boxes_[body]), B3_DEFAULT_MASK_BITS, false,
                          &Box3dLoop::findPair, this);
    }
    b3DynamicTree_Rebuild(&tree_, false);
    for (const std::uint32_t body : buffer_) is_buffered_[body] = 0;
    buffer_.clear();
    endPairs();
    pairs_.insert(found_);
  }

  void answer(const Batch& batch, Answers& answers) override {
    for (std::size_t i = 0; i < batch.boxes.size(); ++i) {
      BoxContext context = {step_->boxes, aabbOf(batch.boxes[i].box), i, answers};
      b3DynamicTree_Query(
          &tree_, boundsOf(context.box), B3_DEFAULT_MASK_BITS, false,
          [](int, std::uint64_t body, void* data) {
            const BoxContext& query = *static_cast<BoxContext*>(data);
            if (overlaps(query.box, query.boxes[body])) {
              query.answers.addOverlap(query.index, static_cast<std::uint32_t>(body));
            }
            return true;
          },
          &context);
    }
    for (std::size_t i = 0; i < batch.rays.size(); ++i) {
      RayContext context = {step_->boxes, batch.rays[i], answers.fractions[i]};
      const b3RayCastInput input = {vectorOf(context.ray.box.min), vectorOf(context.ray.direction),
                                    1};
      b3DynamicTree_RayCast(
          &tree_, &input, B3_DEFAULT_MASK_BITS, false,
          [](const b3RayCastInput* clipped, int, std::uint64_t body, void* data) {
            const RayContext& cast = *static_cast<RayContext*>(data);
            const float fraction = entryOf(cast.boxes[body], cast.ray.box.min, cast.ray.direction,
                                           0, clipped->maxFraction);
            if (fraction > clipped->maxFraction) return clipped->maxFraction;
            return cast.closest = fraction;
          },
          &context);
    }
  }

  void appendPairs(std::vector<Pair>& pairs) override {
    pairs.insert(pairs.end(), pairs_.run().begin(), pairs_.run().end());
  }

 private:
  struct BoxContext {
    const std::vector<Aabb>& boxes;
    Aabb box;
    std::size_t index;
    Answers& answers;
  };
  struct RayContext {
    const std::vector<Aabb>& boxes;
    const bp::Cast& ray;
    float& closest;
  };

  static b3Vec3 vectorOf(const float* xyz) { return {xyz[0], xyz[1], xyz[2]}; }
  static b3AABB boundsOf(const Aabb& box) {
    return {vectorOf(box.min.data()), vectorOf(box.max.data())};
  }

  void fatten(std::uint32_t body) {
    fat_boxes_[body] = enlarged(step_->boxes[body], B3_MAX_AABB_MARGIN);
    buffer_.push_back(body);
  }

  static bool findPair(int, std::uint64_t user_data, void* context) {
    Box3dLoop& self = *static_cast<Box3dLoop*>(context);
    const auto body = static_cast<std::uint32_t>(user_data);
    if (body == self.querying_) return true;
    // Both have been enlarged: the one with the lower id finds the pair.
    if (body < self.querying_ && self.is_buffered_[body] != 0) return true;
    const Pair pair = orderedPair(body, self.querying_);
    if (!self.pairs_.contains(pair)) self.found_.push_back(pair);
    return true;
  }

  void endPairs() {
    ended_.clear();
    for (const Pair pair : pairs_.run()) {
      const bool may_end = step_->is_active[pair.a] != 0 || step_->is_active[pair.b] != 0 ||
                           isEmpty(fat_boxes_[pair.a]) || isEmpty(fat_boxes_[pair.b]);
      if (may_end && !overlaps(fat_boxes_[pair.a], fat_boxes_[pair.b])) ended_.push_back(pair);
    }
    pairs_.erase(ended_);
  }

  const Step* step_ = nullptr;
  b3DynamicTree tree_ = b3DynamicTree_Create(16);
  std::vector<int> proxies_;     ///< by body
  std::vector<Aabb> fat_boxes_;  ///< by body
  std::vector<std::uint32_t> buffer_;
  std::vector<std::uint8_t> is_buffered_;  ///< by body, during findPairs()
  std::uint32_t querying_ = 0;
  PairSet pairs_;
  std::vector<Pair> found_;
  std::vector<Pair> ended_;
};

}  // namespace broadmark::benchmarks
