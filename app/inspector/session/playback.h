// What is played: which footage, at which frame, and how it moves on.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "broadmark/frame.h"
#include "inspector/run/run_thread.h"

namespace broadmark {

class Playback {
 public:
  /// Shows other footage, from frame 0 on.
  void show(FootageRequest footage);
  /// Returns to what has been shown before.
  void showAgain(std::shared_ptr<const FootageRequest> footage, std::uint32_t frame);

  // Frames out of range are clamped.
  /// Plays or pauses. After the last frame it plays from the first.
  void play(bool on);
  void pause() { playing_ = false; }
  void seek(std::int64_t frame);
  /// Pauses, and goes to a frame.
  void goTo(std::int64_t frame);
  /// Likewise, so many frames on; back if negative.
  void step(int frames) { goTo(std::int64_t{frame_} + frames); }

  /// Takes note of what is open. Returns whether that is the wished footage.
  bool follow(const RunProgress& progress);
  /// Whether the wished frame is computed and shown.
  [[nodiscard]] bool hasReached(const RunProgress& progress) const;
  /// While it plays: moves on by `seconds`. Call it only when the wished frame is reached.
  void advance(double seconds);

  /// Takes note that `seconds` have passed.
  void passTime(double seconds);
  /// How many frames were shown per second of late; nothing while it does not play.
  [[nodiscard]] std::optional<double> achieved() const { return achieved_; }

  /// The wished footage; null: none.
  [[nodiscard]] const std::shared_ptr<const FootageRequest>& footage() const { return footage_; }
  /// The wished frame.
  [[nodiscard]] std::uint32_t frame() const { return frame_; }
  /// Of the footage, once it is open.
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
  std::shared_ptr<const FootageRequest> footage_;
  std::uint32_t frame_ = 0;
  SceneInfo scene_;
  bool scene_known_ = false;  ///< the footage has been opened
  bool playing_ = false;
  double due_ = 0;  ///< of the next frame, as a share of its time
  std::optional<double> achieved_;
  double counted_seconds_ = 0;
  int counted_frames_ = 0;
};

}  // namespace broadmark
