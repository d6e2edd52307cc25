// The columns of a case's result, defined once: for CSV, the terminal's table, the inspector's
// list, and the plain values of JSON. docs/results.md lists the columns; Python and the report page
// use python/broadmark/columns.json. tests/engine/case_columns_test.cpp writes both files.
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

/// The value of a column; monostate if unknown.
using ColumnValue = std::variant<std::monostate, std::string, std::uint64_t, double>;

enum class ColumnUnit { none, seconds, bytes };

/// The cases with a value: all, those with a repetition, or those with checked answers.
enum class Availability { always, timed, checked };

/// The conversion from the value at a column's JSON path.
enum class JsonForm {
  value,      ///< unchanged
  text,       ///< unchanged if a string; otherwise empty
  joined,     ///< "NAME=VALUE;…" of an object; otherwise empty
  count,      ///< the number of elements
  seconds,    ///< the mean of nanoseconds, in seconds; 0 without any
  per_frame,  ///< the sum over the repetitions with a value, divided by their frames
};

struct JsonField {
  std::string path = {};  ///< keys and array indices separated by '/'; "": not in JSON
  JsonForm form = JsonForm::value;
  bool optional = false;                       ///< may be null or missing
  bool derived = false;                        ///< written, but not read
  std::optional<std::string> if_missing = {};  ///< replaces a missing value
};

/// The display of a column in tables. Integers are positions: the smallest is on the left, 0 means
/// hidden.
struct ColumnDisplay {
  bool csv = true;
  Availability known = Availability::always;
  bool frames = false;  ///< in the table of frames, where the column identifies the case
  int terminal = 0;
  int inspector = 0;
  int report = 0;            ///< the report page
  int rank = 1;              ///< on the report page: 1 always, 2 and 3 on wider screens only
  bool figure = false;       ///< among the details of a case on the report page
  bool particular = false;   ///< the same, further below, and only if not 0
  std::string heading = {};  ///< column heading; defaults to the title
  /// Returns whether tables show a known value; null: always.
  bool (*meaningful)(const CaseResult&) = nullptr;
  /// The inspector's sort key; null: the value.
  std::function<ColumnValue(const CaseResult&)> order = {};
};

struct CaseColumn {
  std::string key;  ///< its name in CSV and in Python
  std::string title;
  ColumnUnit unit = ColumnUnit::none;
  JsonField json;
  ColumnDisplay shown;
  std::function<ColumnValue(const CaseResult&, const Summary&)> value;
  /// Reads the value at a key; null for the default conversion.
  std::function<void(const JsonFields&, const char* key, CaseResult&)> read = {};

  [[nodiscard]] bool isText() const;
  /// The value; monostate if unknown.
  [[nodiscard]] ColumnValue valueOf(const CaseResult&, const Summary&) const;
  /// The value; monostate if unknown or not meaningful.
  [[nodiscard]] ColumnValue shownValueOf(const CaseResult&, const Summary&) const;
};

/// All columns, in CSV order.
const std::vector<CaseColumn>& caseColumns();
/// The columns of a table, from the left.
std::vector<const CaseColumn*> caseColumns(int ColumnDisplay::* place);

}  // namespace broadmark
