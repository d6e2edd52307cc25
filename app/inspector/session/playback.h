// The playback: its source, its current frame, and how it advances.
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
  /// Shows another source, starting at frame 0.
  void show(FrameProviderRequest source) {
    source_ = std::make_shared<const FrameProviderRequest>(std::move(source));
    frame_ = 0;
    frames_due_ = 0;
    scene_ = {};
    scene_loaded_ = false;
    replay_end_.reset();
    on_source_change();
  }

  /// Returns to a previous source and frame.
  void restore(std::shared_ptr<const FrameProviderRequest> source, std::uint32_t frame) {
    source_ = std::move(source);
    frame_ = frame;
    scene_loaded_ = false;
  }

  // Frames out of range are clamped.
  /// Plays or pauses. At the last frame, playing restarts from the first.
  void play(bool on) {
    if (on && frame_ == scene_.frames && scene_.frames > 0) frame_ = 0;
    if (on) on_frame_change(true);
    playing_ = on;
    replay_end_.reset();
    frames_due_ = 0;
  }

  void pause() {
    playing_ = false;
    replay_end_.reset();
  }
  /// Shows the frames from `first` to `last` again, slowly. Cached answers are shown, without
  /// running the algorithms.
  void replay(std::uint32_t first, std::uint32_t last) {
    goTo(first);
    frames_due_ = 0;
    if (frame_ < last) replay_end_ = last;
  }
  void seek(std::int64_t frame) {
    // The number of frames is unknown while the source is being opened; update() clamps it then.
    const std::int64_t last =
        scene_loaded_ ? scene_.frames : std::numeric_limits<std::int32_t>::max();
    const auto target = static_cast<std::uint32_t>(std::clamp<std::int64_t>(frame, 0, last));
    on_frame_change(target > frame_);
    frame_ = target;
  }

  /// Pauses, and seeks a frame.
  void goTo(std::int64_t frame) {
    pause();
    seek(frame);
  }

  /// Pauses, and steps by this number of frames; backwards if negative.
  void step(int frames) { goTo(std::int64_t{frame_} + frames); }

  /// Reads the scene of the open source. Returns whether that source is the requested one.
  bool update(const RunProgress& progress) {
    if (!source_ || progress.source != source_) return false;
    scene_ = progress.scene;
    scene_loaded_ = true;
    frame_ = std::min(frame_, scene_.frames);
    return true;
  }

  /// Whether the requested frame is computed and shown.
  [[nodiscard]] bool hasReached(const RunProgress& progress) const {
    return progress.activity.empty() && progress.snapshot && progress.snapshot->source == source_ &&
           progress.snapshot->frame == frame_;
  }

  /// While playing: measures the frame rate, and advances once the requested frame is reached.
  void advance(const RunProgress& progress, double seconds) {
    if (!playing_) {
      achieved_rate_.reset();
      window_seconds_ = window_frames_ = 0;
      if (replaying() && hasReached(progress)) advanceReplay(seconds);
      return;
    }
    window_seconds_ += seconds;
    if (window_seconds_ >= kRateWindowSeconds) {
      achieved_rate_ = window_frames_ / window_seconds_;
      window_seconds_ = window_frames_ = 0;
    }
    if (!hasReached(progress)) return;
    frames_due_ += seconds * frames_per_second;
    if (frames_due_ < 1) return;
    const double frames = std::floor(frames_due_);
    frames_due_ = std::min(frames_due_ - frames, 1.0);
    ++window_frames_;
    if (frame_ < scene_.frames) {
      seek(frame_ + static_cast<std::int64_t>(std::min(frames, kMaxFramesPerStep)));
    } else if (loop) {
      frame_ = 0;
    } else {
      pause();
    }
  }
  /// Frames shown per second recently; nothing while paused.
  [[nodiscard]] std::optional<double> achievedRate() const { return achieved_rate_; }

  /// The requested source; null: none.
  [[nodiscard]] const std::shared_ptr<const FrameProviderRequest>& source() const {
    return source_;
  }
  /// The requested frame.
  [[nodiscard]] std::uint32_t frame() const { return frame_; }
  /// The scene of the source, once it is open.
  [[nodiscard]] const SceneInfo& scene() const { return scene_; }
  [[nodiscard]] std::uint32_t lastFrame() const { return scene_.frames; }
  [[nodiscard]] bool playing() const { return playing_; }
  [[nodiscard]] bool replaying() const { return replay_end_.has_value(); }

  bool loop = false;
  ParameterValues reading;        ///< options that change the boxes of sources
  double frames_per_second = 30;  ///< upper limit; algorithms may be slower

  // Set by the owner.
  std::function<void()> on_source_change;
  /// Called by play() and seek(). `forward`: to later frames.
  std::function<void(bool forward)> on_frame_change;

 private:
  /// Averaging window of the achieved frame rate.
  static constexpr double kRateWindowSeconds = 1;
  /// Maximum advance per step; a slow playback skips frames.
  static constexpr double kMaxFramesPerStep = 4;
  static constexpr double kReplayRate = 5;  ///< frames per second

  void advanceReplay(double seconds) {
    frames_due_ += seconds * kReplayRate;
    if (frames_due_ < 1) return;
    frames_due_ = 0;
    seek(frame_ + 1);
    if (frame_ >= *replay_end_) replay_end_.reset();
  }

  std::shared_ptr<const FrameProviderRequest> source_;
  std::uint32_t frame_ = 0;
  SceneInfo scene_;
  bool scene_loaded_ = false;  ///< the source has been opened
  bool playing_ = false;
  std::optional<std::uint32_t> replay_end_;  ///< last frame of a replay; nothing: none
  double frames_due_ = 0;                    ///< elapsed time, in frames
  std::optional<double> achieved_rate_;
  double window_seconds_ = 0;
  int window_frames_ = 0;
};

}  // namespace broadmark
