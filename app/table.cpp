// The table of a recording's cases.

#include "table.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <tuple>

#include "words.h"

namespace broadmark {
namespace {

/// Characters, not bytes, of UTF-8 text.
std::size_t width(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

/// A result with its summary, computed once.
struct Row {
  const CaseResult* result;
  Summary summary;

  [[nodiscard]] bool timed() const {
    return std::ranges::any_of(result->repetitions,
                               [](const Repetition& pass) { return !pass.frames.empty(); });
  }
  [[nodiscard]] bool right() const { return timed() && result->status == Status::ok; }
};

std::vector<Row> sortedRows(std::span<const CaseResult> results) {
  std::vector<Row> rows;
  for (const CaseResult& result : results) rows.push_back({&result, result.summary()});
  // The right ones first, by time; self-checks, which find no pairs, last.
  std::ranges::stable_sort(rows, {}, [](const Row& row) {
    const bool self_check = row.timed() && !row.result->checked;
    const double untimed = std::numeric_limits<double>::infinity();
    return std::tuple(self_check, !row.right(),
                      row.timed() ? row.summary.seconds_per_frame : untimed);
  });
  return rows;
}

std::vector<std::string> cells(const Row& row, bool fastest) {
  const CaseResult& result = *row.result;
  const auto time = [&](double seconds) { return row.timed() ? durationText(seconds) : "–"; };
  const auto count = [&](std::uint64_t n) {
    return result.checked && row.timed() ? fmt::format("{}", n) : "–";
  };
  return {fastest ? "*" : "",
          result.algorithm,
          fmt::format("{}", result.threads),
          result.vectorised ? std::string(isaName(result.isa)) : "–",
          time(row.summary.seconds_per_frame),
          time(row.summary.p95),
          row.timed() ? fmt::format("{:.0f}", result.pairs_mean) : "–",
          count(result.missed_count),
          count(result.false_count),
          count(result.allowed_extra_count),
          count(result.invalid_count),
          std::string(statusName(result.status))};
}

}  // namespace

std::string alignColumns(const std::vector<std::vector<std::string>>& rows,
                         const std::vector<bool>& right_aligned) {
  std::vector<std::size_t> widths(right_aligned.size());
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], width(row[c]));
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string padding(widths[c] - width(row[c]), ' ');
      line += (c == 0 ? "" : "  ") + (right_aligned[c] ? padding + row[c] : row[c] + padding);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  return text;
}

std::string formatTable(std::span<const CaseResult> results) {
  if (results.empty()) return {};
  const RecordingReference& recording = results.front().recording;
  std::string text =
      fmt::format("{} {}, {} bodies, {} frames\n", recording.scene.name,
                  recording.scene.object_type, recording.scene.objects, recording.scene.frames);
  std::vector<std::vector<std::string>> table = {{"", "algorithm", "threads", "ISA", "time/frame",
                                                  "p95", "pairs", "missed", "false",
                                                  "allowed extra", "invalid", "status"}};
  const std::vector<Row> rows = sortedRows(results);
  const auto competes = [](const Row& row) { return row.right() && row.result->checked; };
  const auto fastest = std::ranges::find_if(rows, competes);
  for (auto row = rows.begin(); row != rows.end(); ++row) {
    table.push_back(cells(*row, row == fastest));
  }
  text += alignColumns(
      table, {false, false, true, false, true, true, true, true, true, true, true, false});
  for (const Row& row : rows) {
    if (row.result->reason.empty()) continue;
    text += fmt::format("  {}: {}: {}\n", row.result->algorithm, statusName(row.result->status),
                        row.result->reason);
  }
  return text;
}

}  // namespace broadmark
