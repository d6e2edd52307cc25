// Comparing two result files.

#include "e2e/end_to_end.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

class Compare : public EndToEnd {
 protected:
  void SetUp() override {
    runQuietly({"--headless", "freefall", "--objects", "60", "--frames", "8", "--algorithm",
                "sap,bf,sap-simd", "--repetitions", "3", "--json", "before.json"});
    results_ = readJson(file("before.json"));
    ASSERT_EQ(results_.at("cases").size(), 3U);
  }

  /// Writes modified results, and compares them with the original ones.
  ProgramResult compareWith(const Json& after, const Arguments& more = {}) const {
    writeFile(file("after.json"), after.dump());
    Arguments call = {"compare", "before.json", "after.json"};
    call.insert(call.end(), more.begin(), more.end());
    return run(call);
  }

  /// Multiplies all times of a case by a thousand, far beyond any noise.
  static void slowDown(Json& result) {
    for (Json& phase : result.at("frames")) {
      for (Json& pass : phase) {
        for (Json& ns : pass) ns = ns.get<std::int64_t>() * 1000 + 1000;
      }
    }
  }

  static std::string lineWith(const std::string& text, const std::string& word) {
    for (const std::string& line : linesOf(text)) {
      if (line.find(word) != std::string::npos) return line;
    }
    return {};
  }

  Json results_;
};

TEST_F(Compare, WithItself) {
  const ProgramResult ended = run({"compare", "before.json", "before.json"});
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.err, "");
  const auto lines = linesOf(ended.out);
  ASSERT_GE(lines.size(), 5U) << ended.out;  // more if the machine was busy
  for (std::size_t i = 1; i < 4; ++i) EXPECT_THAT(lines[i], HasSubstr("1.000"));
  EXPECT_THAT(lines.back(), testing::StartsWith("3 cases: "));
  EXPECT_THAT(lines.back(), Not(HasSubstr("REGRESSED")));
}

TEST_F(Compare, ASlowerCaseIsARegression) {
  Json after = results_;
  slowDown(after.at("cases").at(1));
  const ProgramResult slower = compareWith(after);
  EXPECT_EQ(slower.status, 3);
  const std::string id = after.at("cases").at(1).at("id");
  EXPECT_THAT(lineWith(slower.out, id), HasSubstr("REGRESSED"));

  const ProgramResult tolerated = compareWith(after, {"--fail-above", "1e9%"});
  EXPECT_EQ(tolerated.status, 0);
  EXPECT_THAT(lineWith(tolerated.out, id), HasSubstr("slower"));

  const ProgramResult faster = run({"compare", "after.json", "before.json"});
  EXPECT_EQ(faster.status, 0);
  EXPECT_THAT(lineWith(faster.out, id), HasSubstr("faster"));
}

TEST_F(Compare, ACaseThatBecameWrongIsARegression) {
  Json after = results_;
  after.at("cases").at(0).at("status") = "mismatch";
  after.at("cases").at(0).at("reason") = "frame 1: 1 missed";
  const ProgramResult worse = compareWith(after);
  EXPECT_EQ(worse.status, 1);
  EXPECT_THAT(worse.out, HasSubstr("ok -> mismatch REGRESSED"));
  const ProgramResult better = run({"compare", "after.json", "before.json"});
  EXPECT_EQ(better.status, 0);
  EXPECT_THAT(better.out, HasSubstr("mismatch -> ok"));
  const ProgramResult neither = run({"compare", "after.json", "after.json"});
  EXPECT_EQ(neither.status, 1) << "still a wrong answer";
  EXPECT_THAT(neither.out, HasSubstr("mismatch in both: frame 1: 1 missed"));
}

TEST_F(Compare, OtherRecordingsAreNotComparable) {
  Json after = results_;
  after.at("cases").at(2).at("recording").at("hash") = "0123";
  const ProgramResult partly = compareWith(after);
  EXPECT_EQ(partly.status, 0);
  EXPECT_THAT(lineWith(partly.out, after.at("cases").at(2).at("id")), HasSubstr("other recording"));

  // A comparison without common cases fails.
  for (Json& result : after.at("cases")) result.at("recording").at("hash") = "0123";
  const ProgramResult wholly = compareWith(after);
  EXPECT_EQ(wholly.status, 2);
  EXPECT_EQ(linesOf(wholly.err).size(), 1U);
  EXPECT_THAT(wholly.err, HasSubstr("after.json"));
}

TEST_F(Compare, MissingCasesFailUnlessAllowed) {
  Json after = results_;
  const std::string gone = after.at("cases").at(1).at("id");
  after.at("cases").erase(1);
  const ProgramResult ended = compareWith(after);
  EXPECT_EQ(ended.status, 3);
  EXPECT_THAT(lineWith(ended.out, gone), HasSubstr("missing"));
  EXPECT_EQ(compareWith(after, {"--allow-missing"}).status, 0);
  const ProgramResult added = run({"compare", "after.json", "before.json"});
  EXPECT_EQ(added.status, 0);
  EXPECT_THAT(lineWith(added.out, gone), HasSubstr("added"));
}

TEST_F(Compare, PairsAreNotComparedWithEvents) {
  runQuietly({"--headless", "freefall", "--objects", "60", "--frames", "8", "--algorithm",
              "sap,bf,sap-simd", "--answer", "events", "--json", "events.json"});
  const ProgramResult ended = run({"compare", "before.json", "events.json"});
  EXPECT_EQ(ended.status, 2) << "nothing in common";
  EXPECT_THAT(lineWith(ended.out, "/bf/events"), HasSubstr("added"));
  EXPECT_EQ(run({"compare", "before.json", "events.json", "--by", "answer"}).status, 2);
}

