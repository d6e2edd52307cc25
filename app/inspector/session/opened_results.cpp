#include "inspector/session/opened_results.h"

#include <algorithm>
#include <utility>

#include "broadmark/harness/runner.h"
#include "broadmark/statistics/statistics.h"
#include "sources/results.h"

namespace broadmark {
namespace {

constexpr std::size_t kMarkedAtFirst = 4;

using Row = OpenedResults::Row;

FrameValues secondsOf(const CaseResult& result, Phase phase) {
  std::size_t frames = 0;
  for (const Repetition& repetition : result.repetitions) {
    frames = std::max(frames, repetition.frames.size());
  }
  FrameValues values;
  std::vector<double> seconds;
  for (std::size_t k = 0; k < frames; ++k) {
    seconds.clear();
    for (const Repetition& repetition : result.repetitions) {
      if (k >= repetition.frames.size()) continue;  // it was interrupted
      seconds.push_back(static_cast<double>(repetition.frames[k][phase]) * 1e-9);
    }
    values.set(static_cast<std::uint32_t>(k + 1), static_cast<float>(quantile(seconds, 0.5)));
  }
  return values;
}

FrameValues mismatchesOf(const CaseResult& result) {
  FrameValues values;
  for (const FrameDifference& difference : result.differences) values.set(difference.frame, 1);
  return values;
}

}  // namespace

OpenedResults::OpenedResults(std::filesystem::path file, Results results,
                             const std::vector<Algorithm>& algorithms)
    : file_(std::move(file)), complete_(results.complete) {
  std::size_t marked = 0;
  for (CaseResult& result : results.cases) {
    Row& row = rows_.emplace_back();
    row.algorithm = variantOf(result);
    row.recording = recordingId(result.recording);
    row.mismatches = result.mismatchedFrames();
    row.obstacle = obstacleTo(result, file_, algorithms);
    if (!result.repetitions.empty()) row.summary = result.summary();
    row.result = std::move(result);
    row.marked = row.summary && marked < kMarkedAtFirst && row.recording == rows_.front().recording;
    marked += row.marked ? 1 : 0;
  }
  list();
}

std::size_t OpenedResults::wrong() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(rows_, [](const Row& row) { return row.mismatches > 0; }));
}

void OpenedResults::mark(std::size_t row, bool on) {
  rows_[row].marked = on;
  curves_of_.reset();
}

const std::vector<OpenedResults::Curve>& OpenedResults::curves(Phase phase) {
  if (curves_of_ == phase) return curves_;
  curves_of_ = phase;
  curves_.clear();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (!rows_[i].marked || !rows_[i].summary) continue;
    curves_.push_back({.row = i,
                       .seconds = secondsOf(rows_[i].result, phase),
                       .mismatches = mismatchesOf(rows_[i].result)});
  }
  return curves_;
}

const std::vector<ScalingCurve>& OpenedResults::scaling(Phase phase) {
  if (scaling_of_ == phase) return scaling_;
  scaling_of_ = phase;
  std::vector<SizedCase> cases;
  for (const std::size_t row : listed_) {
    cases.push_back({.row = row, .result = &rows_[row].result, .algorithm = rows_[row].algorithm});
  }
  std::ranges::sort(cases, {}, &SizedCase::row);  // sorting the list changes no colour
  scaling_ = scalingCurves(cases, phase);
  return scaling_;
}

void OpenedResults::sort(std::string_view column, bool descending) {
  const std::vector<CaseColumn>& columns = caseColumns();
  const auto found = std::ranges::find(columns, column, &CaseColumn::key);
  sorted_by_ = found == columns.end() ? nullptr : &*found;
  descending_ = descending;
  list();
}

void OpenedResults::filter(const std::string& text, bool only_wrong) {
  if (text == text_ && only_wrong == only_wrong_) return;
  text_ = text;
  only_wrong_ = only_wrong;
  list();
}

void OpenedResults::list() {
  scaling_of_.reset();
  listed_.clear();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (only_wrong_ && rows_[i].mismatches == 0) continue;
    if (rows_[i].result.id.find(text_) != std::string::npos) listed_.push_back(i);
  }
  if (sorted_by_ == nullptr) return;
  std::vector<ColumnValue> values;
  for (const Row& row : rows_) {
    values.push_back(sorted_by_->shown.order
                         ? sorted_by_->shown.order(row.result)
                         : sorted_by_->shownValueOf(row.result, row.summary.value_or(Summary{})));
  }
  const ColumnValue unknown;
  std::ranges::stable_sort(listed_, [&](std::size_t a, std::size_t b) {
    if (values[a] == unknown || values[b] == unknown)
      return values[b] == unknown && values[a] != unknown;
    return descending_ ? values[b] < values[a] : values[a] < values[b];
  });
}

}  // namespace broadmark
