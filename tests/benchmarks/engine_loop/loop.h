// The loop of an engine that finds pairs and answers queries, for several broad phases side by
// side.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <vector>

#include "benchmarks/library_benchmark.h"
#include "broadmark/aabb.h"
#include "broadmark/pair.h"
#include "torture/inputs.h"

namespace broadmark::benchmarks {

/// A step of the loop: the boxes after it, by slot (empty ones are absent), and what has changed.
/// A slot occurs in one of the lists at most, and `moved` is ascending. The first step adds all.
struct Step {
  using Slots = std::vector<std::uint32_t>;

  std::vector<Aabb> boxes;
  Slots removed;
  Slots added;
  Slots moved;
  std::vector<std::uint8_t> is_active;  ///< by slot: added or moved
};

/// The answers to a batch of queries, such that equal answers are equal whatever their order.
struct Answers {
  static constexpr float kMiss = std::numeric_limits<float>::infinity();

  std::vector<std::uint64_t> overlaps;  ///< by box: its bodies, summed up
  std::vector<float> fractions;         ///< by ray: of the closest hit

  void clear(const Batch& batch) {
    overlaps.assign(batch.boxes.size(), 0);
    fractions.assign(batch.rays.size(), kMiss);
  }
  void addOverlap(std::size_t query, std::uint32_t body) {
    overlaps[query] += (body + std::uint64_t{1}) * 0x9E37'79B9'7F4A'7C15;
  }
};

/// A broad phase as an engine uses it.
class LoopBroadPhase {
 public:
  LoopBroadPhase() = default;
  LoopBroadPhase(const LoopBroadPhase&) = delete;
  LoopBroadPhase& operator=(const LoopBroadPhase&) = delete;
  virtual ~LoopBroadPhase() = default;

  // Timed. The step remains valid until the next one.
  virtual void change(const Step& step) = 0;
  virtual void findPairs() = 0;
  /// `answers` are clear.
  virtual void answer(const Batch& batch, Answers& answers) = 0;

  /// Appends the pairs of the step, which may include some that only nearly overlap. Not timed;
  /// called once a step.
  virtual void appendPairs(std::vector<Pair>& pairs) = 0;
  /// Whether the pairs are those of active bodies.
  [[nodiscard]] virtual bool findsActiveOnly() const { return false; }
};

/// Unit cubes, a tenth of the space. A share of them moves in a straight line, by up to 0.05 a step
/// on each axis (3 m/s at 60 Hz, if a cube measures a metre), and is reflected at the borders; the
/// others are at rest. In each step a thousandth of the bodies is removed, and as many are added
/// elsewhere, in slots that became free some steps ago.
class LoopWorld {
 public:
  LoopWorld(std::size_t bodies, double moving)
      : moving_(moving),
        side_(inputs::cubeRoot(10.0 * static_cast<double>(bodies))),
        turnover_(std::max<std::size_t>(1, bodies / 1000)) {
    const std::size_t slots = bodies + 8 * turnover_;
    step_.boxes.assign(slots, kEmptyBox);
    step_.is_active.assign(slots, 0);
    velocities_.resize(slots);
    for (std::uint32_t slot = 0; slot < slots; ++slot) free_.push_back(slot);
    add(bodies);
  }

  [[nodiscard]] const Step& current() const { return step_; }

  void advance() {
    for (Step::Slots* const slots : {&step_.removed, &step_.added, &step_.moved}) slots->clear();
    std::ranges::fill(step_.is_active, std::uint8_t{0});
    remove();
    move();
    add(turnover_);
  }

 private:
  void remove() {
    while (step_.removed.size() < turnover_) {
      const auto slot =
          static_cast<std::uint32_t>(random_.integer(0, static_cast<int>(step_.boxes.size()) - 1));
      if (isEmpty(step_.boxes[slot])) continue;
      step_.boxes[slot] = kEmptyBox;
      step_.removed.push_back(slot);
      free_.push_back(slot);
    }
  }

  void add(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t slot = free_.front();
      free_.pop_front();
      step_.boxes[slot] = inputs::boxAt(random_.inCube(side_), {1, 1, 1});
      velocities_[slot] = {};
      if (random_.uniform(0, 1) < moving_) {
        for (float& v : velocities_[slot]) v = random_.uniform(-0.05F, 0.05F);
      }
      step_.added.push_back(slot);
      step_.is_active[slot] = 1;
    }
  }

  void move() {
    for (std::uint32_t slot = 0; slot < step_.boxes.size(); ++slot) {
      Aabb& box = step_.boxes[slot];
      inputs::Vec3& velocity = velocities_[slot];
      if (isEmpty(box) || velocity == inputs::Vec3{}) continue;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (box.min[axis] < 0) velocity[axis] = std::abs(velocity[axis]);
        if (box.min[axis] > side_) velocity[axis] = -std::abs(velocity[axis]);
      }
      translate(box, velocity);
      step_.moved.push_back(slot);
      step_.is_active[slot] = 1;
    }
  }

  double moving_;
  float side_;
  std::size_t turnover_;
  inputs::Random random_{7, 0};
  Step step_;
  std::vector<inputs::Vec3> velocities_;
  std::deque<std::uint32_t> free_;
};

}  // namespace broadmark::benchmarks
