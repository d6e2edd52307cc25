// The visible and the selected range of frames in the timeline.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "inspector/run/run_thread.h"

namespace broadmark {

/// A range of frames, both ends included.
struct FrameSpan {
  std::uint32_t first = 0;
  std::uint32_t last = 0;

  friend bool operator==(const FrameSpan&, const FrameSpan&) = default;
};

/// Zoom and span are reset when the source changes.
class Timeline {
 public:
  /// Sets the source and the current frame. If the frame has changed, scrolls it into view.
  void update(const std::shared_ptr<const FrameProviderRequest>& source, std::uint32_t last_frame,
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

  /// The visible range, possibly fractional; `first` < `last`.
  [[nodiscard]] double first() const { return first_; }
  [[nodiscard]] double last() const { return last_; }
  [[nodiscard]] bool zoomed() const { return last_ - first_ < fullExtent(); }

  /// Zooms in by wheel notches (negative: out), about frame `at`.
  void zoom(double notches, double at) {
    const double extent = clampExtent((last_ - first_) * std::pow(kZoomPerNotch, notches));
    const double fraction = (at - first_) / (last_ - first_);
    show(at - fraction * extent, extent);
  }

  /// Scrolls by this number of frames.
  void scroll(double frames) { show(first_ + frames, last_ - first_); }
  void showAll() { show(0, fullExtent()); }
  /// Zooms to the span, which must exist.
  void showSpan() {
    const double extent = std::max<double>(span_->last - span_->first, kMinFrames);
    const double middle = (static_cast<double>(span_->first) + span_->last) / 2;
    show(middle - extent / 2, extent);
  }

  [[nodiscard]] const std::optional<FrameSpan>& span() const { return span_; }
  /// Selects the frames between both ends, given in any order. Excludes frame 0, which is not
  /// timed.
  void select(double from, double to) {
    if (last_frame_ == 0) return;
    const auto frame = [&](double at) {
      return static_cast<std::uint32_t>(std::clamp<double>(std::round(at), 1, fullExtent()));
    };
    span_ = {.first = frame(std::min(from, to)), .last = frame(std::max(from, to))};
  }

  void clearSpan() { span_.reset(); }

  double budget_ms = 16.7;  ///< time budget per frame; 0: none

 private:
  static constexpr double kMinFrames = 4;  ///< minimum visible range
  static constexpr double kZoomPerNotch = 0.8;
  static constexpr double kMargin = 0.1;  ///< beyond a frame scrolled into view, as a fraction

  /// Length of the whole timeline.
  [[nodiscard]] double fullExtent() const { return std::max<double>(last_frame_, 1); }
  /// Clamps the length of the visible range.
  [[nodiscard]] double clampExtent(double extent) const {
    return std::clamp(extent, std::min(kMinFrames, fullExtent()), fullExtent());
  }

  void show(double first, double extent) {
    extent = clampExtent(extent);
    first_ = std::clamp(first, 0.0, fullExtent() - extent);
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