TEST_F(Compare, AcrossAlgorithmsOfOneRun) {
  const ProgramResult ended =
      run({"compare", "before.json", "--by", "algorithm", "--fail-above", "1e9%"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(linesOf(ended.out).back(), testing::StartsWith("2 cases: "));
  EXPECT_THAT(ended.out, HasSubstr(" against "));
  expectRefusal({"compare", "before.json"}, {"needs two results files", "--by"});
  expectRefusal({"compare", "before.json", "before.json", "--json", "before.json"},
                {"--json", "already used for a source"});
  expectRefusal({"compare", "before.json", "--by", "colour"}, {"--by", "colour"});
}

TEST_F(Compare, WritesWhatOtherProgramsRead) {
  Json after = results_;
  slowDown(after.at("cases").at(1));
  const ProgramResult ended =
      compareWith(after, {"--json", "c.json", "--csv", "c.csv", "--junit", "c.xml", "--markdown",
                          "c.md", "--github", "c.txt"});
  EXPECT_EQ(ended.status, 3);
  const Json comparison = readJson(file("c.json"));
  EXPECT_EQ(comparison.at("cases").at(1).at("verdict"), "REGRESSED");
  EXPECT_EQ(comparison.at("cases").at(1).at("fails"), true);
  EXPECT_EQ(linesOf(readFile(file("c.csv"))).size(), 4U);
  EXPECT_THAT(readFile(file("c.xml")), HasSubstr("failures=\"1\""));
  EXPECT_THAT(readFile(file("c.md")), HasSubstr("**REGRESSED"));
  EXPECT_THAT(readFile(file("c.txt")), HasSubstr("::error title="));
}

/// One repetition leaves everything undecided.
class Settle : public EndToEnd {
 protected:
  /// Runs a source, and writes the results again with times that are 1 % longer.
  void runAndRepeat(const std::string& source) const {
    runQuietly({"--headless", source, "--objects", "60", "--frames", "20", "--algorithm", "sap,bf",
                "--json", "before.json"});
    Json after = readJson(file("before.json"));
    for (Json& result : after.at("cases")) {
      for (Json& phase : result.at("frames")) {
        for (Json& ns : phase.at(0)) ns = ns.get<std::int64_t>() * 101 / 100 + 1;
      }
    }
    writeFile(file("after.json"), after.dump());
  }

  ProgramResult compare(const Arguments& more = {}) const {
    Arguments call = {"compare", "before.json", "after.json", "--fail-above", "900%", "--quiet"};
    call.insert(call.end(), more.begin(), more.end());
    return run(call);
  }
};

TEST_F(Settle, DecidesByDuels) {
  runAndRepeat("freefall");
  const ProgramResult undecided = compare({"--margin", "5%"});
  EXPECT_EQ(undecided.status, 0) << undecided.err;
  EXPECT_THAT(undecided.out, HasSubstr("2 cases: 2 undecided"));
  const ProgramResult settled = compare({"--margin", "10%", "--settle", "--with", places::program(),
                                         "--max-seconds", "60", "--json", "-"});
  EXPECT_EQ(settled.status, 0) << settled.err;
  const Json comparison = Json::parse(settled.out, nullptr, false);
  ASSERT_TRUE(comparison.is_object()) << settled.out;
  for (const Json& compared : comparison.at("cases")) {
    EXPECT_TRUE(compared.at("by_duel").get<bool>());
    EXPECT_NE(compared.at("verdict"), "undecided");
  }
  EXPECT_THAT(comparison.at("notes").back().get<std::string>(),
              HasSubstr("settled by duels, A: " + places::program()));
}

TEST_F(Settle, SaysWhyNot) {
  bakeRecording("mine.aabbs", "60", "20");
  runAndRepeat("mine.aabbs");
  fs::remove(file("mine.aabbs"));
  const ProgramResult gone = compare({"--margin", "5%", "--settle", "--with", places::program()});
  EXPECT_EQ(gone.status, 0) << gone.err;
  EXPECT_THAT(gone.out, HasSubstr("2 cases: 2 undecided"));
  EXPECT_THAT(gone.out, HasSubstr("/sap: not settled: "));
  EXPECT_THAT(gone.out, HasSubstr("mine.aabbs: the recording no longer exists"));
  bakeRecording("mine.aabbs", "60", "20");
  const ProgramResult no_program = compare({"--margin", "5%", "--settle", "--with", "gone"});
  EXPECT_EQ(no_program.status, 0);
  EXPECT_THAT(no_program.out, HasSubstr("/sap: not settled: "));
  EXPECT_THAT(no_program.out, HasSubstr("gone: "));
  expectRefusal({"compare", "before.json", "after.json", "--settle"},
                {"--settle", "--baseline-program"});
  expectRefusal({"compare", "before.json", "after.json", "--baseline-program", "x"}, {"--settle"});
}

TEST_F(Compare, SeveralBaselines) {
  const ProgramResult ended = run({"compare", "before.json", "before.json", "--baseline",
                                   "before.json", "--baseline", "before.json"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("3 cases: "));
}

TEST_F(Compare, DamagedResultsAreNamed) {
  for (const std::string key : {"environments", "options", "cases"}) {
    Json damaged = results_;
    damaged.erase(key);
    writeFile(file("damaged.json"), damaged.dump());
    expectRefusal({"compare", "before.json", "damaged.json"}, {"damaged.json", key});
  }
  Json damaged = results_;
  damaged.at("cases").at(0).at("frames").at("total").at(0).at(0) = -5;
  writeFile(file("damaged.json"), damaged.dump());
  expectRefusal({"compare", "damaged.json", "before.json"}, {"damaged.json", "total"});
  expectRefusal({"compare", "before.json", "missing.json"}, {"missing.json", "No such file"});
}

}  // namespace
}  // namespace broadmark::tests
