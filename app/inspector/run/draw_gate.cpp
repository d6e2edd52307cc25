#include "inspector/run/draw_gate.h"

namespace broadmark {

void DrawGate::beginTiming() {
  std::unique_lock lock(mutex_);
  timing_waits_ = true;
  changed_.wait(lock, [this] { return !drawing_ && !(drawing_waits_ && turn_ == Side::timing); });
  timing_waits_ = false;
  timing_ = true;
  disturbed_ = false;
  turn_ = Side::timing;
  timing_start_ = Clock::now();
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
  const auto may_draw = [this] { return !timing_ && !(timing_waits_ && turn_ == Side::drawing); };
  // A timing that has just started gets its full turn.
  const auto deadline = (timing_ ? timing_start_ : Clock::now()) + kMaxDrawWait;
  changed_.wait_until(lock, deadline, may_draw);
  while (timing_ && Clock::now() < timing_start_ + kMaxDrawWait) {
    changed_.wait_until(lock, timing_start_ + kMaxDrawWait, [this] { return !timing_; });
  }
  drawing_waits_ = false;
  drawing_ = true;
  disturbed_ |= timing_;
  turn_ = Side::drawing;
}

void DrawGate::endDrawing() {
  const std::lock_guard lock(mutex_);
  drawing_ = false;
  changed_.notify_all();
}

}  // namespace broadmark
