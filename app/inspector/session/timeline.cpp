#include "inspector/session/timeline.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace broadmark {
namespace {

constexpr double kFewestFrames = 4;  // shown at once
constexpr double kExtentPerTurn = 0.8;
constexpr double kMargin = 0.1;  // share of what is shown, beyond a frame that comes into sight

}  // namespace

double Timeline::whole() const { return std::max<double>(last_frame_, 1); }

void Timeline::follow(const std::shared_ptr<const FootageRequest>& footage,
                      std::uint32_t last_frame, std::uint32_t frame) {
  if (std::exchange(footage_, footage) != footage || last_frame_ != last_frame) {
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

double Timeline::allowed(double extent) const {
  return std::clamp(extent, std::min(kFewestFrames, whole()), whole());
}

void Timeline::show(double first, double extent) {
  extent = allowed(extent);
  first_ = std::clamp(first, 0.0, whole() - extent);
  last_ = first_ + extent;
}

void Timeline::zoom(double turns, double at) {
  const double extent = allowed((last_ - first_) * std::pow(kExtentPerTurn, turns));
  const double share = (at - first_) / (last_ - first_);
  show(at - share * extent, extent);
}

void Timeline::move(double frames) { show(first_ + frames, last_ - first_); }

void Timeline::showAll() { show(0, whole()); }

void Timeline::showSpan() {
  const double extent = std::max<double>(span_->last - span_->first, kFewestFrames);
  const double middle = (static_cast<double>(span_->first) + span_->last) / 2;
  show(middle - extent / 2, extent);
}

void Timeline::select(double from, double to) {
  if (last_frame_ == 0) return;
  const auto frame = [&](double at) {
    return static_cast<std::uint32_t>(std::clamp<double>(std::round(at), 1, whole()));
  };
  span_ = {.first = frame(std::min(from, to)), .last = frame(std::max(from, to))};
}

}  // namespace broadmark
