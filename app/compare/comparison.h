// Two runs compared case by case.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/analysis/run_ratio.h"
#include "broadmark/results/results.h"

namespace broadmark {

/// Something that times depend on, and that is not the same for both.
struct ConditionDifference {
  std::string what;  ///< "build type: Release -> Debug"
  bool refused = false;
};

/// A case of either run.
struct CaseComparison {
  std::string id;
  std::string baseline;  ///< the id of the case in A; "": the same, or none
  Verdict verdict = Verdict::same;
  std::vector<ConditionDifference> conditions;
  // Of a case on the same recording in both runs.
  Status status_before = Status::ok;
  Status status_after = Status::ok;
  std::optional<RunRatio> ratio = {};  ///< of a case that is ok in both
};

struct ComparisonOptions {
  double fail_above = 0.05;  ///< a slow-down by more than this share is a regression
  double margin = 0.05;      ///< smaller differences do not matter; at most `fail_above` counts
  /// "": each case is compared with itself. Else with the first case of A that differs at most in
  /// this: "algorithm", "threads", "isa" or a parameter.
  std::string by;
  bool any_conditions = false;  ///< compares what is refused otherwise
  bool allow_missing = false;   ///< cases that are only in A are no failure
  bool fail_undecided = false;
};

struct Comparison {
  ComparisonOptions options;
  /// Those of B in their order, then those only in A.
  std::vector<CaseComparison> cases;
  std::vector<std::string> notes;  ///< on the runs as a whole

  [[nodiscard]] std::size_t count(Verdict verdict) const;
  /// Whether the case speaks against B.
  [[nodiscard]] bool fails(const CaseComparison& compared) const;
  /// Whether any case ran on the same recording in both runs.
  [[nodiscard]] bool comparable() const;
  /// The median drift of the cases, as RunRatio::drift.
  [[nodiscard]] std::optional<double> drift() const;
};

/// One result file, or several that are judged together.
struct NamedResults {
  std::string name;
  Results results;
};

/// Compares the cases on recordings of the same hash and of the same name; of several with the same
/// name the k-th with the k-th. Throws InputError for an `options.by` that no case has.
Comparison compareResults(std::span<const NamedResults> before, const NamedResults& after,
                          const ComparisonOptions& options);

/// "ok -> timeout", "1.5 % slower": a verdict in words.
std::string verdictText(const CaseComparison&);
/// "12 cases: 10 same, 1 faster, 1 REGRESSED; drift +1.3 %"
std::string summaryText(const Comparison&);

/// One way to write a comparison.
struct ComparisonWriter {
  std::string_view name;  ///< of the command line option, without dashes: "junit"
  std::string_view doc;
  std::string (*format)(const Comparison&);
};
/// In the order of the help.
std::vector<ComparisonWriter> comparisonWriters();
/// As a table for people.
std::string formatComparison(const Comparison&);

}  // namespace broadmark
