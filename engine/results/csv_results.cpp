// Results as tidy CSV (RFC 4180, ',' and '.').

#include <fmt/format.h>

#include <variant>

#include "broadmark/results/case_columns.h"
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

std::string fieldOf(const ColumnValue& value, ColumnUnit unit) {
  if (const auto* text = std::get_if<std::string>(&value)) return csvField(*text);
  if (const auto* integer = std::get_if<std::uint64_t>(&value)) return fmt::format("{}", *integer);
  const auto* number = std::get_if<double>(&value);
  if (number == nullptr) return "";
  return unit == ColumnUnit::seconds ? fmt::format("{:.9g}", *number) : fmt::format("{}", *number);
}

std::string headerOf(bool ColumnDisplay::* table) {
  std::string text;
  for (const CaseColumn& column : caseColumns()) {
    if (column.shown.*table) text += (text.empty() ? "" : ",") + column.key;
  }
  return text;
}

std::string rowOf(bool ColumnDisplay::* table, const CaseResult& result, const Summary& summary) {
  std::string text;
  for (const CaseColumn& column : caseColumns()) {
    if (!(column.shown.*table)) continue;
    if (&column != &caseColumns().front()) text += ',';
    text += fieldOf(column.valueOf(result, summary), column.unit);
  }
  return text;
}

}  // namespace

FrameTable::FrameTable() : text_(headerOf(&ColumnDisplay::frames) + ",repetition,frame") {
  for (const auto& phase : kPhases.entries) text_ += fmt::format(",{}_ns", phase.name);
  for (const auto& count : kFrameCounts.entries) text_ += fmt::format(",{}", count.name);
  text_ += ",checked,disturbed\n";
}

void FrameTable::begin(const CaseResult& result) {
  case_ = rowOf(&ColumnDisplay::frames, result, {});  // identity columns do not need the summary
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
  std::string csv = headerOf(&ColumnDisplay::csv) + '\n';
  for (const CaseResult& result : results.cases) {
    csv += rowOf(&ColumnDisplay::csv, result, result.summary()) + '\n';
  }
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
