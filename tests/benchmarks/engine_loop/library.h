// The library, which is told what has changed and believes it (Changes::trusted). Boxes are exact.
// The tree of its queries is refitted in the first query of a step, in whose time that counts.
#pragma once

#include "benchmarks/engine_loop/loop.h"

#include "broadmark/pair_set.h"

namespace broadmark::benchmarks {

class LibraryLoop final : public LoopBroadPhase {
 public:
  LibraryLoop(bp::Method method, bp::Answer answer)
      : answer_(answer),
        object_({.method = method, .answer = answer, .changes = bp::Changes::trusted}) {}

  void change(const Step& step) override {
    boxes_.resize(step.boxes.size(), kEmptyBox);
    changed_.clear();
    for (const Step::Slots* const slots : {&step.removed, &step.added, &step.moved}) {
      for (const std::uint32_t body : *slots) boxes_[body] = step.boxes[body];
      changed_.insert(changed_.end(), slots->begin(), slots->end());
    }
  }

  void findPairs() override { object_.update(viewOf(boxes_), changed_); }

  void answer(const Batch& batch, Answers& answers) override {
    object_.overlapping(batch.boxes, bodies_);
    for (std::size_t i = 0; i < batch.boxes.size(); ++i) {
      for (const std::uint32_t body : bodies_[i]) answers.addOverlap(i, body);
    }
    object_.cast(batch.rays, bp::Hits::closest, hits_);
    for (std::size_t i = 0; i < batch.rays.size(); ++i) {
      for (const bp::CastHit& hit : hits_[i]) {
        answers.fractions[i] = static_cast<float>(hit.fraction);
      }
    }
  }

  void appendPairs(std::vector<Pair>& pairs) override {
    const auto append = [](std::span<const bp::Pair> from, std::vector<Pair>& to) {
      for (const bp::Pair pair : from) to.push_back({pair.a, pair.b});
    };
    if (answer_ == bp::Answer::pairs) return append(object_.pairs(), pairs);
    std::vector<Pair> ended;
    std::vector<Pair> began;
    append(object_.ended(), ended);
    append(object_.began(), began);
    pairs_.erase(ended);
    pairs_.insert(began);
    pairs.insert(pairs.end(), pairs_.run().begin(), pairs_.run().end());
  }

 private:
  bp::Answer answer_;
  bp::BroadPhase object_;
  std::vector<Aabb> boxes_;
  std::vector<std::uint32_t> changed_;
  bp::QueryResults<std::uint32_t> bodies_;
  bp::QueryResults<bp::CastHit> hits_;
  PairSet pairs_;  ///< the sum of all events
};

}  // namespace broadmark::benchmarks
