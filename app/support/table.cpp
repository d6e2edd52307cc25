// The table of a recording's cases.

#include "support/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <tuple>
#include <variant>

#include "support/words.h"

namespace broadmark {
namespace {

/// Number of UTF-8 characters.
std::size_t width(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

/// Key of the column that shows only parameters that differ between cases.
constexpr std::string_view kParameters = "params";

constexpr std::string_view kInstructionsColumn = "instructions_per_frame";

/// A result with its summary, computed once.
struct Row {
  const CaseResult* result;
  Summary summary;

  /// Whether there are times, or counts.
  [[nodiscard]] bool isMeasured() const {
    return std::ranges::any_of(result->repetitions, [&](const Repetition& pass) {
      return !pass.frames.empty() || !result->timed();
    });
  }
  [[nodiscard]] bool isCorrect() const { return isMeasured() && result->status == Status::ok; }
  /// The median time, or the instructions per frame.
  [[nodiscard]] double cost() const {
    if (!isMeasured()) return std::numeric_limits<double>::infinity();
    if (result->timed()) return summary.median;
    return result->perFrame(ProcessorCounter::instructions).value_or(0);
  }
};

std::vector<Row> sortedRows(std::span<const CaseResult> results) {
  std::vector<Row> rows;
  for (const CaseResult& result : results) rows.push_back({&result, result.summary()});
  // Correct results first, by median, as disturbances distort the mean; self-checks, which find no
  // pairs, last.
  std::ranges::stable_sort(rows, {}, [](const Row& row) {
    const bool self_check = row.isMeasured() && !row.result->checked;
    return std::tuple(self_check, !row.isCorrect(), row.cost());
  });
  return rows;
}

/// Parameters that differ between the cases of an algorithm, with their values.
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

}  // namespace

std::string cellText(const CaseColumn& column, const CaseResult& result, const Summary& summary,
                     std::string (*seconds_text)(double)) {
  const ColumnValue value = column.shownValueOf(result, summary);
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* integer = std::get_if<std::uint64_t>(&value)) {
    return column.unit == ColumnUnit::bytes ? bytesText(*integer) : fmt::format("{}", *integer);
  }
  const auto* number = std::get_if<double>(&value);
  if (number == nullptr) return "–";
  return column.unit == ColumnUnit::seconds ? seconds_text(*number)
                                            : fmt::format("{:.0f}", *number);
}

std::string wrapped(const std::string& text, std::size_t start_column, std::size_t indent,
                    std::size_t line_width) {
  std::string lines;
  std::size_t column = start_column;
  bool first = true;
  std::istringstream words(text);
  for (std::string word; words >> word; first = false) {
    const std::size_t added = width(word) + (first ? 0 : 1);
    if (!first && column + added > line_width) {
      lines += fmt::format("\n{:{}}{}", "", indent, word);
      column = indent + width(word);
    } else {
      lines += fmt::format("{}{}", first ? "" : " ", word);
      column += added;
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
  if (const Answer answer = results.front().answer; answer != AnswerKind::pairs) {
    text += ", " + answerName(answer);
  }
  text += '\n';
  std::vector<const CaseColumn*> columns = caseColumns(&ColumnDisplay::terminal);
  const auto is_varied = [&](const CaseResult& result) {
    return !variedParameters(result, results).empty();
  };
  if (std::ranges::none_of(results, is_varied)) {
    std::erase_if(columns, [](const CaseColumn* column) { return column->key == kParameters; });
  }
  // The results of a run hold either times or instructions.
  const bool timed = std::ranges::any_of(results, &CaseResult::timed);
  std::erase_if(columns, [timed](const CaseColumn* column) {
    return timed ? column->key == kInstructionsColumn : column->unit == ColumnUnit::seconds;
  });
  std::vector<std::vector<std::string>> table = {{""}};
  std::vector<bool> right_aligned = {false};
  for (const CaseColumn* column : columns) {
    const bool has_hits = column->key == "pairs_mean" && isQuery(results.front().answer);
    table.front().push_back(has_hits ? "hits" : column->shown.heading);
    right_aligned.push_back(!column->isText());
  }
  const std::vector<Row> rows = sortedRows(results);
  const auto competes = [](const Row& row) { return row.isCorrect() && row.result->checked; };
  const auto fastest = std::ranges::find_if(rows, competes);
  for (auto row = rows.begin(); row != rows.end(); ++row) {
    std::vector<std::string>& cells = table.emplace_back();
    cells.emplace_back(row == fastest ? "*" : "");
    for (const CaseColumn* column : columns) {
      cells.push_back(column->key == kParameters ? variedParameters(*row->result, results)
                                                 : cellText(*column, *row->result, row->summary));
    }
  }
  text += alignColumns(table, right_aligned);
  for (const Row& row : rows) {
    if (row.result->reason.empty()) continue;
    text += fmt::format("  {}: {}: {}\n", row.result->algorithm, statusName(row.result->status),
                        row.result->reason);
  }
  return text;
}

}  // namespace broadmark
