// Checking answers, stopping at a wrong one, and going on to the next.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "inspector/run/run_thread.h"
#include "inspector/session/body_selection.h"
#include "inspector/session/notices.h"
#include "inspector/session/playback.h"
#include "inspector/session/track_list.h"
#include "inspector/session/wrong_pair.h"

namespace broadmark {

/// The next frame after `frame` in which a track is known to be wrong.
inline std::optional<RunProgress::Stop> nextKnownMismatch(const std::vector<TrackReport>& tracks,
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
  /// The parts it acts on outlive it.
  Mismatches(Playback& playback, TrackList& tracks, BodySelection& selection, Notices& notices)
      : playback_(playback), tracks_(tracks), selection_(selection), notices_(notices) {}

  /// Takes note of a stop, and visits the first wrong pair once the frame is seen.
  void advance(const RunProgress& progress) {
    noticeStop(progress);
    if (!playback_.hasReached(progress)) return;
    visitStop(*progress.snapshot);
    if (std::exchange(searching_, false)) {
      notices_.say(fmt::format("no further mismatch up to frame {}", playback_.frame()));
    }
  }

  /// Goes on to the next frame in which an algorithm is wrong, running what has not been run yet.
  void goToNext(const RunProgress& progress) {
    playback_.pause();
    check = stop_at_mismatch = true;
    if (const auto next = nextKnownMismatch(progress.tracks, playback_.frame())) {
      playback_.seek(next->frame);
      tracks_.show(next->track);
      return;
    }
    playback_.seek(playback_.lastFrame());
    searching_ = true;
  }

  /// Whether it is on the way to one.
  [[nodiscard]] bool searching() const { return searching_; }
  /// Stays where the algorithms have got to.
  void endSearch(const RunProgress& progress) {
    std::uint32_t reached = progress.snapshot ? progress.snapshot->frame : 0;
    for (const TrackReport& track : progress.tracks) reached = std::max(reached, track.frame);
    playback_.seek(std::min(reached, playback_.frame()));
  }

  /// To be called when the user moves to another frame, which ends a search. After going on from a
  /// mismatch that mismatch is known.
  void moved(bool forward) {
    if (forward && noticed_) known_ = noticed_->frame;
    searching_ = false;
  }

  /// To be called when the tracks have changed: forgets at which frame it stopped.
  void forgetStop() {
    known_.reset();
    noticed_.reset();
  }

  /// To be called when other source is shown: forgets everything.
  void reset() {
    forgetStop();
    to_visit_.reset();
    searching_ = false;
  }

  /// See ViewRequest.
  [[nodiscard]] std::optional<std::uint32_t> known() const { return known_; }

  bool check = true;             ///< compare every answer with the oracle's
  bool stop_at_mismatch = true;  ///< while checking

 private:
  void noticeStop(const RunProgress& progress) {
    if (!progress.stop) {
      noticed_.reset();
      return;
    }
    const auto [frame, number] = *progress.stop;
    const bool is_known = known_ && *known_ >= frame;
    if (is_known || (noticed_ && noticed_->frame == frame)) return;
    playback_.goTo(frame);
    tracks_.show(number);
    noticed_ = to_visit_ = progress.stop;
    notices_.bringUp("Mismatches");
    const TrackEdit* wrong = tracks_.find(number);
    notices_.say(fmt::format("{} is wrong in frame {}",
                             wrong ? wrong->test_case.algorithm.id : "an algorithm", frame),
                 Severity::error);
  }

  void visitStop(const Snapshot& seen) {
    if (!to_visit_ || !seen.checked || seen.frame != to_visit_->frame ||
        seen.track != to_visit_->track) {
      return;
    }
    to_visit_.reset();
    const std::vector<WrongPair> wrong = wrongPairs(seen.difference);
    if (!wrong.empty()) selection_.visit(wrong.front().pair);
  }

  Playback& playback_;
  TrackList& tracks_;
  BodySelection& selection_;
  Notices& notices_;
  std::optional<std::uint32_t> known_;
  std::optional<RunProgress::Stop> noticed_;
  std::optional<RunProgress::Stop> to_visit_;  ///< stopped at, not seen yet
  bool searching_ = false;
};

}  // namespace broadmark
