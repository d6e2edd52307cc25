// Drawing and timing exclude each other, so that neither disturbs the other.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace broadmark {

/// While a frame is being timed nothing is drawn, and while something is drawn no frame begins to
/// be timed; when both sides are eager they alternate. Only a frame that takes longer than
/// kPatience does not keep the other side from drawing; it is then called disturbed.
class DrawGate {
 public:
  static constexpr std::chrono::milliseconds kPatience{50};

  void beginTiming();
  /// Whether something was drawn meanwhile.
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
  Side last_ = Side::none;
  Clock::time_point timing_since_;
};

}  // namespace broadmark
