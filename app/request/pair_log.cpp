#include "request/pair_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>

#include "broadmark/json_fields.h"
#include "support/line_reader.h"

namespace broadmark {
namespace {

using imports::LineReader;
using imports::lowered;

using imports::splitCells;
using imports::trimmed;

constexpr std::int64_t kMaxId = std::numeric_limits<std::uint32_t>::max();

std::uint32_t number(const LineReader& lines, std::int64_t value, std::string_view what) {
  if (value < 0 || value > kMaxId) {
    lines.fail(fmt::format("{} {} is not an integer from 0 to {}", what, value, kMaxId));
  }
  return static_cast<std::uint32_t>(value);
}

std::uint32_t number(const LineReader& lines, std::string_view text, std::string_view what) {
  return number(lines, lines.integer(text, what), what);
}

std::uint32_t number(const LineReader& lines, const Json& value, std::string_view what) {
  if (!value.is_number_integer() ||
      (value.is_number_unsigned() && value.get<std::uint64_t>() > kMaxId)) {
    lines.fail(fmt::format("{} is not an integer from 0 to {}", what, kMaxId));
  }
  return number(lines, value.get<std::int64_t>(), what);
}

/// Indices of a table's columns.
struct Columns {
  std::size_t frame = 0;
  std::size_t a = 0;
  std::size_t b = 0;
  std::optional<std::size_t> event;
};

Columns columnsOf(const LineReader& lines, const std::vector<std::string_view>& cells) {
  std::vector<std::string> names;
  std::ranges::transform(cells, std::back_inserter(names), lowered);
  const auto find = [&](std::string_view name) -> std::optional<std::size_t> {
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) return std::nullopt;
    return static_cast<std::size_t>(found - names.begin());
  };
  const auto require = [&](std::string_view name) {
    const auto found = find(name);
    if (!found) {
      lines.fail(fmt::format(
          "no column '{}': a heading with frame, a, b and, for events, event is expected, or JSON "
          "Lines",
          name));
    }
    return *found;
  };
  return {.frame = require("frame"), .a = require("a"), .b = require("b"), .event = find("event")};
}

/// Reads the rows of a file into `Rows`, PairLog's.
template <class Rows>
class Reader {
 public:
  Reader(const std::filesystem::path& path, Rows& rows) : lines_(path), rows_(rows) {}

  /// Returns whether the rows are events.
  bool read() {
    std::optional<bool> is_json;
    while (lines_.next()) {
      const std::string_view line = trimmed(lines_.line());
      if (line.empty() || line.starts_with('#')) continue;
      if (!is_json) is_json = line.starts_with('{');
      *is_json ? readObject() : readRow();
    }
    if (!is_json) lines_.fail(0, "is empty: a heading or JSON Lines are expected");
    return events_.value_or(false);
  }

 private:
  void requireKind(bool events) {
    if (events_.value_or(events) != events) lines_.fail("pairs and events are mixed");
    events_ = events;
  }

  void add(std::uint32_t frame, std::uint32_t a, std::uint32_t b, bool ends) {
    rows_[frame].push_back({{std::min(a, b), std::max(a, b)}, ends});
  }

  void readObject() {
    const Json object = jsonOrNull(lines_.line());
    if (!object.is_object() || !object.contains("frame")) {
      lines_.fail("is not a JSON object with \"frame\"");
    }
    const std::uint32_t frame = number(lines_, object.at("frame"), "frame");
    rows_[frame];
    bool has_any = false;
    for (const char* key : {"pairs", "began", "ended"}) {
      if (!object.contains(key)) continue;
      has_any = true;
      requireKind(std::string_view(key) != "pairs");
      readPairs(frame, key, object.at(key));
    }
    if (!has_any) lines_.fail("has neither \"pairs\" nor \"began\" or \"ended\"");
  }

  void readPairs(std::uint32_t frame, std::string_view key, const Json& list) {
    if (!list.is_array()) lines_.fail(fmt::format("\"{}\" is not an array of pairs", key));
    for (const Json& pair : list) {
      if (!pair.is_array() || pair.size() != 2) {
        lines_.fail(fmt::format("\"{}\" holds something that is not a pair [a, b]", key));
      }
      add(frame, number(lines_, pair[0], "a"), number(lines_, pair[1], "b"), key == "ended");
    }
  }

  void readHeading() {
    separator_ = std::ranges::max(std::string_view(",;\t"), {},
                                  [&](char c) { return std::ranges::count(lines_.line(), c); });
    splitCells(separator_, lines_.line(), cells_);
    columns_ = columnsOf(lines_, cells_);
    requireKind(columns_->event.has_value());
  }

  void readRow() {
    if (!columns_) return readHeading();
    splitCells(separator_, lines_.line(), cells_);
    const std::size_t needed =
        std::max({columns_->frame, columns_->a, columns_->b, columns_->event.value_or(0)});
    if (cells_.size() <= needed) {
      lines_.fail(fmt::format("has {} cells, not {}", cells_.size(), needed + 1));
    }
    add(number(lines_, cells_[columns_->frame], "frame"), number(lines_, cells_[columns_->a], "a"),
        number(lines_, cells_[columns_->b], "b"),
        columns_->event && isEnd(cells_[*columns_->event]));
  }

  [[nodiscard]] bool isEnd(std::string_view cell) const {
    const std::string event = lowered(cell);
    if (event != "begin" && event != "end") {
      lines_.fail(fmt::format("event {}: begin or end is expected", imports::quoted(event)));
    }
    return event == "end";
  }

  LineReader lines_;
  Rows& rows_;
  std::optional<bool> events_;  ///< of all lines so far
  // Of a table.
  char separator_ = ',';
  std::optional<Columns> columns_;
  std::vector<std::string_view> cells_;
};

}  // namespace

PairLog::PairLog(const std::filesystem::path& path) : has_events_(Reader(path, rows_).read()) {}

const std::vector<Pair>& PairLog::pairsOf(std::uint32_t frame) {
  pairs_.clear();
  impossible_.clear();
  const auto rows = rows_.find(frame);
  if (!has_events_) {
    if (rows == rows_.end()) return pairs_;
    for (const Row& row : rows->second) pairs_.push_back(row.pair);
    return pairs_;
  }
  if (rows != rows_.end()) {
    for (const auto& [pair, ends] : rows->second) {
      if (!ends) {
        ++present_[pair];
      } else if (const auto found = present_.find(pair); found == present_.end()) {
        impossible_.push_back(pair);
      } else if (--found->second == 0) {
        present_.erase(found);
      }
    }
  }
  for (const auto& [pair, count] : present_) {
    pairs_.insert(pairs_.end(), static_cast<std::size_t>(count), pair);
  }
  return pairs_;
}

}  // namespace broadmark
