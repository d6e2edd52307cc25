// Comparing two result files.

#include "e2e/end_to_end.h"

namespace broadmark::tests {
namespace {

class Compare : public EndToEnd {
 protected:
  void SetUp() override {
    runQuietly({"--headless", "freefall", "--objects", "60", "--frames", "8", "--algorithm",
                "sap,bf,sap-simd", "--json", "before.json"});
    results_ = readJson(file("before.json"));
    ASSERT_EQ(results_.at("cases").size(), 3U);
  }

  /// Writes the results, changed by hand, and compares them with the real ones.
  Ended compareWith(const Json& after, const Arguments& more = {}) const {
    writeFile(file("after.json"), after.dump());
    Arguments call = {"compare", "before.json", "after.json"};
    call.insert(call.end(), more.begin(), more.end());
    return run(call);
  }

  /// Makes all times of a case a thousand times as long: far beyond any noise.
  static void slowDown(Json& one) {
    for (Json& phase : one.at("frames")) {
      for (Json& ns : phase.at(0)) ns = ns.get<std::int64_t>() * 1000 + 1000;
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
  const Ended ended = run({"compare", "before.json", "before.json"});
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.err, "");
  const auto lines = linesOf(ended.out);
  ASSERT_EQ(lines.size(), 4U) << ended.out;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    EXPECT_THAT(lines[i], HasSubstr("1.000"));
    EXPECT_THAT(lines[i], HasSubstr("same within noise"));
  }
}

TEST_F(Compare, ASlowerCaseIsARegression) {
  Json after = results_;
  slowDown(after.at("cases").at(1));
  const Ended slower = compareWith(after);
  EXPECT_EQ(slower.status, 3);
  const std::string id = after.at("cases").at(1).at("id");
  EXPECT_THAT(lineWith(slower.out, id), HasSubstr("REGRESSED"));
  EXPECT_EQ(slower.out.find("REGRESSED"), slower.out.rfind("REGRESSED")) << slower.out;

  const Ended tolerated = compareWith(after, {"--fail-above", "1e9"});
  EXPECT_EQ(tolerated.status, 0);
  EXPECT_THAT(lineWith(tolerated.out, id), HasSubstr("slower"));

  const Ended faster = run({"compare", "after.json", "before.json"});
  EXPECT_EQ(faster.status, 0);
  EXPECT_THAT(lineWith(faster.out, id), HasSubstr("faster"));
}

TEST_F(Compare, ACaseThatBecameWrongIsARegression) {
  Json after = results_;
  after.at("cases").at(0).at("status") = "mismatch";
  after.at("cases").at(0).at("reason") = "frame 1: 1 missed";
  const Ended worse = compareWith(after);
  EXPECT_EQ(worse.status, 3);
  EXPECT_THAT(worse.out, HasSubstr("ok -> mismatch REGRESSED"));
  const Ended better = run({"compare", "after.json", "before.json"});
  EXPECT_EQ(better.status, 0);
  EXPECT_THAT(better.out, HasSubstr("mismatch -> ok"));
  const Ended neither = run({"compare", "after.json", "after.json"});
  EXPECT_EQ(neither.status, 0);
  EXPECT_THAT(neither.out, HasSubstr("mismatch in both"));
}

TEST_F(Compare, OtherRecordingsAreNotComparable) {
  Json after = results_;
  after.at("cases").at(2).at("recording").at("hash") = "0123";
  const Ended partly = compareWith(after);
  EXPECT_EQ(partly.status, 0);
  EXPECT_THAT(lineWith(partly.out, after.at("cases").at(2).at("id")),
              HasSubstr("not comparable: other recording"));

  // Nothing compared is nothing passed.
  for (Json& one : after.at("cases")) one.at("recording").at("hash") = "0123";
  const Ended wholly = compareWith(after);
  EXPECT_EQ(wholly.status, 2);
  EXPECT_EQ(linesOf(wholly.err).size(), 1U);
  EXPECT_THAT(wholly.err, HasSubstr("after.json"));
}

TEST_F(Compare, CasesOfOneFileOnly) {
  Json after = results_;
  after.at("cases").at(0).at("id") = "new";
  const Ended ended = compareWith(after);
  EXPECT_EQ(ended.status, 0);
  EXPECT_THAT(lineWith(ended.out, "new"), HasSubstr("only in B"));
  EXPECT_THAT(lineWith(ended.out, results_.at("cases").at(0).at("id")), HasSubstr("only in A"));
}

TEST_F(Compare, CasesOfTheSameNameAreTakenInTurn) {
  Json twice = results_;
  twice.at("cases").push_back(twice.at("cases").at(0));
  slowDown(twice.at("cases").back());
  writeFile(file("twice.json"), twice.dump());
  const Ended ended = run({"compare", "twice.json", "twice.json"});
  EXPECT_EQ(ended.status, 0) << ended.out;
  EXPECT_EQ(linesOf(ended.out).size(), 5U);
  EXPECT_THAT(ended.out, Not(HasSubstr("only in")));
}

TEST_F(Compare, DamagedResultsAreNamed) {
  for (const std::string key : {"environment", "options", "cases"}) {
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
