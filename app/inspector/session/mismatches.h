// Checking of answers: stops at mismatches, and searches for the next one.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "inspector/run/run_thread.h"
#include "inspector/session/body_selection.h"
#include "inspector/session/display_options.h"
#include "inspector/session/notices.h"
#include "inspector/session/playback.h"
#include "inspector/session/track_list.h"
#include "inspector/session/wrong_pair.h"

namespace broadmark {

/// Returns the next frame after `frame` in which a track has a recorded mismatch.
inline std::optional<RunProgress::Stop> nextRecordedMismatch(const std::vector<TrackReport>& tracks,
                                                             std::uint32_t frame) {
  std::optional<RunProgress::Stop> next;
  for (const TrackReport& track : tracks) {
    for (std::uint32_t index = frame + 1; index <= track.frames.size(); ++index) {
      if (!track.frames[index - 1].mismatch) continue;
      if (!next || index < next->frame) next = {.frame = index, .track = track.spec.number};
      break;
    }
  }
  return next;
}

class Mismatches {
 public:
  /// The arguments must outlive this object.
  Mismatches(Playback& playback, TrackList& tracks, BodySelection& selection,
             DisplayOptions& display, Notices& notices)
      : playback_(playback),
        tracks_(tracks),
        selection_(selection),
        display_(display),
        notices_(notices) {}

  /// Handles a stop: shows its frame, then flies to the first wrong pair. An error of a track also
  /// stops the playback.
  void advance(const RunProgress& progress) {
    handleStop(progress);
    handleErrors(progress);
    if (examined_ && selection_.bodies() != bodiesOf(examined_->pair)) endExamination();
    if (!playback_.hasReached(progress)) return;
    flyToStop(*progress.snapshot);
    if (std::exchange(searching_, false)) {
      notices_.setStatus(fmt::format("no further mismatch up to frame {}", playback_.frame()));
    }
  }

  /// Seeks the next frame with a wrong answer, running further frames if none is recorded.
  void goToNext(const RunProgress& progress) {
    playback_.pause();
    check = stop_at_mismatch = true;
    if (const auto next = nextRecordedMismatch(progress.tracks, playback_.frame())) {
      playback_.seek(next->frame);
      tracks_.show(next->track);
      return;
    }
    playback_.seek(playback_.lastFrame());
    searching_ = true;
  }

  /// Whether a search is running.
  [[nodiscard]] bool searching() const { return searching_; }
  /// Stops at the last frame reached.
  void endSearch(const RunProgress& progress) {
    std::uint32_t reached = progress.snapshot ? progress.snapshot->frame : 0;
    for (const TrackReport& track : progress.tracks) reached = std::max(reached, track.frame);
    playback_.seek(std::min(reached, playback_.frame()));
  }

  /// A wrong pair, and the frame in which it is wrong.
  struct Examined {
    Pair pair;
    std::uint32_t frame = 0;
  };
  /// Selects the pair and flies to it. Bodies are coloured by correctness until another selection.
  void examine(const Examined& wrong) {
    selection_.flyToPair(wrong.pair);
    if (!examined_) {
      former_colouring_ = display_.colouring;
      former_hidden_classes_ = display_.filter.hidden_classes;
    }
    examined_ = wrong;
    display_.colourBy(kColours);
  }
  [[nodiscard]] const std::optional<Examined>& examined() const { return examined_; }
  // Precondition: a pair is examined.
  /// Replays the frames up to the examined pair's, or ends the replay there.
  void toggleReplay() {
    if (playback_.replaying()) {
      playback_.goTo(examined_->frame);
    } else {
      playback_.replay(firstReplayed(), examined_->frame);
    }
  }
  /// First frame of a replay.
  [[nodiscard]] std::uint32_t firstReplayed() const {
    return examined_->frame - std::min(examined_->frame, kReplayedFrames);
  }

  /// Call when the user moves to another frame: ends a search. Moving forward from a mismatch
  /// acknowledges it.
  void onFrameChange(bool forward) {
    if (forward && handled_stop_) acknowledged_ = handled_stop_->frame;
    searching_ = false;
  }

  /// Call when the tracks have changed: clears the stop.
  void clearStop() {
    acknowledged_.reset();
    handled_stop_.reset();
    failed_.clear();
  }

