// Sums over a case's frames.

#include "broadmark/harness/case_result.h"

#include <set>
#include <span>
#include <utility>

namespace broadmark {

Summary CaseResult::summary() const {
  std::vector<std::vector<double>> seconds;
  std::vector<std::span<const double>> views;
  seconds.reserve(repetitions.size());
  for (const Repetition& repetition : repetitions) {
    std::vector<double>& times = seconds.emplace_back();
    times.reserve(repetition.frames.size());
    for (const FrameTimes& frame : repetition.frames) {
      times.push_back(static_cast<double>(frame[Phase::total]) * 1e-9);
    }
    views.emplace_back(times);
  }
  return summarise(views);
}

std::optional<double> CaseResult::meanSeconds(Phase phase) const {
  double sum = 0;
  std::size_t frames_counted = 0;
  for (const Repetition& repetition : repetitions) {
    for (const FrameTimes& times : repetition.frames) sum += static_cast<double>(times[phase]);
    frames_counted += repetition.frames.size();
  }
  if (frames_counted == 0) return std::nullopt;
  return sum * 1e-9 / static_cast<double>(frames_counted);
}

std::optional<double> CaseResult::perFrame(ProcessorCounter which) const {
  double sum = 0;
  std::size_t frames_counted = 0;
  for (const Repetition& repetition : repetitions) {
    if (!repetition.processor[which]) continue;
    sum += static_cast<double>(*repetition.processor[which]);
    frames_counted += timed() ? repetition.frames.size() : frames.size();
  }
  if (frames_counted == 0) return std::nullopt;
  return sum / static_cast<double>(frames_counted);
}

std::size_t CaseResult::mismatchedFrames() const {
  std::set<std::uint32_t> wrong;
  for (const FrameDifference& difference : differences) wrong.insert(difference.frame);
  return wrong.size();
}

bool CaseResult::isComplete() const {
  return status != Status::ok || std::cmp_greater_equal(repetitions.size(), conditions.repetitions);
}

}  // namespace broadmark
