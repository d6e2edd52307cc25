// Human-readable tables.

#include "support/table.h"

#include <gmock/gmock.h>

#include <sstream>

#include "support/words.h"

namespace broadmark::tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// A correct result with these frame times.
CaseResult timedResult(const std::string& algorithm, const std::vector<std::int64_t>& milliseconds,
                       ParameterValues parameters = {}) {
  CaseResult result;
  result.algorithm = algorithm;
  result.recording.scene = {.name = "FreeFall", .object_type = "Cubes", .objects = 1, .frames = 1};
  result.checked = true;
  result.parameters = std::move(parameters);
  Repetition& repetition = result.repetitions.emplace_back();
  for (const std::int64_t time : milliseconds) {
    repetition.frames.emplace_back()[Phase::total] = time * 1'000'000;
  }
  return result;
}

/// The lines of the table, with single spaces between columns.
std::vector<std::string> tableOf(const std::vector<CaseResult>& results) {
  std::vector<std::string> lines;
  std::istringstream text(formatTable(results));
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    std::string& plain = lines.emplace_back();
    for (std::string word; words >> word;) plain += plain.empty() ? word : ' ' + word;
  }
  return lines;
}

TEST(Table, IsRankedByTheMedian) {
  const auto lines =
      tableOf({timedResult("even", {4, 4, 4}), timedResult("disturbed", {3, 3, 90})});
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_THAT(lines[1], HasSubstr("mean median p95"));
  EXPECT_THAT(lines[2], HasSubstr("* disturbed 1 – 32.0 ms 3.00 ms"));
  EXPECT_THAT(lines[3], HasSubstr("even 1 – 4.00 ms 4.00 ms"));
}

TEST(Table, CountsInTheSingular) {
  EXPECT_EQ(tableOf({timedResult("a", {1})}).front(), "FreeFall Cubes, 1 body, 1 frame");
}

TEST(Table, TellsCasesOfOneAlgorithmApart) {
  const auto lines = tableOf({timedResult("kd", {1}, {{"leaf", "9"}, {"margin", "0"}}),
                              timedResult("kd", {2}, {{"leaf", "20"}, {"margin", "0"}}),
                              timedResult("sap", {3}, {{"leaf", "7"}})});
  EXPECT_THAT(lines[1], HasSubstr("parameters"));
  EXPECT_THAT(lines[2], HasSubstr("kd 1 – leaf=9 1.00 ms"));
  EXPECT_THAT(lines[3], HasSubstr("kd 1 – leaf=20 2.00 ms"));
  EXPECT_THAT(lines[4], HasSubstr("sap 1 – 3.00 ms")) << "there is only one of it";
  EXPECT_THAT(tableOf({timedResult("kd", {1}, {{"leaf", "9"}})})[1], Not(HasSubstr("parameters")));
}

TEST(Table, SaysWhatTellsItsRecordingApart) {
  CaseResult result = timedResult("a", {1});
  result.recording.swept = {{"density", "0.1"}, {"seed", "2"}};
  EXPECT_THAT(tableOf({result}).front(), HasSubstr("1 frame, density=0.1, seed=2"));
}

TEST(Wrapped, BreaksBetweenWordsBelowTheBeginning) {
  const std::string nine = "ninechars";
  std::string text;
  for (int i = 0; i < 20; ++i) text += nine + ' ';
  std::vector<std::size_t> lengths;
  std::istringstream lines(wrapped(text, 2, 6));
  for (std::string line; std::getline(lines, line);) lengths.push_back(line.size());
  // Nine words and eight spaces after the two used columns; then after six spaces of indentation.
  EXPECT_THAT(lengths, ElementsAre(89, 95, 25));
}

TEST(Wrapped, LeavesALongWordWhole) {
  const std::string endless(200, 'x');
  EXPECT_EQ(wrapped(endless, 0, 4), endless);
}

TEST(AlignColumns, WrapsTheLastColumnBelowItself) {
  const std::string text = std::string(90, 'x') + " end";
  EXPECT_EQ(alignColumns({{"key", text}}, {false, false}, LastColumn::wrapped),
            "key  " + std::string(90, 'x') + " end\n");
  EXPECT_EQ(alignColumns({{"long key", text}}, {false, false}, LastColumn::wrapped),
            "long key  " + std::string(90, 'x') + "\n          end\n");
}

TEST(Counted, KnowsTheSingular) {
  EXPECT_EQ(counted(0, "case"), "0 cases");
  EXPECT_EQ(counted(1, "case"), "1 case");
  EXPECT_EQ(counted(1, "body", "bodies"), "1 body");
  EXPECT_EQ(counted(2, "body", "bodies"), "2 bodies");
}

}  // namespace
}  // namespace broadmark::tests