  /// Call when another source is shown: clears all state.
  void reset() {
    clearStop();
    pending_stop_.reset();
    searching_ = false;
    if (std::exchange(source_unchecked_, false)) check = true;
    endExamination();
  }

  /// Checks nothing until another source is shown.
  void uncheckSource() {
    check = false;
    source_unchecked_ = true;
  }

  /// See ViewRequest.
  [[nodiscard]] std::optional<std::uint32_t> acknowledged() const { return acknowledged_; }

  bool check = true;             ///< compare every answer with the oracle's
  bool stop_at_mismatch = true;  ///< while checking

 private:
  /// Number of frames before the examined one that are replayed.
  static constexpr std::uint32_t kReplayedFrames = 10;
  static constexpr std::string_view kColours = "correctness";

  static BodySelection::Bodies bodiesOf(Pair pair) { return {pair.a, pair.b}; }

  /// Restores the colours, unless the user has chosen others.
  void endExamination() {
    if (!std::exchange(examined_, {}) || display_.colourMode().id != kColours) return;
    display_.colourBy(former_colouring_);
    display_.filter.hidden_classes = former_hidden_classes_;
  }

  void handleStop(const RunProgress& progress) {
    if (!progress.stop) {
      handled_stop_.reset();
      return;
    }
    const auto [frame, number] = *progress.stop;
    if (!isCurrent(findTrack(progress.tracks, number))) return;
    const bool is_acknowledged = acknowledged_ && *acknowledged_ >= frame;
    if (is_acknowledged || (handled_stop_ && handled_stop_->frame == frame)) return;
    playback_.goTo(frame);
    tracks_.show(number);
    handled_stop_ = pending_stop_ = progress.stop;
    notices_.raisePanel("Mismatches");
    const TrackEdit* wrong = tracks_.find(number);
    notices_.setStatus(fmt::format("{} is wrong in frame {}",
                                   wrong ? wrong->test_case.algorithm.id : "an algorithm", frame),
                       Severity::error);
  }

  void handleErrors(const RunProgress& progress) {
    if (progress.source != playback_.source()) return;
    for (const TrackReport& track : progress.tracks) {
      if (!isCurrent(&track)) continue;
      if (!hasFailed(track)) {
        std::erase(failed_, track.spec);
        continue;
      }
      if (std::ranges::find(failed_, track.spec) != failed_.end()) continue;
      failed_.push_back(track.spec);
      if (stop_at_mismatch) {
        playback_.goTo(failedFrame(track));
        tracks_.show(track.spec.number);
        notices_.raisePanel("Mismatches");
      }
      notices_.setStatus(fmt::format("{}: {}", track.spec.test_case.algorithm.id, track.reason),
                         Severity::error);
    }
  }

  /// Whether a report is that of a track as it is now, not of its former parameters or build.
  [[nodiscard]] bool isCurrent(const TrackReport* report) const {
    const TrackEdit* const track = report != nullptr ? tracks_.find(report->spec.number) : nullptr;
    return track != nullptr && *track == report->spec;
  }

  void flyToStop(const Snapshot& snapshot) {
    if (!pending_stop_ || !snapshot.checked || snapshot.frame != pending_stop_->frame ||
        snapshot.track != pending_stop_->track) {
      return;
    }
    pending_stop_.reset();
    const std::vector<WrongPair> wrong = wrongPairs(snapshot.difference);
    if (!wrong.empty()) examine({wrong.front().pair, snapshot.frame});
  }

  Playback& playback_;
  TrackList& tracks_;
  BodySelection& selection_;
  DisplayOptions& display_;
  Notices& notices_;
  std::optional<std::uint32_t> acknowledged_;
  std::optional<RunProgress::Stop> handled_stop_;
  std::optional<RunProgress::Stop> pending_stop_;  ///< its pair has not been shown yet
  std::vector<TrackSpec> failed_;                  ///< tracks with errors that have been shown
  bool searching_ = false;
  bool source_unchecked_ = false;
  std::optional<Examined> examined_;
  std::size_t former_colouring_ = 0;  ///< before the examination
  std::uint64_t former_hidden_classes_ = 0;
};

}  // namespace broadmark
