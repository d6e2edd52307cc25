// Mutual exclusion of drawing and timing, so that drawing does not disturb measurements.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace broadmark {

/// Nothing is drawn while a frame is timed, and no timing starts while something is drawn; under
/// contention the two sides alternate. After kMaxDrawWait drawing proceeds even while a frame is
/// timed; this frame then counts as disturbed.
class DrawGate {
 public:
  static constexpr std::chrono::milliseconds kMaxDrawWait{50};

  void beginTiming();
  /// Returns whether the timing was disturbed by drawing.
  bool endTiming();

  void beginDrawing();
  void endDrawing();

 private:
  using Clock = std::chrono::steady_clock;
  enum class Side { none, timing, drawing };

  std::mutex mutex_;
  std::condition_variable changed_;
  bool timing_ = false;
  bool drawing_ = false;
  bool timing_waits_ = false;
  bool drawing_waits_ = false;
  bool disturbed_ = false;
  Side turn_ = Side::none;  ///< the latest side to start
  Clock::time_point timing_start_;
};

}  // namespace broadmark
