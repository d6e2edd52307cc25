// What a case's result has, stated once: the columns of CSV, of the terminal's table and of the
// inspector's list, and the plain values of JSON. docs/results.md lists them, and Python and the
// report page follow python/broadmark/columns.json; both are written by
// tests/engine/case_columns_test.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "broadmark/harness/case_result.h"

namespace broadmark {

class JsonFields;

/// The value of a column; nothing where it is not known.
using ColumnValue = std::variant<std::monostate, std::string, std::uint64_t, double>;

enum class ColumnUnit { none, seconds, bytes };

/// Which cases have the value: those with a repetition, or those whose answers were checked.
enum class Known { always, timed, checked };

/// How a column follows from what stands at its place in JSON.
enum class JsonForm {
  value,      ///< the same
  text,       ///< the same if that is a text; otherwise empty
  joined,     ///< "NAME=VALUE;…" of an object; otherwise empty
  count,      ///< the number of elements
  seconds,    ///< the mean of nanoseconds, in seconds; 0 without any
  per_frame,  ///< the sum over the repetitions that have it, by their frames
};

struct JsonPlace {
  std::string path = {};  ///< keys, and indices of arrays, with '/' between; "": nowhere
  JsonForm form = JsonForm::value;
  bool optional = false;                       ///< may be null or missing
  bool derived = false;                        ///< written by the table, but not read by it
  std::optional<std::string> if_missing = {};  ///< a text
};

/// When and where a column is shown, and how. Numbers are places in a table for people: the
/// smallest is on the left, 0 is not in it.
struct ColumnShown {
  bool csv = true;
  Known known = Known::always;
  bool frames = false;  ///< in the table of frames: the column identifies the case
  int terminal = 0;
  int inspector = 0;
  int report = 0;            ///< the report page
  int rank = 1;              ///< there: 1 always, 2 and 3 on wider screens only
  bool figure = false;       ///< among the details of a case there
  bool particular = false;   ///< the same, further below, and only if it is not 0
  std::string heading = {};  ///< above a column; by default its title
  /// Whether tables for people show a value that is known; null: always.
  bool (*meaningful)(const CaseResult&) = nullptr;
  /// What the inspector sorts by; null: the value.
  std::function<ColumnValue(const CaseResult&)> order = {};
};

struct CaseColumn {
  std::string key;  ///< its name in CSV and in Python
  std::string title;
  ColumnUnit unit = ColumnUnit::none;
  JsonPlace json;
  ColumnShown shown;
  std::function<ColumnValue(const CaseResult&, const Summary&)> value;
  /// Reads the value at a key; null where it is not read as all others.
  std::function<void(const JsonFields&, const char* key, CaseResult&)> read = {};

  [[nodiscard]] bool isText() const;
  /// Nothing where it is not known.
  [[nodiscard]] ColumnValue valueOf(const CaseResult&, const Summary&) const;
  /// Nothing where it is not known or not meaningful.
  [[nodiscard]] ColumnValue shownValueOf(const CaseResult&, const Summary&) const;
};

/// All columns, in the order of CSV.
const std::vector<CaseColumn>& caseColumns();
/// The columns of a table for people, from the left.
std::vector<const CaseColumn*> caseColumns(int ColumnShown::*place);

}  // namespace broadmark
