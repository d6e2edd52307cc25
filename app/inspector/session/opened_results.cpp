#include "inspector/session/opened_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "broadmark/algorithms.h"
#include "broadmark/harness/runner.h"
#include "broadmark/statistics/statistics.h"
#include "sources/results.h"

namespace broadmark {
namespace {

constexpr std::size_t kMaxMarked = 4;

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
      if (k >= repetition.frames.size()) continue;  // interrupted
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

/// recordingId() without the number of bodies.
std::string sceneOf(const Row& row) {
  std::string id = row.recording;
  const std::string size = fmt::format("/N{}/", row.result.recording.scene.objects);
  if (const std::size_t at = id.find(size); at != id.npos) id.erase(at, size.size() - 1);
  return id;
}

bool isSelfCheck(const CaseResult& result) {
  static const std::vector<Algorithm> known = builtinAlgorithms();
  const Algorithm* algorithm = findAlgorithm(result.algorithm, known);
  return algorithm != nullptr && !algorithm->traits.finds_pairs;
}

double exponentOf(const std::vector<ScalingCurve::Point>& points) {
  const auto count = static_cast<double>(points.size());
  double x_sum = 0;
  double y_sum = 0;
  double xx_sum = 0;
  double xy_sum = 0;
  for (const ScalingCurve::Point& point : points) {
    const double x = std::log(static_cast<double>(point.objects));
    const double y = std::log(point.seconds);
    x_sum += x;
    y_sum += y;
    xx_sum += x * x;
    xy_sum += x * y;
  }
  return (count * xy_sum - x_sum * y_sum) / (count * xx_sum - x_sum * x_sum);
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
    row.obstacle =
        isQuery(result.answer) ? "queries are not shown" : obstacleTo(result, file_, algorithms);
    if (!result.repetitions.empty()) row.summary = result.summary();
    row.result = std::move(result);
    row.marked = row.summary && marked < kMaxMarked && row.recording == rows_.front().recording;
    marked += row.marked ? 1 : 0;
  }
  updateList();
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
  scaling_ = scalingCurves(phase);
  return scaling_;
}

std::vector<ScalingCurve> OpenedResults::scalingCurves(Phase phase) const {
  std::vector<ScalingCurve> curves;
  std::vector<std::size_t> rows = listed_;
  std::ranges::sort(rows);  // keeps the colours when the list is sorted
  for (const std::size_t i : rows) {
    const CaseResult& result = rows_[i].result;
    const double seconds = result.meanSeconds(phase).value_or(0);
    if (result.status != Status::ok || !result.isComplete() || seconds <= 0 || isSelfCheck(result))
      continue;
    const std::string scene = sceneOf(rows_[i]);
    const std::string case_name = caseNameOf(result);
    auto curve = std::ranges::find_if(curves, [&](const ScalingCurve& other) {
      return other.scene == scene && other.case_name == case_name;
    });
    if (curve == curves.end()) {
      curve = curves.insert(
          curve,
          {.algorithm = rows_[i].algorithm, .scene = scene, .case_name = case_name, .points = {}});
    }
    curve->points.push_back({result.recording.scene.objects, seconds, i});
  }
  std::set<std::string> scenes;
  std::set<std::string> case_names;
  std::set<std::string> algorithms;
  for (ScalingCurve& curve : curves) {
    std::ranges::stable_sort(curve.points, {}, &ScalingCurve::Point::objects);
  }
  std::erase_if(curves, [](const ScalingCurve& curve) {
    return curve.points.front().objects == curve.points.back().objects;
  });
  for (const ScalingCurve& curve : curves) {
    scenes.insert(curve.scene);
    case_names.insert(curve.case_name);
    algorithms.insert(curve.algorithm);
  }
  for (ScalingCurve& curve : curves) {
    if (case_names.size() != algorithms.size()) curve.algorithm = curve.case_name;
    if (scenes.size() == 1) curve.scene.clear();
    curve.exponent = exponentOf(curve.points);
  }
  return curves;
}

void OpenedResults::compareWith(const std::filesystem::path& baseline) {
  auto compared = std::make_unique<Compared>();
  compared->before = readResults(baseline);
  compared->after = readResults(file_);
  compared->comparison = compareResults({&compared->before, 1}, compared->after, {});
  compared->table = comparisonTable(compared->comparison);
  compared_ = std::move(compared);
}

void OpenedResults::sort(std::string_view column, bool descending) {
  const std::vector<CaseColumn>& columns = caseColumns();
  const auto found = std::ranges::find(columns, column, &CaseColumn::key);
  sorted_by_ = found == columns.end() ? nullptr : &*found;
  descending_ = descending;
  updateList();
}

void OpenedResults::filter(const std::string& text, bool only_wrong) {
  if (text == text_ && only_wrong == only_wrong_) return;
  text_ = text;
  only_wrong_ = only_wrong;
  updateList();
}

void OpenedResults::updateList() {
  scaling_of_.reset();
  listed_.clear();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (only_wrong_ && rows_[i].mismatches == 0) continue;
    if (rows_[i].result.id.find(text_) != std::string::npos) listed_.push_back(i);
  }
  if (sorted_by_ == nullptr) return;
  std::vector<ColumnValue> values;
  const ColumnValue unknown;
  for (const Row& row : rows_) {
    // Self-checks find no pairs: their times are no rivals.
    if (sorted_by_->unit == ColumnUnit::seconds && isSelfCheck(row.result)) {
      values.push_back(unknown);
      continue;
    }
    values.push_back(sorted_by_->shown.order
                         ? sorted_by_->shown.order(row.result)
                         : sorted_by_->shownValueOf(row.result, row.summary.value_or(Summary{})));
  }
  std::ranges::stable_sort(listed_, [&](std::size_t a, std::size_t b) {
    if (values[a] == unknown || values[b] == unknown)
      return values[b] == unknown && values[a] != unknown;
    return descending_ ? values[b] < values[a] : values[a] < values[b];
  });
}

}  // namespace broadmark
