// Merging shards, and results as JSON Lines.

#include "e2e/end_to_end.h"

namespace broadmark::tests {
namespace {

class Merge : public EndToEnd {
 protected:
  /// Runs one of two shards, with results in NAME.
  void runShard(const std::string& shard, const std::string& option, const std::string& name) {
    runQuietly({"--headless", "freefall", "--objects", "40", "--frames", "5", "--algorithm",
                "sap,bf,kd", "--shard", shard, option, name});
  }
};

TEST_F(Merge, TwoShardsGiveTheWholeRun) {
  runShard("0/2", "--jsonl", "a.jsonl");
  runShard("1/2", "--json", "b.json");
  const ProgramResult ended =
      run({"merge", "a.jsonl", "b.json", "--json", "whole.json", "--csv", "w.csv"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("3 cases from 2 files"));
  const Json whole = readJson(file("whole.json"));
  EXPECT_EQ(whole.at("cases").size(), 3U);
  EXPECT_EQ(whole.at("environments").size(), 1U);
  EXPECT_EQ(whole.at("complete"), true);
  EXPECT_EQ(linesOf(readFile(file("w.csv"))).size(), 4U);
  const ProgramResult same = run({"compare", "whole.json", "a.jsonl", "--allow-missing"});
  EXPECT_EQ(same.status, 0) << same.err << same.out;
}

TEST_F(Merge, DifferentBuildsAreTold) {
  runShard("0/2", "--json", "a.json");
  runShard("1/2", "--json", "b.json");
  EXPECT_THAT(run({"merge", "a.json", "b.json", "--json", "same.json"}).err,
              Not(HasSubstr("builds")));
  Json other = readJson(file("b.json"));
  other["environments"][0]["commit"] = std::string(40, 'a');
  other["environments"][0]["dirty"] = true;
  writeFile(file("b.json"), other.dump());
  const ProgramResult ended = run({"merge", "a.json", "b.json", "--json", "both.json"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("of different builds: "));
  EXPECT_THAT(ended.err, HasSubstr("commit aaaaaaaaaa with changes, "));
  EXPECT_EQ(readJson(file("both.json")).at("environments").size(), 2U);
}

TEST_F(Merge, LinesAreWrittenAsTheRunGoes) {
  runShard("0/1", "--jsonl", "a.jsonl");
  const std::vector<std::string> lines = linesOf(readFile(file("a.jsonl")));
  ASSERT_EQ(lines.size(), 1U + 1 + 3 + 1);
  for (const std::string& line : lines) EXPECT_TRUE(Json::accept(line));
  EXPECT_EQ(Json::parse(lines.front()).at("schema"), "broadmark-results/2");
  EXPECT_EQ(Json::parse(lines.back()).at("end").at("complete"), true);
}

TEST_F(Merge, BadUseIsRefused) {
  expectRefusal({"merge", "missing.json", "--json", "x.json"}, {"missing.json"});
  runShard("0/2", "--json", "a.json");
  expectRefusal({"merge", "a.json"}, {"--json"});
}

}  // namespace
}  // namespace broadmark::tests
