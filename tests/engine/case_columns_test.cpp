// Files generated from the table of columns: docs/results.md and the file that Python reads. With
// BROADMARK_UPDATE_GOLDEN=1 in the environment both are written instead of compared.

#include "broadmark/results/case_columns.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>

#include "broadmark/files.h"
#include "broadmark/names.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

using Json = nlohmann::ordered_json;

constexpr NameTable kUnitNames{{NamedValue{ColumnUnit::none, ""},
                                {ColumnUnit::seconds, "seconds"},
                                {ColumnUnit::bytes, "bytes"}}};
constexpr NameTable kKnownNames{{NamedValue{Availability::always, "always"},
                                 {Availability::timed, "timed"},
                                 {Availability::checked, "checked"}}};
constexpr NameTable kFormNames{{NamedValue{JsonForm::value, "value"},
                                {JsonForm::text, "text"},
                                {JsonForm::joined, "joined"},
                                {JsonForm::count, "count"},
                                {JsonForm::seconds, "seconds"},
                                {JsonForm::per_frame, "per_frame"}}};
/// Formats as described in the documentation.
constexpr NameTable kFormRules{{NamedValue{JsonForm::value, "`{}`"},
                                {JsonForm::text, "`{}`, if it is a text"},
                                {JsonForm::joined, "`{}`, as `NAME=VALUE;…`"},
                                {JsonForm::count, "the number of `{}`"},
                                {JsonForm::seconds, "mean of `{}`, in seconds"},
                                {JsonForm::per_frame, "`{}` by the number of frames"}}};
constexpr NameTable kKnownRules{{NamedValue{Availability::always, ""},
                                 {Availability::timed, "; empty without a repetition"},
                                 {Availability::checked, "; empty unless `checked`"}}};

/// A column for Python and the report page.
Json toJson(const CaseColumn& column) {
  return {{"key", column.key},
          {"title", column.title},
          {"heading", column.shown.heading},
          {"kind", column.isText() ? "text" : "number"},
          {"unit", kUnitNames.nameOf(column.unit)},
          {"known", kKnownNames.nameOf(column.shown.known)},
          {"path", column.json.path},
          {"form", kFormNames.nameOf(column.json.form)},
          {"optional", column.json.optional},
          {"if_missing", column.json.if_missing ? Json(*column.json.if_missing) : Json(nullptr)},
          {"frames", column.shown.frames},
          {"report", column.shown.report},
          {"rank", column.shown.rank},
          {"figure", column.shown.figure},
          {"particular", column.shown.particular}};
}

std::string columnsFile() {
  std::string text;
  for (const CaseColumn& column : caseColumns()) {
    if (column.shown.csv) text += (text.empty() ? "[\n" : ",\n") + toJson(column).dump();
  }
  return text + "\n]\n";
}

constexpr std::string_view kTableHead = "| column | is | in the JSON of a case |\n|---|---|---|\n";

std::string documentedTable() {
  std::string text(kTableHead);
  for (const CaseColumn& column : caseColumns()) {
    if (!column.shown.csv) continue;
    std::string rule(kFormRules.nameOf(column.json.form));
    rule.replace(rule.find("{}"), 2, column.json.path);
    text += "| `" + column.key + "` | " + column.title + " | " + rule +
            std::string(kKnownRules.nameOf(column.shown.known)) + " |\n";
  }
  return text;
}

/// Compares a file with its expected contents, or writes it.
void expectFile(const std::filesystem::path& file, const std::string& expected) {
  const char* update = std::getenv("BROADMARK_UPDATE_GOLDEN");
  if (update != nullptr && std::string(update) == "1") writeTextFile(file, expected);
  EXPECT_EQ(readTextFile(file), expected) << "to write it: BROADMARK_UPDATE_GOLDEN=1";
}

TEST(CaseColumns, ArePythonsToo) {
  expectFile(places::source("python/broadmark/columns.json"), columnsFile());
}

TEST(CaseColumns, AreDocumented) {
  const std::filesystem::path file = places::source("docs/results.md");
  std::string text = readTextFile(file);
  const std::size_t begin = text.find(kTableHead);
  ASSERT_NE(begin, text.npos) << "a table that begins as this does is expected: " << kTableHead;
  const std::size_t end = text.find("\n\n", begin);
  text.replace(begin, end == text.npos ? end : end + 1 - begin, documentedTable());
  expectFile(file, text);
}

TEST(CaseColumns, AreSaidOnce) {
  std::set<std::string> keys;
  for (const CaseColumn& column : caseColumns()) {
    EXPECT_TRUE(keys.insert(column.key).second) << column.key;
    EXPECT_EQ(column.shown.csv, !column.json.path.empty()) << column.key;
  }
  for (const auto order :
       {&ColumnDisplay::terminal, &ColumnDisplay::inspector, &ColumnDisplay::report}) {
    std::set<int> positions;
    for (const CaseColumn* column : caseColumns(order)) {
      EXPECT_TRUE(positions.insert(column->shown.*order).second) << column->key;
    }
  }
}

}  // namespace
}  // namespace broadmark::tests
