// A duel: cases that take turns, frame by frame, on the same boxes.
//
// Whatever else slows the machine slows all of them alike, so that the ratios of their times say
// more than two runs one after the other can. In each round every side runs the same frame, in
// random order; the judgement is on the median of the rounds' ratios.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "broadmark/harness/case_run.h"
#include "broadmark/statistics/statistics.h"

namespace broadmark {

struct DuelSide {
  std::string name;
  Case run;
  ExecutorFactory make_host = makeLocalHost;
};

struct DuelResult;

struct DuelOptions {
  /// Width of the intervals at which the duel ends. The margin is twice that: an interval that
  /// misses 1 by little is no news, one in twenty does.
  double precision = 0.01;
  double max_seconds = 60;            ///< stops after this time
  std::uint64_t seed = 1;             ///< of the order of turns
  CheckMode check = CheckMode::hash;  ///< of the first pass; later ones give the same answers
  /// Told after each round what is known so far.
  std::function<void(const DuelResult&)> progress = {};
  CancelQuery cancelled = {};
};

/// A place in the ranking of a duel.
struct DuelPlace {
  std::size_t side = 0;
  std::size_t place = 1;  ///< from 1, the fastest; shared by sides that are not told apart
  Estimate ratio;         ///< to the first side
};

/// What a duel has found.
struct DuelResult {
  struct Side {
    std::string name;
    Status status = Status::ok;
    std::string reason;
    std::vector<double> seconds;  ///< a frame's total, round by round
  };
  std::vector<Side> sides;
  /// All sides, the fastest first; empty unless ok(). One has a place of its own when it is slower
  /// than the first one of the place before, beyond the margin.
  std::vector<DuelPlace> places;
  double margin = 0;     ///< sides whose ratio is surely within it are the same
  double seconds = 0;    ///< that it took
  bool decided = false;  ///< ended as every interval was narrow enough

  /// Whether every side ran, and ran right.
  [[nodiscard]] bool ok() const;
  [[nodiscard]] std::size_t rounds() const { return sides.front().seconds.size(); }
  /// Times of side `a` / times of side `b`, round by round.
  [[nodiscard]] std::vector<double> ratios(std::size_t a, std::size_t b) const;
  /// The median of those, its interval in logarithms; (0, infinity) for fewer than six rounds. Only
  /// after a round.
  [[nodiscard]] Estimate ratio(std::size_t a, std::size_t b) const;
};

/// Goes through the frames as often as it takes, each time with fresh instances. At least two
/// sides. Ends early when one fails. Throws InputError, and Cancelled.
DuelResult runDuel(const std::vector<DuelSide>& sides, FrameSource& frames, const DuelOptions&);

}  // namespace broadmark
