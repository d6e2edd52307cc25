// A duel: cases run alternately, frame by frame, on the same boxes.
//
// Disturbances of the machine affect all of them alike, so the ratios of their times are more
// precise than those of two successive runs. In each round every side runs the same frame, in
// random order; the verdict is based on the median of the rounds' ratios.
//
// A duel is reviewed at the end of a pass over the frames, where each frame counts equally, and
// ends when its verdict is plain. Repeated reviews would each have their chance of a false claim,
// so the k-th spends only error_rate / (k (k + 1)) of it: these sum to error_rate over all reviews,
// however many there are (alpha spending, Lan and DeMets, 1983).
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
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
  /// Width of the intervals at which the duel ends; for a difference above 4 %, 25 times this share
  /// of the difference. The margin is twice this width.
  double precision = 0.01;
  /// The duel also ends when one side is slower by more than this share, for certain.
  double limit = std::numeric_limits<double>::infinity();
  /// Probability that the interval of a ratio misses it in any of the reviews.
  double error_rate = 0.05;
  double max_seconds = 60;            ///< time limit; the round that exceeds it is completed
  bool whole_passes = false;          ///< instead, the pass that exceeds it is completed
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
  std::size_t processes = 0;  ///< in which each side has run, one after another
  /// All sides, the fastest first; empty unless ok(). A side gets a new rank if it is slower than
  /// the first side of the previous rank by more than the margin.
  std::vector<DuelRank> ranking;
  double margin = 0;         ///< sides with a ratio interval within it count as equal
  double error_rate = 0.05;  ///< of the intervals: what the last review spent
  double seconds = 0;        ///< duration
  bool decided = false;      ///< whether the verdict on every side became plain

  /// Whether every side completed with correct answers.
  [[nodiscard]] bool ok() const;
  [[nodiscard]] std::size_t rounds() const { return sides.front().seconds.size(); }
  /// Times of side `a` / times of side `b`, round by round.
  [[nodiscard]] std::vector<double> ratios(std::size_t a, std::size_t b) const;
  /// The median of ratios(a, b), with an interval from their logarithms; (0, infinity) for too few
  /// rounds. Requires a round.
  [[nodiscard]] Estimate ratio(std::size_t a, std::size_t b) const;
};

/// Repeats passes over the frames, each with fresh instances, as often as necessary, in one process
/// after another. Requires two or more sides. Ends after the first pass if some fail. Throws
/// InputError, and Cancelled.
DuelResult runDuel(const std::vector<DuelSide>& sides, FrameSource& frames, const DuelOptions&);

}  // namespace broadmark
