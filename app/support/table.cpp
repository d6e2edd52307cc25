// The table of a recording's cases.

#include "support/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <sstream>
#include <tuple>

#include "support/words.h"

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
  // The right ones first, by median: a disturbance hits the mean. Self-checks, which find no pairs,
  // last.
  std::ranges::stable_sort(rows, {}, [](const Row& row) {
    const bool self_check = row.timed() && !row.result->checked;
    const double untimed = std::numeric_limits<double>::infinity();
    return std::tuple(self_check, !row.right(), row.timed() ? row.summary.median : untimed);
  });
  return rows;
}

/// What tells the cases of one algorithm apart: those of their parameters that differ.
std::string variedParameters(const CaseResult& result, std::span<const CaseResult> all) {
  std::string text;
  for (const auto& [name, value] : result.parameters) {
    const bool varied = std::ranges::any_of(all, [&](const CaseResult& other) {
      const auto found = other.parameters.find(name);
      return other.algorithm == result.algorithm && found != other.parameters.end() &&
             found->second != value;
    });
    if (varied) text += fmt::format("{}{}={}", text.empty() ? "" : " ", name, value);
  }
  return text;
}

std::vector<std::string> cells(const Row& row, const std::string& parameters, bool fastest) {
  const CaseResult& result = *row.result;
  const auto time = [&](double seconds) { return row.timed() ? durationText(seconds) : "–"; };
  const auto count = [&](std::uint64_t n) {
    return result.checked && row.timed() ? fmt::format("{}", n) : "–";
  };
  return {fastest ? "*" : "",
          result.algorithm,
          fmt::format("{}", result.threads),
          result.vectorised ? std::string(isaName(result.isa)) : "–",
          parameters,
          time(row.summary.seconds_per_frame),
          time(row.summary.median),
          time(row.summary.p95),
          row.timed() ? fmt::format("{:.0f}", result.pairs_mean) : "–",
          count(result.missed_count),
          count(result.false_count),
          count(result.allowed_extra_count),
          count(result.invalid_count),
          std::string(statusName(result.status))};
}

constexpr std::size_t kParametersColumn = 4;

/// Leaves out a column that is empty but for its heading.
void dropEmptyColumn(std::vector<std::vector<std::string>>& rows, std::vector<bool>& right_aligned,
                     std::size_t column) {
  const auto is_empty = [&](const auto& row) { return row[column].empty(); };
  if (!std::all_of(rows.begin() + 1, rows.end(), is_empty)) return;
  const auto at = static_cast<std::ptrdiff_t>(column);
  for (auto& row : rows) row.erase(row.begin() + at);
  right_aligned.erase(right_aligned.begin() + at);
}

}  // namespace

std::string wrapped(const std::string& text, std::size_t begun, std::size_t indent) {
  std::string lines;
  std::size_t column = begun;
  bool first = true;
  std::istringstream words(text);
  for (std::string word; words >> word; first = false) {
    const std::size_t room = width(word) + (first ? 0 : 1);
    if (!first && column + room > kWidestLine) {
      lines += fmt::format("\n{:{}}{}", "", indent, word);
      column = indent + width(word);
    } else {
      lines += fmt::format("{}{}", first ? "" : " ", word);
      column += room;
    }
  }
  return lines;
}

std::string alignColumns(const std::vector<std::vector<std::string>>& rows,
                         const std::vector<bool>& right_aligned, LastColumn last) {
  std::vector<std::size_t> widths(right_aligned.size());
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], width(row[c]));
  }
  const std::size_t last_column = widths.size() - 1;
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (c > 0) line += "  ";
      if (c == last_column && last == LastColumn::wrapped) {
        line += wrapped(row[c], width(line), width(line));
        continue;
      }
      const std::string padding(widths[c] - width(row[c]), ' ');
      line += right_aligned[c] ? padding + row[c] : row[c] + padding;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  return text;
}

std::string formatTable(std::span<const CaseResult> results) {
  if (results.empty()) return {};
  const RecordingReference& recording = results.front().recording;
  std::string text = fmt::format("{} {}, {}", recording.scene.name, recording.scene.object_type,
                                 extentText(recording.scene.objects, recording.scene.frames));
  for (const auto& [name, value] : recording.swept) text += fmt::format(", {}={}", name, value);
  for (const auto& [name, value] : recording.reading) {
    text += fmt::format(", {}={}", name, value);
  }
  if (results.front().answer == AnswerKind::events) text += ", events";
  text += '\n';
  std::vector<std::vector<std::string>> table = {{"", "algorithm", "threads", "ISA", "parameters",
                                                  "mean", "median", "p95", "pairs", "missed",
                                                  "false", "allowed extra", "invalid", "status"}};
  const std::vector<Row> rows = sortedRows(results);
  const auto competes = [](const Row& row) { return row.right() && row.result->checked; };
  const auto fastest = std::ranges::find_if(rows, competes);
  for (auto row = rows.begin(); row != rows.end(); ++row) {
    table.push_back(cells(*row, variedParameters(*row->result, results), row == fastest));
  }
  std::vector<bool> right_aligned = {false, false, true, false, false, true, true,
                                     true,  true,  true, true,  true,  true, false};
  dropEmptyColumn(table, right_aligned, kParametersColumn);
  text += alignColumns(table, right_aligned);
  for (const Row& row : rows) {
    if (row.result->reason.empty()) continue;
    text += fmt::format("  {}: {}: {}\n", row.result->algorithm, statusName(row.result->status),
                        row.result->reason);
  }
  return text;
}

}  // namespace broadmark
