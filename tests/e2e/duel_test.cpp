// The command 'duel'.

#include "e2e/end_to_end.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

using ::testing::Contains;

class Duel : public EndToEnd {
 protected:
  /// A duel on a small scene.
  [[nodiscard]] Arguments duelOf(const Arguments& variants, const Arguments& more = {}) const {
    Arguments call = {"duel", "freefall"};
    call.insert(call.end(), variants.begin(), variants.end());
    for (const char* word : {"--objects", "50", "--frames", "30", "--quiet"}) call.push_back(word);
    call.insert(call.end(), more.begin(), more.end());
    return call;
  }
};

TEST_F(Duel, TellsTheFasterOne) {
  const ProgramResult ended =
      run(duelOf({"time-validator/phase_us=100", "time-validator/phase_us=200"},
                 {"--precision", "5%", "--json", "duel.json"}));
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("time-validator/phase_us=200 is"));
  const Json duel = readJson(file("duel.json"));
  EXPECT_EQ(duel.at("schema"), "broadmark-duel/1");
  EXPECT_EQ(duel.at("recording").at("objects"), 50);
  const Json& sides = duel.at("sides");
  ASSERT_EQ(sides.size(), 2U);
  EXPECT_EQ(sides[0].at("seconds").size(), sides[1].at("seconds").size());
  const Json& ranking = duel.at("ranking");
  EXPECT_EQ(ranking[0].at("name"), "time-validator/phase_us=100");
  EXPECT_EQ(ranking[1].at("place"), 2);
  EXPECT_NEAR(ranking[1].at("ratio").get<double>(), 2, 0.3);
}

TEST_F(Duel, RanksMoreThanTwo) {
  const ProgramResult ended =
      run(duelOf({"bf", "sap-simd/scalar", "kd"}, {"--max-seconds", "0.5"}));
  EXPECT_EQ(ended.status, 0) << ended.err;
  for (const char* word : {"bf", "sap-simd/scalar", "kd", "1."}) {
    EXPECT_THAT(ended.out, HasSubstr(word));
  }
}

TEST_F(Duel, OfPairsAndEvents) {
  const ProgramResult ended =
      run(duelOf({"kd", "kd/events", "tracy/events"}, {"--max-seconds", "0.5"}));
  EXPECT_EQ(ended.status, 0) << ended.err;
  for (const char* word : {"kd/events", "tracy/events"}) EXPECT_THAT(ended.out, HasSubstr(word));
  EXPECT_EQ(run(duelOf({"bf", "sap"}, {"--max-seconds", "0.2", "--answer", "events"})).status, 0);
}

TEST_F(Duel, ItsJsonMayGoToStandardOutputAndNothingElseThen) {
  const ProgramResult ended = run(duelOf({"bf", "sap"}, {"--max-seconds", "0.5", "--json", "-"}));
  EXPECT_EQ(ended.status, 0) << ended.err;
  const Json json = Json::parse(ended.out, nullptr, false);
  ASSERT_TRUE(json.is_object()) << ended.out;
  EXPECT_EQ(json.at("schema"), "broadmark-duel/1");
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(Duel, OfTwoBuildsOfAPlugIn) {
  fs::copy_file(places::faultyPlugin(), file("old.so"));
  fs::copy_file(places::faultyPlugin(), file("new.so"));
  const ProgramResult ended =
      run(duelOf({"old.so:faulty", "new.so:faulty"}, {"--max-seconds", "0.5"}));
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("old.so:faulty"));
}

TEST_F(Duel, OfTwoPrograms) {
  const ProgramResult ended =
      run(duelOf({"sap"}, {"--max-seconds", "0.5", "--baseline-program", places::program()}));
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("sap (" + std::string(places::program()) + ")"));
}

TEST_F(Duel, TakesOptionsAndParametersByFormerNames) {
  const ProgramResult ended = run(duelOf({"columns/crowded=7", "sap"}, {"--seconds", "0.1"}));
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("'--seconds' is now called '--max-seconds'"));
  EXPECT_THAT(ended.err, HasSubstr("'crowded' is now called 'split_threshold'"));
}

TEST_F(Duel, WarnsOfWhatDisturbsTimesAndPins) {
  const ProgramResult ended = run(duelOf({"sap", "bf-mt/t500"}, {"--max-seconds", "0.1", "--pin"}));
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.warnings, Contains(HasSubstr("500 threads share")));
}

TEST_F(Duel, AWrongAnswerEndsIt) {
  const std::string plugin = places::faultyPlugin();
  const ProgramResult ended = run(duelOf({"sap", plugin + ":faulty-extra"}));
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.out, HasSubstr("mismatch"));
}

TEST_F(Duel, BadVariantsAreRefused) {
  expectRefusal(duelOf({"sap"}), {"duel", "another"});
  expectRefusal(duelOf({"sap", "sapp"}), {"'sapp'", "'sap'"});
  expectRefusal(duelOf({"sap", "kd-mt/t0"}), {"--threads", "'0'"});
  expectRefusal(duelOf({"sap", "sap/avx2"}), {"'sap/avx2'", "'avx2'", "KEY=VALUE"});
  expectRefusal(duelOf({"sap", "kd-mt/avx3"}), {"'avx3'", "avx2", "t4"});
  expectRefusal(duelOf({"sap", "kd/lefs=3"}), {"lefs"});
  expectRefusal(duelOf({"sap", "gone.so:x"}), {"gone.so"});
  expectRefusal(duelOf({"sap", "kd"}, {"--precision", "0"}), {"--precision"});
  expectRefusal(duelOf({"sap", "kd"}, {"--param", "densty=1"}), {"'densty'", "'density'"});
  expectRefusal(duelOf({"sap"}, {"--baseline-program", "gone"}), {"gone"});
  expectRefusal({"duel", "gone.aabbs", "sap", "kd"}, {"gone.aabbs"});
}

}  // namespace
}  // namespace broadmark::tests
