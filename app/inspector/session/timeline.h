// Which frames of a recording the timeline shows, and which span of them is selected.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "inspector/run/run_thread.h"

namespace broadmark {

/// Frames in a row, both ends included.
struct FrameSpan {
  std::uint32_t first = 0;
  std::uint32_t last = 0;

  friend bool operator==(const FrameSpan&, const FrameSpan&) = default;
};

/// Zoom and span belong to the footage: other footage is shown as a whole.
class Timeline {
 public:
  /// Takes note of what is played, and at which frame. A frame that was moved to is in sight from
  /// then on.
  void follow(const std::shared_ptr<const FootageRequest>& footage, std::uint32_t last_frame,
              std::uint32_t frame);

  /// The frames shown, perhaps only parts of the first and last one; `first` < `last`.
  [[nodiscard]] double first() const { return first_; }
  [[nodiscard]] double last() const { return last_; }
  [[nodiscard]] bool zoomed() const { return last_ - first_ < whole(); }

  /// Nearer by so many turns of a wheel (below 0: farther); what is at `at` stays where it is.
  void zoom(double turns, double at);
  /// Shows what lies so many frames later.
  void move(double frames);
  void showAll();
  /// Shows just the span. There must be one.
  void showSpan();

  [[nodiscard]] const std::optional<FrameSpan>& span() const { return span_; }
  /// From one end to the other, in any order, as far as these frames exist. Frame 0 is not timed:
  /// it is never in a span.
  void select(double from, double to);
  void clearSpan() { span_.reset(); }

  double budget_ms = 16.7;  ///< that a frame may take; 0: any

 private:
  /// How much there is to be shown.
  [[nodiscard]] double whole() const;
  /// The nearest to `extent` frames that can be shown at once.
  [[nodiscard]] double allowed(double extent) const;
  void show(double first, double extent);

  std::shared_ptr<const FootageRequest> footage_;
  std::uint32_t last_frame_ = 0;
  std::uint32_t frame_ = 0;
  double first_ = 0;
  double last_ = 1;
  std::optional<FrameSpan> span_;
};

}  // namespace broadmark
