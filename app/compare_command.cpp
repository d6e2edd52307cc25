// broadmark compare: two result files, case by case. With several repetitions on both sides the
// interval comes from the repetitions' means; otherwise from the frames.

#include <fmt/format.h>

#include <map>

#include "options.h"
#include "table.h"
#include "broadmark/files.h"
#include "broadmark/error.h"
#include "broadmark/results.h"
#include "broadmark/statistics.h"

namespace broadmark {
namespace {

Results readResults(const std::filesystem::path& path) {
  return parseResults(readTextFile(path), path.string());
}

/// Seconds per frame of each repetition, or, of a single one, of each frame.
std::vector<double> samples(const CaseResult& result, bool per_repetition) {
  std::vector<double> values;
  for (const Repetition& repetition : result.repetitions) {
    std::vector<double> frames;
    for (const FrameTimes& times : repetition.frames) {
      // A time below the clock's resolution still has a logarithm.
      frames.push_back(static_cast<double>(std::max<std::int64_t>(times[Phase::total], 1)) * 1e-9);
    }
    if (frames.empty()) continue;
    if (per_repetition) {
      values.push_back(mean(frames));
    } else {
      values.insert(values.end(), frames.begin(), frames.end());
    }
  }
  return values;
}

struct Verdict {
  std::string text;
  bool regressed = false;
};

Verdict judge(const RatioEstimate& estimate, double fail_above) {
  // Without an interval the ratio itself must do.
  const Interval interval = estimate.ci95.value_or(Interval{estimate.ratio, estimate.ratio});
  if (interval.low > 1 + fail_above) return {"REGRESSED", true};
  if (interval.low > 1) return {"slower", false};
  if (interval.high < 1) return {"faster", false};
  return {"same within noise", false};
}

/// A row of the table that has nothing but a verdict.
std::vector<std::string> verdictOnly(const CaseResult& result, std::string verdict) {
  return {result.id, "", "", "", "", std::move(verdict)};
}

std::vector<std::string> compareCase(const CaseResult& before, const CaseResult& after,
                                     double fail_above, bool& regressed) {
  if (after.status != before.status) {
    const bool worse = before.status == Status::ok;
    regressed |= worse;
    return verdictOnly(after, fmt::format("{} -> {}{}", statusName(before.status),
                                          statusName(after.status), worse ? " REGRESSED" : ""));
  }
  // The time of a wrong or unfinished answer says nothing.
  if (after.status != Status::ok) {
    return verdictOnly(after, fmt::format("{} in both", statusName(after.status)));
  }
  const bool per_repetition = before.repetitions.size() > 1 && after.repetitions.size() > 1;
  const std::vector<double> a = samples(before, per_repetition);
  const std::vector<double> b = samples(after, per_repetition);
  if (a.empty() || b.empty()) return verdictOnly(after, "not timed");
  const RatioEstimate estimate = ratioOfMeans(a, b);
  const Verdict verdict = judge(estimate, fail_above);
  regressed |= verdict.regressed;
  return {
      after.id,
      fmt::format("{:.6g}", before.summary().seconds_per_frame),
      fmt::format("{:.6g}", after.summary().seconds_per_frame),
      fmt::format("{:.3f}", estimate.ratio),
      estimate.ci95 ? fmt::format("{:.3f}…{:.3f}", estimate.ci95->low, estimate.ci95->high) : "",
      verdict.text};
}

/// Cases by id; of several with the same id (recordings alike in all but their contents), the k-th
/// of one file belongs to the k-th of the other.
using CaseKey = std::pair<std::string, int>;
std::vector<CaseKey> keysOf(const Results& results) {
  std::vector<CaseKey> keys;
  std::map<std::string, int> seen;
  for (const CaseResult& result : results.cases) keys.emplace_back(result.id, seen[result.id]++);
  return keys;
}

}  // namespace

int runCompare(const CompareOptions& options) {
  const Results before = readResults(options.before);
  const Results after = readResults(options.after);
  const std::vector<CaseKey> before_keys = keysOf(before);
  const std::vector<CaseKey> after_keys = keysOf(after);
  std::map<CaseKey, const CaseResult*> left;
  for (std::size_t i = 0; i < before_keys.size(); ++i) left[before_keys[i]] = &before.cases[i];

  bool regressed = false;
  int comparable = 0;
  std::vector<std::vector<std::string>> rows = {
      {"case", "A s/frame", "B s/frame", "B/A", "95 % interval", "verdict"}};
  for (std::size_t i = 0; i < after_keys.size(); ++i) {
    const CaseResult& result = after.cases[i];
    const auto found = left.find(after_keys[i]);
    if (found == left.end()) {
      rows.push_back(verdictOnly(result, "only in B"));
      continue;
    }
    if (found->second->recording.hash != result.recording.hash) {
      rows.push_back(verdictOnly(result, "not comparable: other recording"));
    } else {
      rows.push_back(compareCase(*found->second, result, options.fail_above, regressed));
      ++comparable;
    }
    left.erase(found);
  }
  for (const auto& [key, result] : left) rows.push_back(verdictOnly(*result, "only in A"));
  fmt::print("{}", alignColumns(rows, {false, true, true, true, true, false}));
  // A check that compared nothing must not look like one that passed.
  if (comparable == 0) {
    throw InputError(fmt::format("{} and {}: no case of both ran on the same recording",
                                 options.before.string(), options.after.string()));
  }
  return regressed ? 1 : 0;
}

}  // namespace broadmark
