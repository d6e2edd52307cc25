// Results as tidy CSV (RFC 4180, ',' and '.'). Each column's name ends with its unit, if it has
// one.

#include <fmt/format.h>

#include <functional>

#include "broadmark/results/csv.h"
#include "broadmark/results/frame_table.h"
#include "result_writers.h"

namespace broadmark {

std::string csvField(std::string_view text) {
  if (text.find_first_of(",\"\n\r") == std::string_view::npos) return std::string(text);
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

namespace {

std::string parametersText(const ParameterValues& parameters) {
  std::string text;
  for (const auto& [name, value] : parameters) {
    text += fmt::format("{}{}={}", text.empty() ? "" : ";", name, value);
  }
  return text;
}

template <class T>
std::string orEmpty(const std::optional<T>& value) {
  return value ? fmt::format("{}", *value) : "";
}

/// What a column says of a case; "" for what is not known.
struct Column {
  std::string name;
  std::function<std::string(const CaseResult&, const Summary&)> value;
};
using Columns = std::vector<Column>;

/// A column of one text that is in the case itself.
template <class Value>
Column column(std::string name, Value&& value) {
  return {std::move(name), [value](const CaseResult& result, const Summary&) {
            return csvField(fmt::format("{}", value(result)));
          }};
}

/// The columns that identify a case in both tables.
Columns caseColumns() {
  using R = const CaseResult&;
  return {column("id", [](R r) { return r.id; }),
          column("scene", [](R r) { return r.recording.scene.name; }),
          column("object_type", [](R r) { return r.recording.scene.object_type; }),
          column("objects", [](R r) { return r.recording.scene.objects; }),
          column("algorithm", [](R r) { return r.algorithm; }),
          column("family", [](R r) { return r.family; }),
          column("isa", [](R r) { return isaName(r.isa); }),
          column("threads", [](R r) { return r.threads; }),
          column("params", [](R r) { return parametersText(r.parameters); })};
}

/// A time in seconds, of a case that has any.
Column seconds(const std::string& name, double Summary::*time) {
  return {name, [time](const CaseResult& result, const Summary& summary) {
            return result.repetitions.empty() ? "" : fmt::format("{:.9g}", summary.*time);
          }};
}

/// A bound of the interval around the mean.
Column bound(const std::string& name, double Interval::*end) {
  return {name, [end](const CaseResult&, const Summary& summary) {
            return summary.ci95 ? fmt::format("{:.9g}", (*summary.ci95).*end) : "";
          }};
}

/// A count of wrong pairs, known where answers were checked.
Column wrongPairs(const std::string& name, std::uint64_t CaseResult::*count) {
  return {name, [count](const CaseResult& result, const Summary&) {
            return result.checked ? fmt::format("{}", result.*count) : "";
          }};
}

std::string meanInitialisation(const CaseResult& result, const Summary&) {
  if (result.repetitions.empty()) return "";
  double sum = 0;
  for (const Repetition& repetition : result.repetitions) {
    sum += static_cast<double>(repetition.initialize_ns) * 1e-9;
  }
  return fmt::format("{:.9g}", sum / static_cast<double>(result.repetitions.size()));
}

Columns resultColumns() {
  using R = const CaseResult&;
  Columns columns = caseColumns();
  const auto add = [&](const Columns& more) {
    columns.insert(columns.end(), more.begin(), more.end());
  };
  add({column("frames", [](R r) { return r.recording.scene.frames; }),
       column("seed", [](R r) { return orEmpty(r.recording.seed); }),
       column("recording_hash", [](R r) { return r.recording.hash; }),
       column("recording_file", [](R r) { return r.recording.path; }),
       column("scene_params", [](R r) { return parametersText(r.recording.scene_parameters); }),
       column("device", [](R r) { return r.device; }),
       column("answer", [](R r) { return kAnswerKinds.nameOf(r.answer); }),
       column("status", [](R r) { return statusName(r.status); }),
       column("reason", [](R r) { return r.reason; }),
       column("repetitions", [](R r) { return r.repetitions.size(); }),
       column("repetitions_asked", [](R r) { return r.conditions.repetitions; }),
       column("check", [](R r) { return kCheckModes.nameOf(r.conditions.check); }),
       seconds("seconds_per_frame", &Summary::seconds_per_frame),
       seconds("median_seconds", &Summary::median),
       seconds("p95_seconds", &Summary::p95),
       seconds("p99_seconds", &Summary::p99),
       seconds("min_seconds", &Summary::min),
       seconds("stddev_seconds", &Summary::stddev),
       bound("ci95_low_seconds", &Interval::low),
       bound("ci95_high_seconds", &Interval::high),
       {"outliers",
        [](R r, const Summary& summary) {
          return r.repetitions.empty() ? "" : fmt::format("{}", summary.outliers);
        }},
       {"initialize_seconds", meanInitialisation}});
  for (const auto& [phase, name] : kPhases.entries) {
    if (phase == Phase::total) continue;  // that is seconds_per_frame
    columns.push_back(column(fmt::format("{}_seconds", name), [phase = phase](R r) {
      const std::optional<double> mean = r.meanSeconds(phase);
      return mean ? fmt::format("{:.9g}", *mean) : "";
    }));
  }
  add({column("pairs_mean", [](R r) { return r.pairs_mean; }),
       column("pairs_max", [](R r) { return r.pairs_max; }),
       column("bodies_mean", [](R r) { return r.bodies ? fmt::format("{}", r.bodies->mean) : ""; }),
       column("bodies_max", [](R r) { return r.bodies ? fmt::format("{}", r.bodies->max) : ""; }),
       wrongPairs("missed", &CaseResult::missed_count),
       wrongPairs("false", &CaseResult::false_count),
       wrongPairs("allowed_extra", &CaseResult::allowed_extra_count),
       wrongPairs("invalid", &CaseResult::invalid_count),
       column("peak_bytes", [](R r) { return orEmpty(r.peak_bytes); })});
  for (const auto& [which, name] : kProcessorCounters.entries) {
    columns.push_back(column(fmt::format("{}_per_frame", name),
                             [which = which](R r) { return orEmpty(r.perFrame(which)); }));
  }
  return columns;
}

std::string headerOf(const Columns& columns) {
  std::string text;
  for (const Column& one : columns) text += (text.empty() ? "" : ",") + one.name;
  return text;
}

std::string rowOf(const Columns& columns, const CaseResult& result, const Summary& summary) {
  std::string text;
  for (const Column& one : columns) {
    if (&one != &columns.front()) text += ',';
    text += one.value(result, summary);
  }
  return text;
}

}  // namespace

FrameTable::FrameTable() : text_(headerOf(caseColumns()) + ",repetition,frame") {
  for (const auto& phase : kPhases.entries) text_ += fmt::format(",{}_ns", phase.name);
  for (const auto& count : kFrameCounts.entries) text_ += fmt::format(",{}", count.name);
  text_ += ",checked,disturbed\n";
}

void FrameTable::begin(const CaseResult& result) {
  case_ = rowOf(caseColumns(), result, {});  // none of these is of the summary
}

void FrameTable::add(const FrameRow& row) {
  text_ += fmt::format("{},{},{}", case_, row.repetition, row.frame);
  for (const auto& phase : kPhases.entries) text_ += fmt::format(",{}", row.times[phase.value]);
  for (const auto& [which, name] : kFrameCounts.entries) {
    const bool known = which == FrameCount::pairs ||
                       (which == FrameCount::changed_bodies ? row.changes_known : row.checked);
    text_ += fmt::format(",{}", known ? fmt::format("{}", row.counts[which]) : "");
  }
  text_ += fmt::format(",{:d},{:d}\n", row.checked, row.disturbed);
}

std::string formatCsvResults(const Results& results) {
  const Columns columns = resultColumns();
  std::string csv = headerOf(columns) + '\n';
  for (const CaseResult& result : results.cases)
    csv += rowOf(columns, result, result.summary()) + '\n';
  return csv;
}

std::string formatCsvFrames(const Results& results) {
  FrameTable table;
  for (const CaseResult& result : results.cases) {
    table.begin(result);
    for (std::size_t r = 0; r < result.repetitions.size(); ++r) {
      const auto& frames = result.repetitions[r].frames;
      for (std::size_t f = 0; f < frames.size(); ++f) {
        const bool counted = f < result.frames.size();
        table.add({.repetition = static_cast<int>(r) + 1,
                   .frame = static_cast<std::uint32_t>(f) + 1,
                   .times = frames[f],
                   .counts = counted ? result.frames[f] : FrameCounts(),
                   .changes_known = counted,
                   .checked = counted && result.checked});
      }
    }
  }
  return table.text();
}

}  // namespace broadmark
