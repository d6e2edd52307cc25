// Shared base of the wrappers of Bullet's broad phases: converts Bullet's pairs or their changes.
#pragma once

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>

#include <cstdint>
#include <vector>

#include "moved_boxes.h"

namespace broadmark {

/// Passes only changed boxes to Bullet. Body i is the proxy with Bullet's unique id i + 1.
class BulletBroadPhase : public MovedBoxes {
 public:
  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    MovedBoxes::initialize(scene, first, execution);
    wanted_.filter = scene.filter;
  }

  void reportEvents() final { reports_events_ = true; }
  [[nodiscard]] PairEvents events() const final { return {{&began_run_, 1}, {&ended_run_, 1}}; }

 protected:
  /// Pairs added and removed by Bullet, possibly with duplicates.
  struct Changes final : btNullPairCache {
    std::vector<Pair> added;
    std::vector<Pair> removed;

    btBroadphasePair* addOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b) override {
      added.push_back(pairOf(*a, *b));
      return nullptr;
    }
    void* removeOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b,
                                btDispatcher* /*dispatcher*/) override {
      removed.push_back(pairOf(*a, *b));
      return nullptr;
    }
  };

  /// Whether the answer is events; set before initialize().
  [[nodiscard]] bool reportsEvents() const { return reports_events_; }
  /// Calls find(began, ended) to fill two empty vectors with this frame's events, each once.
  template <class Find>
  void findEvents(Find find) {
    began_.clear();
    ended_.clear();
    find(began_, ended_);
    began_run_ = began_;
    ended_run_ = ended_;
  }

  /// Makes Bullet find wanted pairs only.
  void filterPairs(btOverlappingPairCache& cache) {
    if (!wanted_.filter.wantsAll()) cache.setOverlapFilterCallback(&wanted_);
  }

  [[nodiscard]] bool isWanted(Pair pair) const { return wanted_.filter.wanted(pair.a, pair.b); }

  /// Adds the library's pairs for which keep(a, b).
  template <class Keep>
  void addPairs(btOverlappingPairCache& cache, Keep keep) {
    const btBroadphasePairArray& found = cache.getOverlappingPairArray();
    for (int i = 0; i < found.size(); ++i) {
      const std::uint32_t a = bodyOf(*found[i].m_pProxy0);
      const std::uint32_t b = bodyOf(*found[i].m_pProxy1);
      if (keep(a, b)) pairs().add(a, b);
    }
  }

  static std::uint32_t bodyOf(const btBroadphaseProxy& proxy) {
    return static_cast<std::uint32_t>(proxy.m_uniqueId) - 1;
  }
  static Pair pairOf(const btBroadphaseProxy& a, const btBroadphaseProxy& b) {
    return orderedPair(bodyOf(a), bodyOf(b));
  }

 private:
  struct Wanted final : btOverlapFilterCallback {
    CollisionFilter filter;

    bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
      return filter.wanted(bodyOf(*a), bodyOf(*b));
    }
  };

  Wanted wanted_;
  bool reports_events_ = false;
  std::vector<Pair> began_;
  std::vector<Pair> ended_;
  PairRun began_run_;
  PairRun ended_run_;
};

}  // namespace broadmark
