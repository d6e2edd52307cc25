// Compares two runs case by case.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/analysis/duel.h"
#include "broadmark/analysis/run_ratio.h"
#include "broadmark/results/results.h"
#include "request/run_request.h"

namespace broadmark {

/// A condition that affects times and differs between two cases.
struct ConditionDifference {
  std::string what;      ///< "build type: Release -> Debug"
  bool refused = false;  ///< compared only with any_conditions
};

/// Comparison of a case, which may be missing in one of the runs.
struct CaseComparison {
  std::string id;
  std::string baseline;  ///< the id of the case in A; "": the same, or none
  Verdict verdict = Verdict::same;
  std::vector<ConditionDifference> conditions;
  // For a case on the same recording in both runs.
  Status status_before = Status::ok;
  Status status_after = Status::ok;
  std::string reason = {};             ///< of status_after
  std::optional<RunRatio> ratio = {};  ///< if the case is ok in both
  bool by_duel = false;                ///< whether the ratio is that of a duel
  bool instructions = false;           ///< whether the ratio is of instructions, not of times
  // In the compared results; null in a duel.
  const CaseResult* before = nullptr;
  const CaseResult* after = nullptr;
};

struct ComparisonOptions {
  double fail_above = 0.05;  ///< a slow-down by more than this share is a regression
  double margin = 0.05;      ///< smaller differences are ignored; capped at `fail_above`
  /// "": each case is compared with itself. Else with the first case of A that differs at most in
  /// this: "algorithm", "threads", "isa" or a parameter.
  std::string by;
  bool instructions = false;    ///< judge instruction counts instead of times
  bool any_conditions = false;  ///< ignore ConditionDifference::refused
  bool allow_missing = false;   ///< cases that are only in A are not failures
  bool fail_undecided = false;
};

struct Comparison {
  std::string command = "compare";  ///< what made it
  ComparisonOptions options;
  /// Cases of B in their order, then those only in A.
  std::vector<CaseComparison> cases = {};
  std::vector<std::string> notes = {};  ///< on the runs as a whole
  std::size_t not_run = 0;              ///< duels that an interrupt prevented or ended early

  [[nodiscard]] std::size_t count(Verdict verdict) const;
  /// Whether the case is a failure of B: a regression, a wrong answer, a missing case.
  [[nodiscard]] bool fails(const CaseComparison& compared) const;
  /// Whether any case ran on the same recording in both runs.
  [[nodiscard]] bool comparable() const;
  /// success, wrong_answer, or regression for any other failing case.
  [[nodiscard]] int exitStatus() const;
  /// Median of RunRatio::drift over the cases.
  [[nodiscard]] std::optional<double> drift() const;
};

/// The results of a file.
struct NamedResults {
  std::string name;
  Results results;
};
/// The results of a file, named by its path. Throws InputError.
NamedResults readResults(const std::filesystem::path&);

/// Compares the cases of results that outlive the comparison, if they have the same name and the
/// same hash of the recording; the k-th with the k-th if there are several. Throws InputError for
/// an `options.by` that no case has.
Comparison compareResults(std::span<const NamedResults> before, const NamedResults& after,
                          const ComparisonOptions& options);

/// Judges side `after` of a duel, B, against side `before`, A.
CaseComparison compareSides(const DuelResult&, std::size_t before, std::size_t after,
                            const ComparisonOptions&);

/// Judges the instructions of `after`, B, against those of `before`, A. Ids may differ.
CaseComparison compareInstructions(const CaseResult& before, const CaseResult& after,
                                   const ComparisonOptions&);

/// Verdict in words: "ok -> timeout", "1.5 % slower".
std::string verdictText(const CaseComparison&);
/// "1.012…1.034", or "too few rounds".
std::string intervalText(const Interval&, int digits);
/// "12 cases: 10 same, 1 faster, 1 REGRESSED; drift +1.3 %; interrupted, 3 duels not run"
std::string summaryText(const Comparison&);

/// An output format for comparisons.
struct ComparisonWriter {
  std::string_view name;  ///< name of the command line option, without dashes: "junit"
  std::string_view doc;
  std::string (*format)(const Comparison&);
};
/// All formats, in the order of the help.
std::vector<ComparisonWriter> comparisonWriters();
/// Writes the formats that have a path. Throws InputError.
void writeComparison(const OutputPaths&, const Comparison&);
/// A row of headings, then a row per case: "case", A, B, B/A, its interval, "verdict".
std::vector<std::vector<std::string>> comparisonTable(const Comparison&);
/// Formats this table, with notes and a summary.
std::string formatComparison(const Comparison&);

}  // namespace broadmark
