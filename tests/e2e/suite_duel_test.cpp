// The command 'duel' on whole suites.

#include "broadmark/execution.h"
#include "e2e/end_to_end.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

class SuiteDuel : public EndToEnd {
 protected:
  /// A duel on two small scenes.
  [[nodiscard]] static Arguments duelOf(const Arguments& more) {
    Arguments call = {"duel",     "freefall", "brownian",      "--objects", "100",
                      "--frames", "20",       "--max-seconds", "20",        "--quiet"};
    call.insert(call.end(), more.begin(), more.end());
    return call;
  }

  /// A duel of the two builds of a plug-in.
  [[nodiscard]] ProgramResult duelOfPlugins(const std::string& baseline, const std::string& judged,
                                            const Arguments& more = {}) const {
    Arguments arguments = {"--algorithm", "repeated-search",   "--plugin",
                           judged,        "--baseline-plugin", baseline};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(duelOf(arguments));
  }

  const std::string quick_ = places::quickPlugin();
  const std::string slow_ = places::slowPlugin();
};

TEST_F(SuiteDuel, ASlowerBuildIsARegression) {
  const ProgramResult ended = duelOfPlugins(
      quick_, slow_,
      {"--json", "d.json", "--markdown", "d.md", "--junit", "d.xml", "--github", "d.txt"});
  EXPECT_EQ(ended.status, 3) << ended.out << ended.err;
  for (const char* text : {"FreeFall/Cubes/N100/F20", "Brownian/Cubes/N100/F20", "REGRESSED",
                           "2 cases: 2 REGRESSED", "A: this program"}) {
    EXPECT_THAT(ended.out, HasSubstr(text));
  }
  const Json cases = readJson(file("d.json")).at("cases");
  ASSERT_EQ(cases.size(), 2U);
  for (const Json& compared : cases) {
    EXPECT_EQ(compared.at("verdict"), "REGRESSED");
    EXPECT_GT(compared.at("ratio"), 2);
    EXPECT_GT(compared.at("ci95").at(0), 1.05);
    EXPECT_TRUE(compared.at("by_duel").get<bool>());
  }
  EXPECT_THAT(readFile(file("d.md")), HasSubstr("**REGRESSED"));
  EXPECT_THAT(readFile(file("d.xml")), HasSubstr("\"broadmark duel\" tests=\"2\" failures=\"2\""));
  EXPECT_THAT(readFile(file("d.txt")), HasSubstr("::error title=broadmark duel::FreeFall/"));
  EXPECT_THAT(readFile(file("d.txt")), HasSubstr("(ratio "));
}

TEST_F(SuiteDuel, AFasterOrToleratedBuildIsNone) {
  const ProgramResult faster = duelOfPlugins(slow_, quick_);
  EXPECT_EQ(faster.status, 0) << faster.err;
  EXPECT_THAT(faster.out, HasSubstr("2 cases: 2 faster"));
  const ProgramResult tolerated = duelOfPlugins(quick_, slow_, {"--fail-above", "100000%"});
  EXPECT_EQ(tolerated.status, 0) << tolerated.err;
  EXPECT_THAT(tolerated.out, HasSubstr("2 cases: 2 slower"));
}

TEST_F(SuiteDuel, EachCaseThatHasEndedIsReported) {
  Arguments call =
      duelOf({"--algorithm", "repeated-search", "--plugin", slow_, "--baseline-plugin", quick_});
  std::erase(call, "--quiet");
  const ProgramResult ended = run(call);
  EXPECT_EQ(ended.status, 3);
  EXPECT_THAT(ended.err, HasSubstr("repeated-search: REGRESSED"));
  EXPECT_THAT(ended.err, HasSubstr(" rounds, ratio "));
  EXPECT_THAT(ended.err, HasSubstr("duels: done"));
}

TEST_F(SuiteDuel, OfTwoPrograms) {
  bakeRecording("mine.aabbs");
  const ProgramResult ended = run({"duel",
                                   "mine.aabbs",
                                   "swarm",
                                   "--objects",
                                   "60",
                                   "--frames",
                                   "10",
                                   "--algorithm",
                                   "sap,kd-mt",
                                   "--threads",
                                   "1,2",
                                   "--with",
                                   places::program(),
                                   "--max-seconds",
                                   "2",
                                   "--fail-above",
                                   "900%",
                                   "--json",
                                   "-",
                                   "--quiet"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  const Json document = Json::parse(ended.out, nullptr, false);
  ASSERT_TRUE(document.is_object()) << ended.out;
  EXPECT_EQ(document.at("cases").size(), 6U) << "two sources, sap, kd-mt with one and two threads";
  EXPECT_THAT(document.at("notes").at(0).get<std::string>(),
              HasSubstr("A: " + places::program() + "; B: this program"));
}

TEST_F(SuiteDuel, WithoutAnotherBuildVariantsAreComparedWithTheFirst) {
  const Arguments call = {"--algorithm", "time-validator", "--param", "phase_us=20,200"};
  const ProgramResult ended = run(duelOf(call));
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr(" against "));
  EXPECT_THAT(ended.out, HasSubstr("2 cases: 2 slower"));
  Arguments limited = duelOf(call);
  limited.insert(limited.end(), {"--fail-above", "50%"});
  EXPECT_EQ(run(limited).status, 3);
}

TEST_F(SuiteDuel, AWrongAnswerFailsEvenIfItIsNotNew) {
  const std::string plugin = places::faultyPlugin();
  const ProgramResult ended = run(duelOf({"--algorithm", "faulty-extra", "--plugin", plugin,
                                          "--baseline-plugin", plugin, "--junit", "d.xml"}));
  EXPECT_EQ(ended.status, 1) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("mismatch in both: frame "));
  EXPECT_THAT(readFile(file("d.xml")), HasSubstr("failures=\"2\""));
}

