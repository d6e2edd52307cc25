// Shared base of algorithms with a library that requires notification of moves.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "broadmark/broad_phase.h"

namespace broadmark {

/// Stores the boxes, and the bodies that changed since the frame before, as a game tracks its awake
/// bodies.
class MovedBoxes : public BoxBroadPhase {
 public:
  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    BoxBroadPhase::initialize(scene, first, execution);
    moved_.resize(boxes().size());
    std::iota(moved_.begin(), moved_.end(), 0U);
  }

  void updateObjects(const Frame& frame) override {
    moved_.assign(frame.changed->begin(), frame.changed->end());
    BoxBroadPhase::updateObjects(frame);
  }

  void visitCounters(const CounterVisitor& visit) const override { visit("moves", moved_.size()); }

 protected:
  /// The bodies that moved, appeared or vanished, ascending; after initialize() all.
  [[nodiscard]] const std::vector<std::uint32_t>& moved() const { return moved_; }

 private:
  std::vector<std::uint32_t> moved_;
};

}  // namespace broadmark
