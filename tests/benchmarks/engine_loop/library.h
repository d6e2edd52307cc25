// The library, with a list of the changed bodies that it trusts (Changes::trusted). The list is
// ascending: otherwise an update sorts it. Boxes are exact. The tree of its queries is refitted by
// the first query of a step, in whose time that counts.
#pragma once

#include <algorithm>
#include <iterator>

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
    came_and_gone_ = step.removed;
    came_and_gone_.insert(came_and_gone_.end(), step.added.begin(), step.added.end());
    for (const std::uint32_t body : came_and_gone_) boxes_[body] = step.boxes[body];
    for (const std::uint32_t body : step.moved) boxes_[body] = step.boxes[body];
    std::ranges::sort(came_and_gone_);
    changed_.clear();
    std::ranges::merge(came_and_gone_, step.moved, std::back_inserter(changed_));
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
  std::vector<std::uint32_t> came_and_gone_;
  std::vector<std::uint32_t> changed_;
  bp::QueryResults<std::uint32_t> bodies_;
  bp::QueryResults<bp::CastHit> hits_;
  PairSet pairs_;  ///< the sum of all events
};

}  // namespace broadmark::benchmarks
