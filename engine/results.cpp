// Names and sums of results.

#include "broadmark/results.h"

#include "result_writers.h"

namespace broadmark {

std::string_view phaseName(Phase phase) {
  switch (phase) {
    case Phase::update_objects:
      return "update_objects";
    case Phase::clean_cache:
      return "clean_cache";
    case Phase::update_structures:
      return "update_structures";
    case Phase::search_overlaps:
      return "search_overlaps";
    case Phase::upload:
      return "upload";
    case Phase::download:
      return "download";
    case Phase::total:
      return "total";
  }
  return "?";
}

std::string_view statusName(Status status) {
  switch (status) {
    case Status::ok:
      return "ok";
    case Status::mismatch:
      return "mismatch";
    case Status::timeout:
      return "timeout";
    case Status::unsupported:
      return "unsupported";
    case Status::error:
      return "error";
  }
  return "?";
}

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

std::vector<ResultWriter> resultWriters() {
  return {
      {"json", "results as JSON: everything, every frame's times included", formatJson},
      {"csv", "results as CSV: one row per case", formatCsv},
      {"csv-frames", "times as CSV: one row per frame", formatCsvFrames},
  };
}

}  // namespace broadmark
