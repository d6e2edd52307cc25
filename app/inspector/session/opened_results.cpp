#include "inspector/session/opened_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "broadmark/harness/runner.h"
#include "broadmark/statistics/statistics.h"
#include "sources/results.h"

namespace broadmark {
namespace {

constexpr std::size_t kMarkedAtFirst = 4;

using Row = OpenedResults::Row;

/// What of a case's name is not told elsewhere: "kd-mt/avx2/t4/margin=0.1" is "kd-mt/margin=0.1".
std::string algorithmText(const CaseResult& result) {
  std::string text = caseNameOf(result) + '/';
  for (const std::string& told :
       {fmt::format("/{}/", isaName(result.isa)), fmt::format("/t{}/", result.threads)}) {
    if (const std::size_t at = text.find(told); at != text.npos) text.erase(at, told.size() - 1);
  }
  text.pop_back();
  return text;
}

std::size_t mismatchCount(const CaseResult& result) {
  std::set<std::uint32_t> frames;  // each may be wrong in several repetitions
  for (const FrameDifference& difference : result.differences) frames.insert(difference.frame);
  return frames.size();
}

/// Recordings of more bodies come later, also where their ids would not.
auto recordingKey(const Row& row) {
  const SceneInfo& scene = row.result.recording.scene;
  return std::tuple(scene.name, scene.object_type, scene.objects, scene.frames, row.recording);
}

/// What numbers a column has; nothing where it has words, or the case none.
std::optional<double> numberOf(const Row& row, CaseColumn column) {
  const auto time = [&](double Summary::*which) -> std::optional<double> {
    if (!row.summary) return {};
    return (*row.summary).*which;
  };
  switch (column) {
    case CaseColumn::isa:
      return static_cast<double>(row.result.isa);
    case CaseColumn::threads:
      return row.result.threads;
    case CaseColumn::status:
      return static_cast<double>(row.result.status);
    case CaseColumn::mean:
      return time(&Summary::seconds_per_frame);
    case CaseColumn::median:
      return time(&Summary::median);
    case CaseColumn::p95:
      return time(&Summary::p95);
    case CaseColumn::pairs:
      return row.result.pairs_mean;
    case CaseColumn::mismatches:
      return static_cast<double>(row.mismatches);
    default:
      return {};
  }
}

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
    row.algorithm = algorithmText(result);
    row.recording = recordingId(result.recording);
    row.mismatches = mismatchCount(result);
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

void OpenedResults::sort(std::optional<CaseColumn> by, bool descending) {
  sorted_by_ = by;
  descending_ = descending;
  list();
}

void OpenedResults::filter(const std::string& text, bool only_wrong) {
  if (text == text_ && only_wrong == only_wrong_) return;
  text_ = text;
  only_wrong_ = only_wrong;
  list();
}

bool OpenedResults::before(std::size_t a, std::size_t b) const {
  const Row& x = rows_[descending_ ? b : a];
  const Row& y = rows_[descending_ ? a : b];
  if (*sorted_by_ == CaseColumn::algorithm) return x.algorithm < y.algorithm;
  if (*sorted_by_ == CaseColumn::recording) return recordingKey(x) < recordingKey(y);
  const std::optional<double> of_a = numberOf(rows_[a], *sorted_by_);
  const std::optional<double> of_b = numberOf(rows_[b], *sorted_by_);
  if (!of_a || !of_b) return of_a.has_value() && !of_b;
  return descending_ ? *of_b < *of_a : *of_a < *of_b;
}

void OpenedResults::list() {
  scaling_of_.reset();
  listed_.clear();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (only_wrong_ && rows_[i].mismatches == 0) continue;
    if (rows_[i].result.id.find(text_) != std::string::npos) listed_.push_back(i);
  }
  if (!sorted_by_) return;
  std::ranges::stable_sort(listed_, [this](std::size_t a, std::size_t b) { return before(a, b); });
}

}  // namespace broadmark
