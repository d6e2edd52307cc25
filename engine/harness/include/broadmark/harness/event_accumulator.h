// The set of pairs that events lead to, frame by frame.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "broadmark/pair.h"

namespace broadmark {

/// Keeps the pairs that have begun and not ended. For who is told events and wants all pairs:
/// the one who checks them, for instance.
class EventAccumulator {
 public:
  EventAccumulator() = default;
  EventAccumulator(EventAccumulator&&) = default;
  EventAccumulator& operator=(EventAccumulator&&) = default;

  /// No pair has begun.
  void clear();
  /// Takes the events of the next frame, of a scene with that many bodies. O(k + e log ek), k pairs
  /// and e events; O(1) if there is none.
  void apply(const PairEvents& events, std::size_t bodies);

  /// All pairs now, ascending. Valid until the next call of clear() or apply().
  [[nodiscard]] PairRuns pairs() const { return {&run_, 1}; }
  /// Of the last frame's events those that cannot be, each pair once, ascending: it began though it
  /// was there, ended though it was not, came more than once, or is none (a >= b, or a body that
  /// does not exist). What ended and began in one frame is left as it was.
  [[nodiscard]] PairRun impossible() const { return impossible_; }

 private:
  std::vector<Pair> pairs_;  ///< ascending
  PairRun run_;              ///< all of them
  std::vector<Pair> impossible_;
  // Of the present frame, ascending.
  std::vector<Pair> began_;
  std::vector<Pair> ended_;
  std::vector<Pair> next_;
  std::vector<std::pair<Pair, bool>> events_;  ///< whether it ends
};

}  // namespace broadmark
