// Bullet's btDbvtBroadphase as its worlds use it: boxes enlarged by 0.05, and a cache of all pairs,
// of which each step tests a tenth for separation. By default each body that leaves its box queries
// the trees at once, as a part of the change; deferred, the trees are traversed against each other
// once a step.
#pragma once

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

#include "benchmarks/engine_loop/loop.h"

namespace broadmark::benchmarks {

class BulletLoop final : public LoopBroadPhase {
 public:
  explicit BulletLoop(bool deferred) { broad_phase_.m_deferedcollide = deferred; }
  ~BulletLoop() override {
    // destroyProxy() would search all pairs for each body.
    for (btBroadphaseProxy* const proxy : proxies_) {
      if (proxy != nullptr) btAlignedFree(proxy);
    }
  }

  void change(const Step& step) override {
    boxes_ = &step.boxes;
    proxies_.resize(step.boxes.size(), nullptr);
    for (const std::uint32_t body : step.removed) {
      broad_phase_.destroyProxy(proxies_[body], nullptr);
      proxies_[body] = nullptr;
    }
    for (const std::uint32_t body : step.added) {
      const Aabb& box = step.boxes[body];
      proxies_[body] = broad_phase_.createProxy(vectorOf(box.min.data()), vectorOf(box.max.data()),
                                                0, reinterpret_cast<void*>(std::uintptr_t{body}),
                                                btBroadphaseProxy::DefaultFilter,
                                                btBroadphaseProxy::AllFilter, nullptr);
    }
    for (const std::uint32_t body : step.moved) {
      const Aabb& box = step.boxes[body];
      broad_phase_.setAabb(proxies_[body], vectorOf(box.min.data()), vectorOf(box.max.data()),
                           nullptr);
    }
  }

  void findPairs() override { broad_phase_.calculateOverlappingPairs(nullptr); }

  void answer(const Batch& batch, Answers& answers) override {
    for (std::size_t i = 0; i < batch.boxes.size(); ++i) {
      const bp::Box& box = batch.boxes[i].box;
      BoxCallback callback(*boxes_, aabbOf(box), i, answers);
      broad_phase_.aabbTest(vectorOf(box.min), vectorOf(box.max), callback);
    }
    for (std::size_t i = 0; i < batch.rays.size(); ++i) {
      const bp::Cast& ray = batch.rays[i];
      RayCallback callback(*boxes_, ray, answers.fractions[i]);
      const btVector3 from = vectorOf(ray.box.min);
      broad_phase_.rayTest(from, from + vectorOf(ray.direction), callback);
    }
  }

  void appendPairs(std::vector<Pair>& pairs) override {
    const btBroadphasePairArray& found =
        broad_phase_.getOverlappingPairCache()->getOverlappingPairArray();
    for (int i = 0; i < found.size(); ++i) {
      pairs.push_back(orderedPair(bodyOf(*found[i].m_pProxy0), bodyOf(*found[i].m_pProxy1)));
    }
  }

 private:
  static btVector3 vectorOf(const float* xyz) { return {xyz[0], xyz[1], xyz[2]}; }
  static std::uint32_t bodyOf(const btBroadphaseProxy& proxy) {
    return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(proxy.m_clientObject));
  }

  struct BoxCallback final : btBroadphaseAabbCallback {
    BoxCallback(const std::vector<Aabb>& all, const Aabb& queried, std::size_t index, Answers& to)
        : boxes(all), box(queried), query(index), answers(to) {}
    bool process(const btBroadphaseProxy* proxy) override {
      const std::uint32_t body = bodyOf(*proxy);
      if (overlaps(box, boxes[body])) answers.addOverlap(query, body);
      return true;
    }

    const std::vector<Aabb>& boxes;
    Aabb box;
    std::size_t query;
    Answers& answers;
  };

  /// Bullet passes all bodies near the ray, in no order, and ignores what has been hit.
  struct RayCallback final : btBroadphaseRayCallback {
    RayCallback(const std::vector<Aabb>& all, const bp::Cast& cast, float& fraction)
        : boxes(all), ray(cast), closest(fraction) {
      const btVector3 direction = vectorOf(ray.direction);
      m_lambda_max = direction.length();
      for (int axis = 0; axis < 3; ++axis) {
        const btScalar slope = direction[axis] / m_lambda_max;
        m_rayDirectionInverse[axis] = slope == 0 ? btScalar(BT_LARGE_FLOAT) : 1 / slope;
        m_signs[axis] = slope < 0 ? 1 : 0;
      }
    }
    bool process(const btBroadphaseProxy* proxy) override {
      const float fraction = entryOf(boxes[bodyOf(*proxy)], ray.box.min, ray.direction, 0, 1);
      closest = std::min(closest, fraction);
      return true;
    }

    const std::vector<Aabb>& boxes;
    const bp::Cast& ray;
    float& closest;
  };

  const std::vector<Aabb>* boxes_ = nullptr;
  btDbvtBroadphase broad_phase_;
  std::vector<btBroadphaseProxy*> proxies_;  ///< by body
};

}  // namespace broadmark::benchmarks
