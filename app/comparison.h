// Two runs compared case by case.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "broadmark/results.h"
#include "broadmark/statistics.h"

namespace broadmark {

/// What became of a case.
enum class Verdict {
  same,  ///< within the noise
  faster,
  slower,        ///< but no more than is tolerated
  regressed,     ///< slower than is tolerated, or no longer ok
  other_status,  ///< another status, but it was not ok before
  not_ok,        ///< the same status in both, not ok: its times say nothing
  not_timed,
  other_recording,
  only_before,
  only_after,
};

/// A case of either run.
struct CaseComparison {
  std::string id;
  Verdict verdict = Verdict::same;
  // Of a case on the same recording in both runs.
  Status status_before = Status::ok;
  Status status_after = Status::ok;
  // Of a case that is ok in both; in seconds per frame.
  double before = 0;
  double after = 0;
  std::optional<RatioEstimate> ratio = {};  ///< after / before
};

struct Comparison {
  std::vector<CaseComparison> cases;  ///< those of `after` in their order, then those only before

  [[nodiscard]] bool regressed() const;
  /// Whether any case ran on the same recording in both runs.
  [[nodiscard]] bool comparable() const;
};

/// Compares the cases of equal ids; of several with the same id the k-th with the k-th.
/// `fail_above`: a slow-down by more than this share is a regression. With several repetitions on
/// both sides the interval comes from the repetitions' means; otherwise from the frames.
Comparison compareResults(const Results& before, const Results& after, double fail_above);

/// As a table for people.
std::string formatComparison(const Comparison&);

}  // namespace broadmark
