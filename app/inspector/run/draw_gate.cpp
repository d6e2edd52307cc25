#include "inspector/run/draw_gate.h"

namespace broadmark {

void DrawGate::beginTiming() {
  std::unique_lock lock(mutex_);
  timing_waits_ = true;
  changed_.wait(lock, [this] { return !drawing_ && !(drawing_waits_ && last_ == Side::timing); });
  timing_waits_ = false;
  timing_ = true;
  disturbed_ = false;
  last_ = Side::timing;
  timing_since_ = Clock::now();
}

bool DrawGate::endTiming() {
  const std::lock_guard lock(mutex_);
  timing_ = false;
  changed_.notify_all();
  return disturbed_;
}

void DrawGate::beginDrawing() {
  std::unique_lock lock(mutex_);
  drawing_waits_ = true;
  const auto free = [this] { return !timing_ && !(timing_waits_ && last_ == Side::drawing); };
  // A turn that has just begun gets its whole time.
  const auto deadline = (timing_ ? timing_since_ : Clock::now()) + kPatience;
  changed_.wait_until(lock, deadline, free);
  while (timing_ && Clock::now() < timing_since_ + kPatience) {
    changed_.wait_until(lock, timing_since_ + kPatience, [this] { return !timing_; });
  }
  drawing_waits_ = false;
  drawing_ = true;
  disturbed_ |= timing_;
  last_ = Side::drawing;
}

void DrawGate::endDrawing() {
  const std::lock_guard lock(mutex_);
  drawing_ = false;
  changed_.notify_all();
}

}  // namespace broadmark
