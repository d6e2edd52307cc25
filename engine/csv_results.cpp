// Results as tidy CSV (RFC 4180, ',' and '.').

#include <fmt/format.h>

#include <iterator>

#include "result_writers.h"

namespace broadmark {
namespace {

std::string csvField(std::string_view text) {
  if (text.find_first_of(",\"\n\r") == std::string_view::npos) return std::string(text);
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

std::string parametersText(const ParameterValues& parameters) {
  std::string text;
  for (const auto& [name, value] : parameters) {
    text += fmt::format("{}{}={}", text.empty() ? "" : ";", name, value);
  }
  return text;
}

/// The columns that identify a case in both tables.
constexpr std::string_view kCaseColumns =
    "id,scene,object_type,objects,algorithm,family,isa,threads,params";

std::string caseColumns(const CaseResult& result) {
  const SceneInfo& scene = result.recording.scene;
  return fmt::format("{},{},{},{},{},{},{},{},{}", csvField(result.id), csvField(scene.name),
                     csvField(scene.object_type), scene.objects, csvField(result.algorithm),
                     csvField(result.family), isaName(result.isa), result.threads,
                     csvField(parametersText(result.parameters)));
}

template <class T>
std::string orEmpty(const std::optional<T>& value) {
  return value ? fmt::format("{}", *value) : "";
}

}  // namespace

std::string formatCsvResults(const Results& results) {
  std::string csv = fmt::format(
      "{},frames,seed,recording_hash,status,reason,repetitions,seconds_per_frame,median,p95,p99,"
      "min,stddev,ci95_low,ci95_high,outliers,pairs_mean,pairs_max,missed,false,"
      "allowed_extra,invalid,"
      "peak_bytes",
      kCaseColumns);
  for (const auto& counter : kProcessorCounters.entries) {
    csv += fmt::format(",{}_per_frame", counter.name);
  }
  csv += '\n';
  for (const CaseResult& result : results.cases) {
    const Summary summary = result.summary();
    const bool timed = !result.repetitions.empty();
    const auto time = [&](double seconds) { return timed ? fmt::format("{:.9g}", seconds) : ""; };
    const auto found = [&](std::uint64_t n) { return result.checked ? fmt::format("{}", n) : ""; };
    fmt::format_to(
        std::back_inserter(csv),
        "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}", caseColumns(result),
        result.recording.scene.frames, orEmpty(result.recording.seed),
        csvField(result.recording.hash), statusName(result.status), csvField(result.reason),
        result.repetitions.size(), time(summary.seconds_per_frame), time(summary.median),
        time(summary.p95), time(summary.p99), time(summary.min), time(summary.stddev),
        summary.ci95 ? time(summary.ci95->low) : "", summary.ci95 ? time(summary.ci95->high) : "",
        timed ? fmt::format("{}", summary.outliers) : "", result.pairs_mean, result.pairs_max,
        found(result.missed_count), found(result.false_count), found(result.allowed_extra_count),
        found(result.invalid_count), orEmpty(result.peak_bytes));
    for (const auto& counter : kProcessorCounters.entries) {
      csv += fmt::format(",{}", orEmpty(result.perFrame(counter.value)));
    }
    csv += '\n';
  }
  return csv;
}

std::string formatCsvFrames(const Results& results) {
  std::string csv = fmt::format("{},repetition,frame", kCaseColumns);
  for (const auto& phase : kPhases.entries) csv += fmt::format(",{}_ns", phase.name);
  csv += '\n';
  for (const CaseResult& result : results.cases) {
    const std::string columns = caseColumns(result);
    for (std::size_t r = 0; r < result.repetitions.size(); ++r) {
      const auto& frames = result.repetitions[r].frames;
      for (std::size_t f = 0; f < frames.size(); ++f) {
        csv += fmt::format("{},{},{}", columns, r + 1, f + 1);
        for (const auto& phase : kPhases.entries) {
          csv += fmt::format(",{}", frames[f][phase.value]);
        }
        csv += '\n';
      }
    }
  }
  return csv;
}

}  // namespace broadmark
