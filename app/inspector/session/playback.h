// What is played: which source, at which frame, and how it moves on.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "broadmark/frame.h"
#include "inspector/run/run_thread.h"

namespace broadmark {

class Playback {
 public:
  /// Shows other source, from frame 0 on.
  void show(FrameProviderRequest source) {
    source_ = std::make_shared<const FrameProviderRequest>(std::move(source));
    frame_ = 0;
    due_ = 0;
    scene_ = {};
    scene_known_ = false;
    on_show();
  }

  /// Returns to what has been shown before.
  void showAgain(std::shared_ptr<const FrameProviderRequest> source, std::uint32_t frame) {
    source_ = std::move(source);
    frame_ = frame;
    scene_known_ = false;
  }

  // Frames out of range are clamped.
  /// Plays or pauses. After the last frame it plays from the first.
  void play(bool on) {
    if (on && frame_ == scene_.frames && scene_.frames > 0) frame_ = 0;
    if (on) on_move(true);
    playing_ = on;
    due_ = 0;
  }

  void pause() { playing_ = false; }
  void seek(std::int64_t frame) {
    // What is only being opened may have any number of frames; follow() sets it right then.
    const std::int64_t last =
        scene_known_ ? scene_.frames : std::numeric_limits<std::int32_t>::max();
    const auto wanted = static_cast<std::uint32_t>(std::clamp<std::int64_t>(frame, 0, last));
    on_move(wanted > frame_);
    frame_ = wanted;
  }

  /// Pauses, and goes to a frame.
  void goTo(std::int64_t frame) {
    pause();
    seek(frame);
  }

  /// Goes on by this number of frames; back if negative.
  void step(int frames) { goTo(std::int64_t{frame_} + frames); }

  /// Takes note of what is open. Returns whether that is the requested source.
  bool follow(const RunProgress& progress) {
    if (!source_ || progress.source != source_) return false;
    scene_ = progress.scene;
    scene_known_ = true;
    frame_ = std::min(frame_, scene_.frames);
    return true;
  }

  /// Whether the requested frame is computed and shown.
  [[nodiscard]] bool hasReached(const RunProgress& progress) const {
    return progress.doing.empty() && progress.snapshot && progress.snapshot->source == source_ &&
           progress.snapshot->frame == frame_;
  }

  /// While it plays: counts frames, and moves on by `seconds` once the requested frame is reached.
  void advance(const RunProgress& progress, double seconds) {
    if (!playing_) {
      achieved_.reset();
      counted_seconds_ = counted_frames_ = 0;
      return;
    }
    counted_seconds_ += seconds;
    if (counted_seconds_ >= kCountedSeconds) {
      achieved_ = counted_frames_ / counted_seconds_;
      counted_seconds_ = counted_frames_ = 0;
    }
    if (!hasReached(progress)) return;
    due_ += seconds * frames_per_second;
    if (due_ < 1) return;
    const double frames = std::floor(due_);
    due_ = std::min(due_ - frames, 1.0);
    ++counted_frames_;
    if (frame_ < scene_.frames) {
      seek(frame_ + static_cast<std::int64_t>(std::min(frames, kMaxFramesAtOnce)));
    } else if (loop) {
      frame_ = 0;
    } else {
      pause();
    }
  }
  /// How many frames were shown per second of late; nothing while it does not play.
  [[nodiscard]] std::optional<double> achieved() const { return achieved_; }

  /// The requested source; null: none.
  [[nodiscard]] const std::shared_ptr<const FrameProviderRequest>& source() const {
    return source_;
  }
  /// The requested frame.
  [[nodiscard]] std::uint32_t frame() const { return frame_; }
  /// Of the source, once it is open.
  [[nodiscard]] const SceneInfo& scene() const { return scene_; }
  [[nodiscard]] std::uint32_t lastFrame() const { return scene_.frames; }
  [[nodiscard]] bool playing() const { return playing_; }

  bool loop = false;
  bool swept = false;             ///< what is opened is shown as swept boxes
  double frames_per_second = 30;  ///< no more; an algorithm may need longer

  // Set by the owner.
  std::function<void()> on_show;
  /// Called by play() and seek(), with whether that leads to later frames.
  std::function<void(bool forward)> on_move;

 private:
  /// Averaging window of the achieved frame rate.
  static constexpr double kCountedSeconds = 1;
  /// What cannot keep pace leaves out no more than this.
  static constexpr double kMaxFramesAtOnce = 4;

  std::shared_ptr<const FrameProviderRequest> source_;
  std::uint32_t frame_ = 0;
  SceneInfo scene_;
  bool scene_known_ = false;  ///< the source has been opened
  bool playing_ = false;
  double due_ = 0;  ///< of the next frame, as a share of its time
  std::optional<double> achieved_;
  double counted_seconds_ = 0;
  int counted_frames_ = 0;
};

}  // namespace broadmark
