// Checking answers, stopping at a wrong one, and going on to the next.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "inspector/run/run_thread.h"
#include "inspector/session/body_selection.h"
#include "inspector/session/lanes.h"
#include "inspector/session/notices.h"
#include "inspector/session/playback.h"

namespace broadmark {

class Mismatches {
 public:
  /// The parts it acts on outlive it.
  Mismatches(Playback& playback, Lanes& lanes, BodySelection& selection, Notices& notices)
      : playback_(playback), lanes_(lanes), selection_(selection), notices_(notices) {}

  /// Takes note of a stop, and visits the first wrong pair once the frame is seen.
  void advance(const RunProgress& progress);

  /// Goes on to the next frame in which an algorithm is wrong, running what has not been run yet.
  void goToNext(const RunProgress& progress);
  /// Whether it is on the way to one.
  [[nodiscard]] bool searching() const { return searching_; }
  /// Stays where the algorithms have got to.
  void endSearch(const RunProgress& progress);

  /// To be called when the user moves to another frame, which ends a search. After going on from a
  /// mismatch that mismatch is known.
  void moved(bool forward);
  /// To be called when the lanes have changed: forgets at which frame it stopped.
  void forgetStop();
  /// To be called when other footage is shown: forgets everything.
  void reset();

  /// See Wish.
  [[nodiscard]] std::optional<std::uint32_t> known() const { return known_; }

  bool check = true;             ///< compare every answer with the oracle's
  bool stop_at_mismatch = true;  ///< while checking

 private:
  void noticeStop(const RunProgress& progress);
  void visitStop(const Snapshot& seen);

  Playback& playback_;
  Lanes& lanes_;
  BodySelection& selection_;
  Notices& notices_;
  std::optional<std::uint32_t> known_;
  std::optional<RunProgress::Stop> noticed_;
  std::optional<RunProgress::Stop> to_visit_;  ///< stopped at, not seen yet
  bool searching_ = false;
};

/// The next frame after `frame` in which a lane is known to be wrong.
std::optional<RunProgress::Stop> nextKnownMismatch(const std::vector<LaneReport>& lanes,
                                                   std::uint32_t frame);

}  // namespace broadmark
