// Files that an earlier version wrote, with former names of parameters (tests/data/former), are
// read as at that time.

#include "e2e/end_to_end.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

class FormerFiles : public EndToEnd {
 protected:
  FormerFiles() {
    fs::copy(places::source("tests/data/former"), directory_, fs::copy_options::recursive);
  }
};

TEST_F(FormerFiles, RecordingsAreVerified) {
  const ProgramResult ended =
      run({"verify", "fountain.broadmark", "freefall.aabbs", "poses.posrot"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(linesOf(ended.out).size(), 3U) << ended.out;
}

TEST_F(FormerFiles, ACaseRunsAgainAndIsComparedWithItsFormerResult) {
  const std::string id = "Fountain/Cubes/N4/F3/columns/scalar/crowded=7";
  runQuietly({"--headless", "results.json", "--case", id, "--check", "full", "--json", "now.json"});
  const Json now = readJson(file("now.json")).at("cases").at(0);
  EXPECT_EQ(now.at("params").at("split_threshold"), "7");
  EXPECT_EQ(now.at("status"), "ok");
  const ProgramResult compared = run({"compare", "results.json", "now.json"});
  EXPECT_THAT(compared.out, AllOf(Not(HasSubstr("added")), HasSubstr("3 missing"))) << compared.err;
}

TEST_F(FormerFiles, SceneParametersAreSimulated) {
  runQuietly({"--headless", "freefall.json", "--algorithm", "sap", "--json", "now.json"});
  EXPECT_EQ(readJson(file("now.json")).at("cases").at(0).at("status"), "ok");
}

TEST_F(FormerFiles, FormerNamesAreNotedOnce) {
  const ProgramResult ended =
      run({"--headless", "freefall.json", "--algorithm", "tide,columns", "--repetitions", "auto",
           "--most-seconds=60", "--param", "tide:from_scratch_cost=50", "--param", "crowded=7"});
  EXPECT_EQ(ended.status, 0);
  for (const char* note : {"'--most-seconds' is now called '--max-seconds'\n",
                           "'from_scratch_cost' is now called 'full_search_cost_scale'\n",
                           "'crowded' is now called 'split_threshold'\n"}) {
    const std::size_t first = ended.err.find(note);
    ASSERT_NE(first, std::string::npos) << note << ended.err;
    EXPECT_EQ(ended.err.find(note, first + 1), std::string::npos) << note;
  }
}

}  // namespace
}  // namespace broadmark::tests
