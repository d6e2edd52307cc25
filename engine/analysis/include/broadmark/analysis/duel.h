// A duel: cases run alternately, frame by frame, on the same boxes.
//
// Disturbances of the machine affect all of them alike, so the ratios of their times are more
// precise than those of two successive runs. In each round every side runs the same frame, in
// random order; the verdict is based on the median of the rounds' ratios.
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
  Case test_case;
  ExecutorFactory make_executor = makeInProcessExecutor;
};

struct DuelResult;

struct DuelOptions {
  /// Width of the intervals at which the duel ends. The margin is twice this width: one interval in
  /// twenty misses 1, so a narrow miss is insignificant.
  double precision = 0.01;
  double max_seconds = 60;            ///< time limit
  std::uint64_t seed = 1;             ///< for the order within rounds
  CheckMode check = CheckMode::hash;  ///< in the first pass; later passes repeat the answers
  /// Called after each round with the preliminary result.
  std::function<void(const DuelResult&)> progress = {};
  CancelQuery cancelled = {};
};

struct DuelRank {
  std::size_t side = 0;
  std::size_t rank = 1;  ///< from 1, the fastest; shared by sides without a significant difference
  Estimate ratio;        ///< to the first side
};

struct DuelResult {
  struct Side {
    std::string name;
    Status status = Status::ok;
    std::string reason;
    std::vector<double> seconds;  ///< the total of each round's frame
  };
  std::vector<Side> sides;
  /// All sides, the fastest first; empty unless ok(). A side gets a new rank if it is slower than
  /// the first side of the previous rank by more than the margin.
  std::vector<DuelRank> ranking;
  double margin = 0;     ///< sides with a ratio interval within it count as equal
  double seconds = 0;    ///< duration
  bool decided = false;  ///< whether every interval became narrow enough

  /// Whether every side completed with correct answers.
  [[nodiscard]] bool ok() const;
  [[nodiscard]] std::size_t rounds() const { return sides.front().seconds.size(); }
  /// Times of side `a` / times of side `b`, round by round.
  [[nodiscard]] std::vector<double> ratios(std::size_t a, std::size_t b) const;
  /// The median of ratios(a, b), with an interval from their logarithms; (0, infinity) for fewer
  /// than six rounds. Requires a round.
  [[nodiscard]] Estimate ratio(std::size_t a, std::size_t b) const;
};

/// Repeats passes over the frames, each with fresh instances, as often as necessary. Requires two
/// or more sides. Ends early if one fails. Throws InputError, and Cancelled.
DuelResult runDuel(const std::vector<DuelSide>& sides, FrameSource& frames, const DuelOptions&);

}  // namespace broadmark
