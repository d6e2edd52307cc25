// Cases that are wrong, slow or fail on purpose, and a scene for them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "broadmark/harness/runner.h"
#include "engine/helpers.h"

namespace broadmark::tests {

inline constexpr std::uint32_t kChainFrames = 6;
inline constexpr std::uint32_t kFaultyFrame = 3;

/// A chain of bodies that moves as a whole.
class ChainSource final : public IndexedFrames {
 public:
  explicit ChainSource(std::uint32_t objects = 4, std::uint32_t frames = kChainFrames)
      : scene_{"Chain", "Cubes", objects, frames, {{0, 0, 0, 0}, {100, 100, 100, 0}}} {}

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override {
    boxes_ = chain(scene_.objects);
    for (Aabb& box : boxes_) {
      box.min[1] += static_cast<float>(index);
      box.max[1] += static_cast<float>(index);
    }
    return boxes_;
  }

  SceneInfo scene_;
  std::vector<Aabb> boxes_;
};

/// Callbacks and properties of a test algorithm; each can be replaced.
struct Behaviour {
  std::function<void()> on_initialize = [] {};
  std::function<void(std::uint32_t frame)> on_update = [](std::uint32_t) {};
  std::function<void(std::uint32_t frame, std::vector<Pair>&)> on_answer =
      [](std::uint32_t, std::vector<Pair>&) {};
  float margin = 0;
  AlgorithmTraits traits = {};
  std::function<void()> on_destroy = [] {};  // only after initialisation
  std::function<std::uint64_t(std::uint32_t frame)> count_work = {};
};

/// Brute force with a given behaviour.
class Spoilt final : public BoxBroadPhase {
 public:
  explicit Spoilt(Behaviour behaviour) : behaviour_(std::move(behaviour)) {}
  ~Spoilt() override {
    if (initialised_) behaviour_.on_destroy();
  }

  [[nodiscard]] float margin() const override { return behaviour_.margin; }
  void visitParameters(const ParameterVisitor& visit) override {
    visit({.name = "cells", .doc = "does nothing", .value = &cells_, .min = 1, .max = 9});
  }
  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    BoxBroadPhase::initialize(scene, first, execution);
    initialised_ = true;
    behaviour_.on_initialize();
  }
  void updateObjects(const Frame& frame) override {
    BoxBroadPhase::updateObjects(frame);
    frame_ = frame.index;
    behaviour_.on_update(frame_);
  }
  void visitSetup(const CounterVisitor& visit) const override { visit("tables", 5); }
  void visitCounters(const CounterVisitor& visit) const override {
    if (behaviour_.count_work) visit("work", behaviour_.count_work(frame_));
  }

 private:
  void findPairs() override {
    std::vector<Pair> answer = bruteForcePairs(boxes());
    behaviour_.on_answer(frame_, answer);
    std::ranges::copy(answer, pairs().room(answer.size()));
    pairs().advance(answer.size());
  }

  Behaviour behaviour_;
  bool initialised_ = false;
  std::uint32_t frame_ = 0;
  std::int64_t cells_ = 2;
};

inline Case caseOf(const Behaviour& behaviour = {}) {
  Case test_case;
  test_case.algorithm.id = "spoilt";
  test_case.algorithm.family = "Tests";
  test_case.algorithm.traits = behaviour.traits;
  test_case.algorithm.create = [behaviour] { return std::make_unique<Spoilt>(behaviour); };
  return test_case;
}

/// Spoils the answer of one frame.
inline Case spoilingAnswer(std::function<void(std::vector<Pair>&)> spoil) {
  return caseOf({.on_answer = [spoil](std::uint32_t frame, std::vector<Pair>& answer) {
    if (frame == kFaultyFrame) spoil(answer);
  }});
}

inline CaseResult runOnChain(const Case& test_case, const RunPolicy& policy = {},
                             int repetitions = 1) {
  ChainSource source;
  return runCase(test_case, source, policy, repetitions);
}

}  // namespace broadmark::tests
