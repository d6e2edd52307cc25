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
  ExecutorFactory make_host = makeLocalHost;
};

struct DuelResult;

struct DuelOptions {
  /// Width of the intervals at which the duel ends. The margin is twice that: one interval in
  /// twenty misses 1, so a miss by little is insignificant.
  double precision = 0.01;
  double max_seconds = 60;            ///< stops after this time
  std::uint64_t seed = 1;             ///< for the order within rounds
  CheckMode check = CheckMode::hash;  ///< in the first pass; later passes repeat the answers
  /// Called after each round with the preliminary result.
  std::function<void(const DuelResult&)> progress = {};
  CancelQuery cancelled = {};
};

/// A rank in a duel.
struct DuelRank {
  std::size_t side = 0;
  std::size_t rank = 1;  ///< from 1, the fastest; shared by sides without a significant difference
  Estimate ratio;        ///< to the first side
};

/// The result of a duel.
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
  double margin = 0;     ///< sides with the ratio's interval within it count as the same
  double seconds = 0;    ///< duration
  bool decided = false;  ///< ended because every interval was narrow enough

  /// Whether every side ran to the end with correct answers.
  [[nodiscard]] bool ok() const;
  [[nodiscard]] std::size_t rounds() const { return sides.front().seconds.size(); }
  /// Times of side `a` / times of side `b`, round by round.
  [[nodiscard]] std::vector<double> ratios(std::size_t a, std::size_t b) const;
  /// The median of these ratios, its interval in logarithms; (0, infinity) for fewer than six
  /// rounds. Requires a round.
  [[nodiscard]] Estimate ratio(std::size_t a, std::size_t b) const;
};

/// Repeats passes over the frames as often as necessary, each with fresh instances. At least two
/// sides. Ends early if one fails. Throws InputError, and Cancelled.
DuelResult runDuel(const std::vector<DuelSide>& sides, FrameSource& frames, const DuelOptions&);

}  // namespace broadmark
