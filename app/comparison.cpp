// Matching the cases of two runs, and judging each pair by the interval of the ratio of its means.

#include "comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "broadmark/names.h"
#include "table.h"

namespace broadmark {
namespace {

/// Seconds per frame of each repetition, or, of a single one, of each frame.
std::vector<double> samples(const CaseResult& result, bool per_repetition) {
  std::vector<double> values;
  for (const Repetition& repetition : result.repetitions) {
    std::vector<double> frames;
    for (const FrameTimes& times : repetition.frames) {
      // A time below the clock's resolution must still have a logarithm.
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

Verdict judge(const RatioEstimate& estimate, double fail_above) {
  // Without an interval the ratio itself decides.
  const Interval interval = estimate.ci95.value_or(Interval{estimate.ratio, estimate.ratio});
  if (interval.low > 1 + fail_above) return Verdict::regressed;
  if (interval.low > 1) return Verdict::slower;
  if (interval.high < 1) return Verdict::faster;
  return Verdict::same;
}

void compareTimes(CaseComparison& compared, const CaseResult& before, const CaseResult& after,
                  double fail_above) {
  const bool per_repetition = before.repetitions.size() > 1 && after.repetitions.size() > 1;
  const std::vector<double> a = samples(before, per_repetition);
  const std::vector<double> b = samples(after, per_repetition);
  if (a.empty() || b.empty()) {
    compared.verdict = Verdict::not_timed;
    return;
  }
  compared.before = before.summary().seconds_per_frame;
  compared.after = after.summary().seconds_per_frame;
  compared.ratio = ratioOfMeans(a, b);
  compared.verdict = judge(*compared.ratio, fail_above);
}

CaseComparison compareCase(const CaseResult& before, const CaseResult& after, double fail_above) {
  if (before.recording.hash != after.recording.hash) {
    return {.id = after.id, .verdict = Verdict::other_recording};
  }
  CaseComparison compared{
      .id = after.id, .status_before = before.status, .status_after = after.status};
  if (after.status != before.status) {
    compared.verdict = before.status == Status::ok ? Verdict::regressed : Verdict::other_status;
  } else if (after.status != Status::ok) {
    compared.verdict = Verdict::not_ok;
  } else {
    compareTimes(compared, before, after, fail_above);
  }
  return compared;
}

/// Id, and which of the cases with this id.
using CaseKey = std::pair<std::string, int>;

std::vector<CaseKey> keysOf(const Results& results) {
  std::vector<CaseKey> keys;
  std::map<std::string, int> seen;
  for (const CaseResult& result : results.cases) keys.emplace_back(result.id, seen[result.id]++);
  return keys;
}

constexpr NameTable kVerdicts{{NamedValue{Verdict::same, "same within noise"},
                               {Verdict::faster, "faster"},
                               {Verdict::slower, "slower"},
                               {Verdict::regressed, "REGRESSED"},
                               {Verdict::other_status, ""},
                               {Verdict::not_ok, "in both"},
                               {Verdict::not_timed, "not timed"},
                               {Verdict::other_recording, "not comparable: other recording"},
                               {Verdict::only_before, "only in A"},
                               {Verdict::only_after, "only in B"}}};

std::string verdictText(const CaseComparison& compared) {
  std::string text;
  if (compared.status_before != compared.status_after) {
    text = fmt::format("{} -> {} ", statusName(compared.status_before),
                       statusName(compared.status_after));
  } else if (compared.verdict == Verdict::not_ok) {
    text = fmt::format("{} ", statusName(compared.status_after));
  }
  return text + std::string(kVerdicts.nameOf(compared.verdict));
}

std::vector<std::string> rowOf(const CaseComparison& compared) {
  if (!compared.ratio) return {compared.id, "", "", "", "", verdictText(compared)};
  const auto& interval = compared.ratio->ci95;
  return {compared.id,
          fmt::format("{:.6g}", compared.before),
          fmt::format("{:.6g}", compared.after),
          fmt::format("{:.3f}", compared.ratio->ratio),
          interval ? fmt::format("{:.3f}…{:.3f}", interval->low, interval->high) : "",
          verdictText(compared)};
}

}  // namespace

bool Comparison::regressed() const {
  return std::ranges::find(cases, Verdict::regressed, &CaseComparison::verdict) != cases.end();
}

bool Comparison::comparable() const {
  return std::ranges::any_of(cases, [](const CaseComparison& compared) {
    return compared.verdict != Verdict::other_recording &&
           compared.verdict != Verdict::only_before && compared.verdict != Verdict::only_after;
  });
}

Comparison compareResults(const Results& before, const Results& after, double fail_above) {
  const std::vector<CaseKey> before_keys = keysOf(before);
  const std::vector<CaseKey> after_keys = keysOf(after);
  std::map<CaseKey, const CaseResult*> left;
  for (std::size_t i = 0; i < before_keys.size(); ++i) left[before_keys[i]] = &before.cases[i];

  Comparison comparison;
  for (std::size_t i = 0; i < after_keys.size(); ++i) {
    const CaseResult& result = after.cases[i];
    const auto found = left.find(after_keys[i]);
    if (found == left.end()) {
      comparison.cases.push_back({.id = result.id, .verdict = Verdict::only_after});
      continue;
    }
    comparison.cases.push_back(compareCase(*found->second, result, fail_above));
    left.erase(found);
  }
  for (const auto& [key, result] : left) {
    comparison.cases.push_back({.id = result->id, .verdict = Verdict::only_before});
  }
  return comparison;
}

std::string formatComparison(const Comparison& comparison) {
  std::vector<std::vector<std::string>> rows = {
      {"case", "A s/frame", "B s/frame", "B/A", "95 % interval", "verdict"}};
  for (const CaseComparison& compared : comparison.cases) rows.push_back(rowOf(compared));
  return alignColumns(rows, {false, true, true, true, true, false});
}

}  // namespace broadmark
