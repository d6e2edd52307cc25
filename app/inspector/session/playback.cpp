#include "inspector/session/playback.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace broadmark {
namespace {

/// Over so many seconds the frames that are shown are counted.
constexpr double kCountedSeconds = 1;
/// What cannot keep pace leaves out no more than this.
constexpr double kMostFramesAtOnce = 4;

}  // namespace

void Playback::show(FootageRequest footage) {
  footage_ = std::make_shared<const FootageRequest>(std::move(footage));
  frame_ = 0;
  due_ = 0;
  scene_ = {};
  scene_known_ = false;
  on_show();
}

void Playback::showAgain(std::shared_ptr<const FootageRequest> footage, std::uint32_t frame) {
  footage_ = std::move(footage);
  frame_ = frame;
  scene_known_ = false;
}

void Playback::play(bool on) {
  if (on && frame_ == scene_.frames && scene_.frames > 0) frame_ = 0;
  if (on) on_move(true);
  playing_ = on;
  due_ = 0;
}

void Playback::seek(std::int64_t frame) {
  // What is only being opened may have any number of frames; follow() sets it right then.
  const std::int64_t last = scene_known_ ? scene_.frames : std::numeric_limits<std::int32_t>::max();
  const auto wanted = static_cast<std::uint32_t>(std::clamp<std::int64_t>(frame, 0, last));
  on_move(wanted > frame_);
  frame_ = wanted;
}

void Playback::goTo(std::int64_t frame) {
  pause();
  seek(frame);
}

bool Playback::follow(const RunProgress& progress) {
  if (!footage_ || progress.footage != footage_) return false;
  scene_ = progress.scene;
  scene_known_ = true;
  frame_ = std::min(frame_, scene_.frames);
  return true;
}

bool Playback::hasReached(const RunProgress& progress) const {
  return progress.doing.empty() && progress.snapshot && progress.snapshot->footage == footage_ &&
         progress.snapshot->frame == frame_;
}

void Playback::passTime(double seconds) {
  if (!playing_) {
    achieved_.reset();
    counted_seconds_ = 0;
    counted_frames_ = 0;
    return;
  }
  counted_seconds_ += seconds;
  if (counted_seconds_ < kCountedSeconds) return;
  achieved_ = counted_frames_ / counted_seconds_;
  counted_seconds_ = 0;
  counted_frames_ = 0;
}

void Playback::advance(double seconds) {
  if (!playing_) return;
  due_ += seconds * frames_per_second;
  if (due_ < 1) return;
  const double frames = std::floor(due_);
  due_ = std::min(due_ - frames, 1.0);
  ++counted_frames_;
  if (frame_ < scene_.frames) {
    seek(frame_ + static_cast<std::int64_t>(std::min(frames, kMostFramesAtOnce)));
  } else if (loop) {
    frame_ = 0;
  } else {
    pause();
  }
}

}  // namespace broadmark
