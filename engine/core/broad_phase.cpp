// The helper layers above BroadPhase.

#include "broadmark/broad_phase.h"

#include <stdexcept>

namespace broadmark {

void PairBroadPhase::initialize(const SceneInfo&, const Frame&, ExecutionContext& execution) {
  execution_ = &execution;
  buffers_.resize(static_cast<std::size_t>(execution.threads()));
  for (PairBuffer& buffer : buffers_) buffer.setMap(map_);
  runs_.reserve(buffers_.size());
}

void PairBroadPhase::cleanCache() {
  for (PairBuffer& buffer : buffers_) buffer.clear();
  runs_.clear();
}

void PairBroadPhase::searchOverlaps() {
  if (execution_ == nullptr) {
    throw std::logic_error("an override of initialize() does not call its base's");
  }
  findPairs();
  collectRuns();
}

void PairBroadPhase::searchQueries(const QueryBatch& batch) {
  findHits(batch);
  collectRuns();
}

void PairBroadPhase::collectRuns() {
  runs_.clear();
  for (PairBuffer& buffer : buffers_) {
    buffer.flush();
    runs_.push_back(buffer.run());
  }
}

void BoxBroadPhase::initialize(const SceneInfo& scene, const Frame& first,
                               ExecutionContext& execution) {
  PairBroadPhase::initialize(scene, first, execution);
  boxes_.assign(first.boxes.begin(), first.boxes.end());
}

void BoxBroadPhase::updateObjects(const Frame& frame) {
  // A small fraction of changed boxes is copied singly, otherwise all are copied.
  constexpr std::size_t kMinUnchangedRatio = 8;
  if (!frame.changed || boxes_.size() != frame.boxes.size() ||
      kMinUnchangedRatio * frame.changed->size() > boxes_.size()) {
    boxes_.assign(frame.boxes.begin(), frame.boxes.end());
  } else {
    for (const std::uint32_t body : *frame.changed) boxes_[body] = frame.boxes[body];
  }
}

void SimdBroadPhase::initialize(const SceneInfo& scene, const Frame& first,
                                ExecutionContext& execution) {
  PairBroadPhase::initialize(scene, first, execution);
  arrays_.assign(first.boxes);
}

void SimdBroadPhase::updateObjects(const Frame& frame) { arrays_.assign(frame.boxes); }

}  // namespace broadmark
