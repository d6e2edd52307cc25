// Which frames of a recording the timeline shows, and which span of them is selected.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "inspector/run/run_thread.h"

namespace broadmark {

/// Frames in a row, both ends included.
struct FrameSpan {
  std::uint32_t first = 0;
  std::uint32_t last = 0;

  friend bool operator==(const FrameSpan&, const FrameSpan&) = default;
};

/// Zoom and span belong to the source: other source is shown as a whole.
class Timeline {
 public:
  /// Takes note of what is played, and at which frame. A frame that was moved to is in sight from
  /// then on.
  void follow(const std::shared_ptr<const FrameProviderRequest>& source, std::uint32_t last_frame,
              std::uint32_t frame) {
    if (std::exchange(source_, source) != source || last_frame_ != last_frame) {
      last_frame_ = last_frame;
      frame_ = frame;
      clearSpan();
      showAll();
    }
    if (std::exchange(frame_, frame) == frame) return;
    const double extent = last_ - first_;
    if (frame > last_) show(frame - kMargin * extent, extent);
    if (frame < first_) show(frame - (1 - kMargin) * extent, extent);
  }

  /// The frames shown, perhaps only parts of the first and last one; `first` < `last`.
  [[nodiscard]] double first() const { return first_; }
  [[nodiscard]] double last() const { return last_; }
  [[nodiscard]] bool zoomed() const { return last_ - first_ < whole(); }

  /// Zooms in by this number of wheel notches (negative: out); the frame at `at` stays in place.
  void zoom(double turns, double at) {
    const double extent = allowed((last_ - first_) * std::pow(kExtentPerTurn, turns));
    const double share = (at - first_) / (last_ - first_);
    show(at - share * extent, extent);
  }

  /// Scrolls by this number of frames.
  void move(double frames) { show(first_ + frames, last_ - first_); }
  void showAll() { show(0, whole()); }
  /// Shows just the span. There must be one.
  void showSpan() {
    const double extent = std::max<double>(span_->last - span_->first, kMinFrames);
    const double middle = (static_cast<double>(span_->first) + span_->last) / 2;
    show(middle - extent / 2, extent);
  }

  [[nodiscard]] const std::optional<FrameSpan>& span() const { return span_; }
  /// Selects the existing frames between both ends, given in any order. Frame 0 is not timed and
  /// never in a span.
  void select(double from, double to) {
    if (last_frame_ == 0) return;
    const auto frame = [&](double at) {
      return static_cast<std::uint32_t>(std::clamp<double>(std::round(at), 1, whole()));
    };
    span_ = {.first = frame(std::min(from, to)), .last = frame(std::max(from, to))};
  }

  void clearSpan() { span_.reset(); }

  double budget_ms = 16.7;  ///< that a frame may take; 0: any

 private:
  static constexpr double kMinFrames = 4;  // shown at once
  static constexpr double kExtentPerTurn = 0.8;
  static constexpr double kMargin =
      0.1;  // share of what is shown, beyond a frame that comes into sight

  /// How much there is to be shown.
  [[nodiscard]] double whole() const { return std::max<double>(last_frame_, 1); }
  /// The nearest to `extent` frames that can be shown at once.
  [[nodiscard]] double allowed(double extent) const {
    return std::clamp(extent, std::min(kMinFrames, whole()), whole());
  }

  void show(double first, double extent) {
    extent = allowed(extent);
    first_ = std::clamp(first, 0.0, whole() - extent);
    last_ = first_ + extent;
  }

  std::shared_ptr<const FrameProviderRequest> source_;
  std::uint32_t last_frame_ = 0;
  std::uint32_t frame_ = 0;
  double first_ = 0;
  double last_ = 1;
  std::optional<FrameSpan> span_;
};

}  // namespace broadmark
