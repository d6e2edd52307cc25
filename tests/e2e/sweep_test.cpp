// Parameter sweeps: a recording or a case for each combination.

#include "e2e/end_to_end.h"

namespace broadmark::tests {
namespace {

using Sweep = EndToEnd;

const Arguments kSmall = {"--headless", "brownian", "--objects", "30", "--frames", "3"};

Arguments with(Arguments call, const Arguments& more) {
  call.insert(call.end(), more.begin(), more.end());
  return call;
}

TEST_F(Sweep, OfAnAlgorithmsParameter) {
  const Arguments call = with(kSmall, {"--algorithm", "kd,sap", "--isa", "scalar", "--param",
                                       "objects_per_leaf=256,9", "--json", "results.json"});
  const ProgramResult ended = runQuietly(call);
  // The table distinguishes the rows of an algorithm.
  for (const char* word : {"objects_per_leaf=9 ", "objects_per_leaf=256 ", "parameters"}) {
    EXPECT_THAT(ended.out, HasSubstr(word));
  }
  const Json cases = readJson(file("results.json")).at("cases");
  ASSERT_EQ(cases.size(), 3U);
  const ProgramResult listed = run(with(call, {"--list"}));
  const std::vector<std::string> ids = linesOf(listed.out);
  ASSERT_EQ(ids.size(), 3U);
  for (std::size_t i = 0; i < ids.size(); ++i) EXPECT_EQ(cases[i].at("id"), ids[i]);
  EXPECT_THAT(ids[0], HasSubstr("/objects_per_leaf=9"));
  EXPECT_THAT(ids[1], HasSubstr("/objects_per_leaf=256"));
  // Each case can be reopened.
  EXPECT_EQ(run({"--headless", "results.json", "--case", ids[1], "--quiet"}).status, 0);
}

TEST_F(Sweep, OfAScenesParameters) {
  const Arguments call = with(kSmall, {"--algorithm", "sap", "--seed", "2,1", "--param",
                                       "density=0.1,0.05", "--record", "out", "--json", "r.json"});
  const ProgramResult ended = runQuietly(call);
  const Json cases = readJson(file("r.json")).at("cases");
  ASSERT_EQ(cases.size(), 4U);
  std::set<std::string> hashes;
  std::set<std::string> ids;
  for (const Json& result : cases) {
    hashes.insert(result.at("recording").at("hash"));
    ids.insert(result.at("id"));
  }
  EXPECT_EQ(hashes.size(), 4U);
  EXPECT_EQ(ids.size(), 4U);
  EXPECT_THAT(ended.out, HasSubstr("density=0.05, seed=2"));
  EXPECT_TRUE(
      fs::exists(file(recordingIn("out", "Brownian Cubes N30 F3frames density=0.05 seed=2"))));
  // A bake creates the same recordings with the same names.
  const ProgramResult baked =
      runQuietly({"bake", "--scenes", "brownian", "--objects", "30", "--frames", "3", "--seed",
                  "1,2", "--density", "0.05,0.1", "--output", "out"});
  EXPECT_THAT(linesOf(baked.out).back(), StartsWith("0 baked, 4 kept"));
  // The id of a simulated case is the same in a rerun.
  runQuietly(with(kSmall, {"--algorithm", "sap", "--density", "0.1,0.05", "--json", "s.json"}));
  const std::string id = readJson(file("s.json")).at("cases").at(1).at("id");
  EXPECT_THAT(id, HasSubstr("/density=0.1/sap"));
  runQuietly({"--headless", "s.json", "--case", id, "--json", "again.json"});
  EXPECT_EQ(readJson(file("again.json")).at("cases").at(0).at("id"), id);
}

TEST_F(Sweep, ShardsDivideItsCases) {
  const Arguments call = with(kSmall, {"--algorithm", "kd", "--isa", "scalar", "--seed", "1,2,3",
                                       "--param", "kd:objects_per_leaf=9,20", "--list"});
  std::set<std::string> ids;
  for (const char* shard : {"0/2", "1/2"}) {
    const auto part = linesOf(run(with(call, {"--shard", shard})).out);
    EXPECT_EQ(part.size(), 3U);
    ids.insert(part.begin(), part.end());
  }
  EXPECT_EQ(ids.size(), 6U);
}

TEST_F(Sweep, OneBadValueIsNamed) {
  expectRefusal(with(kSmall, {"--param", "objects_per_leaf=9,x"}), {"objects_per_leaf", "'x'"});
  expectRefusal(with(kSmall, {"--seed", "1,x"}), {"seed", "'x'"});
  expectRefusal(with(kSmall, {"--engine", "kinematic,bulet"}), {"'bulet'", "'bullet'"});
  expectRefusal(with(kSmall, {"--param", "kdd:margin=1"}), {"--param", "'kdd'"});
  expectRefusal({"duel", "brownian", "--seed", "1,2", "sap", "kd"}, {"2 recordings"});
}

}  // namespace
}  // namespace broadmark::tests
