// Programs as algorithms.

#include <fmt/format.h>

#include "e2e/end_to_end.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

class External : public EndToEnd {
 protected:
  void SetUp() override {
    if (!fs::exists(kPython)) GTEST_SKIP() << "no Python";
  }

  /// The command of a program with this fault; it has none called "none".
  static std::string program(const std::string& fault) {
    return fmt::format("{} '{}' '{}'", kPython,
                       places::source("tests/support/external.py").string(), fault);
  }

  [[nodiscard]] ProgramResult runWith(const std::string& fault, const Arguments& more = {}) {
    Arguments call = {"--headless", "brownian", "--objects",    "20",         "--frames",    "3",
                      "--quiet",    "--json",   "results.json", "--external", program(fault)};
    call.insert(call.end(), more.begin(), more.end());
    return run(call);
  }

  static constexpr const char* kPython = "/usr/bin/python3";
};

TEST_F(External, RunsBesideTheBuiltInOnes) {
  const ProgramResult ended = runWith(
      "none", {"--algorithm", "sap,outside", "--check", "full", "--param", "outside:slack=0.5"});
  EXPECT_EQ(ended.status, 0) << ended.out << ended.err;
  const Json cases = readJson(file("results.json")).at("cases");
  ASSERT_EQ(cases.size(), 2U);
  const Json& outside = cases[1];
  EXPECT_EQ(outside.at("family"), "Outside (self-timed)");
  EXPECT_EQ(outside.at("plugin"), "external:" + program("none"));
  EXPECT_EQ(outside.at("params").at("slack"), "0.5");
  EXPECT_EQ(outside.at("pairs"), cases[0].at("pairs"));
  EXPECT_TRUE(outside.at("peak_bytes").is_null());
}

TEST_F(External, IsListedConvertedToARequestAndNamedInADuel) {
  EXPECT_THAT(run({"list", "algorithms", "--external", program("none")}).out,
              AllOf(HasSubstr("outside"), HasSubstr("slack")));
  EXPECT_EQ(runWith("none", {"--algorithm", "outside", "--write-request", "request.json"}).status,
            0);
  EXPECT_EQ(readJson(file("request.json")).at("plugin")[0], "external:" + program("none"));
  EXPECT_EQ(run({"--headless", "--request", "request.json", "--quiet"}).status, 0);
  const ProgramResult duel =
      run({"duel", "brownian", "external:" + program("none") + ":outside/slack=1", "sap",
           "--objects", "20", "--frames", "3", "--quiet"});
  EXPECT_EQ(duel.status, 0) << duel.err;
}

TEST_F(External, ParametersAndThreadsReachIt) {
  const ProgramResult ended =
      runWith("parameters", {"--algorithm", "outside", "--param", "slack=0.25"});
  EXPECT_THAT(ended.err, HasSubstr("{'slack': 0.25} 1"));
}

TEST_F(External, FaultsAreResults) {
  const std::pair<const char*, const char*> faults[] = {
      {"raises", "error: frame 1: the program exited with status 1"},
      {"crashes", "error: frame 1: the program crashed with SIGABRT"},
      {"prints", "replied 'hello': a JSON object on one line is expected"},
      {"no time", "'seconds' is missing"},
      {"too long", "reports 1e+06 s for a frame that took"},
      {"error", "error: frame 1: out of cheese"},
      {"too many", "items are claimed"},
      {"missed", "mismatch: frame 1: 1 missed"}};
  for (const auto& [fault, words] : faults) {
    const ProgramResult ended = runWith(fault, {"--algorithm", "outside"});
    EXPECT_EQ(ended.status, 1) << fault << ended.err;
    EXPECT_THAT(ended.out, HasSubstr(words)) << fault;
  }
}

TEST_F(External, AHangEndsAtTheHardLimit) {
  const ProgramResult ended = runWith("hangs", {"--algorithm", "outside", "--hard-limit", "1"});
  EXPECT_EQ(ended.status, 4);
  EXPECT_THAT(ended.out, HasSubstr("no answer within the hard limit"));
}

TEST_F(External, BadDescriptionsAreRefused) {
  const std::pair<std::string, const char*> refused[] = {
      {program("unknown key"), "unknown key 'paramters'"},
      {program("newer"), "version 2 of the protocol, this program supports up to 1"},
      {program("margin"), "margin: a number or the name of a parameter"},
      {program("silent"), "exited with status 0"},
      {"exec no-such-program", "exited with status 127"}};
  for (const auto& [command, words] : refused) {
    const ProgramResult ended = run({"list", "algorithms", "--external", command});
    EXPECT_EQ(ended.status, 2) << command;
    EXPECT_THAT(ended.err, AllOf(HasSubstr("--external: " + command), HasSubstr(words)));
  }
}

}  // namespace
}  // namespace broadmark::tests
