// Duels of cases with their baselines, one after the other.
#pragma once

#include <string>
#include <vector>

#include "broadmark/analysis/duel.h"
#include "broadmark/recordings/recording.h"
#include "compare/comparison.h"
#include "support/progress.h"

namespace broadmark::commands {

/// Precision that tells whether cases are the same within `margin`.
inline double precisionFor(double margin) { return margin / 2; }

/// Like runDuel(). Throws Interrupted if the user ends it.
DuelResult runInterruptibleDuel(const std::vector<DuelSide>&, FrameSource& recording, DuelOptions);

/// Runs duels, shows how their intervals narrow, and prints a line on standard error for each one
/// that has ended, unless `quiet`.
class DuelSeries {
 public:
  /// The `count` duels share the error rate, so that it is that of the series as a whole. The
  /// margin and the limit of `comparison` decide when a duel ends.
  DuelSeries(std::string task, std::size_t count, const DuelOptions&,
             const ComparisonOptions& comparison, bool quiet);

  /// Judges `after`, B, against `before`, A. Adds a note if time was up before all frames had run.
  /// Throws Interrupted, and InputError.
  CaseComparison run(const DuelSide& before, const DuelSide& after, FrameSource& recording,
                     std::vector<std::string>& notes);

  /// Reports the verdict on the next case. `effort`: what it took, if known.
  void finish(const CaseComparison& compared, const std::string& effort = {});

 private:
  std::size_t finished_ = 0;
  DuelOptions options_;
  const ComparisonOptions& comparison_;
  bool quiet_;
  Progress progress_;
};

}  // namespace broadmark::commands