TEST_F(SuiteDuel, ACaseThatTheOtherBuildLacksIsAdded) {
  const Arguments both = {
      "--algorithm", "repeated-search,faulty", "--plugin",          places::quickPlugin(),
      "--plugin",    places::faultyPlugin(),   "--baseline-plugin", slow_};
  const ProgramResult ended = run(duelOf(both));
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("4 cases: 2 faster, 2 added"));
  EXPECT_THAT(ended.out, HasSubstr("faulty: not in A: "));
  const ProgramResult none = run(duelOf(
      {"--algorithm", "faulty", "--plugin", places::faultyPlugin(), "--baseline-plugin", slow_}));
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("A has none of the selected cases"));
}

TEST_F(SuiteDuel, AlsoTwoVariantsHaveALimit) {
  const Arguments call = {"duel",
                          "freefall",
                          "time-validator/phase_us=20",
                          "time-validator/phase_us=200",
                          "--objects",
                          "20",
                          "--frames",
                          "20",
                          "--fail-above",
                          "50%",
                          "--json",
                          "d.json",
                          "--markdown",
                          "d.md",
                          "--quiet"};
  const ProgramResult ended = run(call);
  EXPECT_EQ(ended.status, 3) << ended.err;
  EXPECT_EQ(readJson(file("d.json")).at("schema"), "broadmark-duel/1");
  EXPECT_THAT(readFile(file("d.md")), HasSubstr("**REGRESSED"));
}

TEST_F(SuiteDuel, AnInterruptKeepsWhatIsDecided) {
  // The second recording would take hours to simulate.
  Program program(directory_,
                  {"duel", "brownian", "--objects", "50", "--frames", "20,1000000", "--algorithm",
                   "time-validator", "--param", "phase_us=20,200", "--json", "d.json"});
  ASSERT_TRUE(program.waitForText("phase_us=200: slower"));
  program.signal(SIGINT);
  const ProgramResult ended = program.wait();
  EXPECT_EQ(ended.status, 130);
  EXPECT_THAT(ended.out, HasSubstr("1 case: 1 slower; interrupted, 1 duel not run"));
  EXPECT_THAT(ended.err, HasSubstr("broadmark: interrupted: 1 of 2 verdicts kept"));
  const Json comparison = readJson(file("d.json"));
  EXPECT_EQ(comparison.at("cases").size(), 1U);
  EXPECT_EQ(comparison.at("not_run"), 1);
}

TEST_F(SuiteDuel, BadRequestsAreRefused) {
  expectRefusal({"duel", "freefall"}, {"--baseline-program"});
  expectRefusal(duelOf({"--algorithm", "sap"}), {"at least two variants"});
  expectRefusal(duelOf({"--algorithm", "sapp"}), {"'sapp'", "'sap'"});
  expectRefusal({"duel", "freefall", "sap", "kd", "--threads", "2"}, {"--threads", "--algorithm"});
  expectRefusal({"duel", "freefall", "brownian", "--baseline-program", places::program()},
                {"'brownian' is a source", "--algorithm"});
  expectRefusal(duelOf({"--algorithm", "kd", "--isa", isaSupported(Isa::neon) ? "avx2" : "neon",
                        "--baseline-program", places::program()}),
                {"--isa", "not supported"});
  expectRefusal(duelOf({"--algorithm", "sap,kd", "--json", "-", "--csv", "-"}), {"already"});
  expectRefusal(duelOf({"--algorithm", "sap", "--baseline-program", "gone"}), {"gone"});
  expectRefusal(duelOf({"--algorithm", "sap", "--baseline-program", "/bin/false"}), {"/bin/false"});
  expectRefusal(duelOf({"--algorithm", "sap", "--baseline-plugin", quick_}), {"--plugin"});
  expectRefusal(duelOf({"--algorithm", "sap,kd", "--fail-above", "-3"}), {"--fail-above", "'-3'"});
  expectRefusal({"duel", "gone.aabbs", "--algorithm", "sap,kd"}, {"gone.aabbs"});
}

}  // namespace
}  // namespace broadmark::tests
