// The helper layers above BroadPhase.

#include "broadmark/broad_phase.h"

namespace broadmark {

void PairBroadPhase::initialize(const SceneInfo&, const Frame&, Execution& execution) {
  execution_ = &execution;
  buffers_.resize(static_cast<std::size_t>(execution.threads()));
  runs_.reserve(buffers_.size());
}

void PairBroadPhase::cleanCache() {
  for (PairBuffer& buffer : buffers_) buffer.clear();
  runs_.clear();
}

void PairBroadPhase::publishPairs() {
  runs_.clear();
  for (const PairBuffer& buffer : buffers_) runs_.push_back(buffer.run());
}

void BoxBroadPhase::initialize(const SceneInfo& scene, const Frame& first, Execution& execution) {
  PairBroadPhase::initialize(scene, first, execution);
  updateObjects(first);
}

void BoxBroadPhase::updateObjects(const Frame& frame) {
  boxes_.assign(frame.boxes.begin(), frame.boxes.end());
}

void SimdBroadPhase::initialize(const SceneInfo& scene, const Frame& first, Execution& execution) {
  PairBroadPhase::initialize(scene, first, execution);
  updateObjects(first);
}

void SimdBroadPhase::updateObjects(const Frame& frame) { arrays_.assign(frame.boxes); }

}  // namespace broadmark
