// From options to cases: all cases, filtered cases, shards, and plans for the inspector.

#include "run/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "app/session_files.h"
#include "broadmark/files.h"
#include "broadmark/results/results.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using Names = std::vector<std::string>;

/// A run on two scenes in two sizes each.
RunRequest request() {
  RunRequest options;
  options.sources = {"freefall", "brownian"};
  options.scene.objects = {10, 20};
  options.scene.parameters = {{"frames", "3"}};
  options.cases = {.algorithms = {"bf*", "sap"}, .threads = {1, 2}, .isas = {Isa::scalar}};
  return options;
}

/// A request of the inspector, on one scene.
RunRequest inspection() {
  RunRequest inspecting = request();
  inspecting.sources = {"freefall"};
  inspecting.scene.objects = {10};
  return inspecting;
}

Plan planOf(const RunRequest& asked) { return makePlan(asked, PlanUse::run); }

std::string complaint(const RunRequest& asked, PlanUse use = PlanUse::run) {
  return inputErrorOf([&] { makePlan(asked, use); });
}

TEST(Plan, HasEveryCaseOnEverySource) {
  const Plan plan = planOf(request());
  ASSERT_THAT(plan.entries, SizeIs(4));
  for (const PlanEntry& entry : plan.entries) EXPECT_THAT(entry.cases, SizeIs(7));
  const Names ids = caseIds(plan);
  EXPECT_THAT(ids, SizeIs(28));
  EXPECT_THAT(std::set(ids.begin(), ids.end()), SizeIs(28));
  EXPECT_THAT(ids.front(), HasSubstr("FreeFall/Cubes/N10/F3"));
  EXPECT_THAT(ids.back(), HasSubstr("Brownian/Cubes/N20/F3"));
  EXPECT_THAT(plan.cases, IsEmpty());
}

TEST(Plan, ShardsDivideTheCases) {
  const Names whole = caseIds(planOf(request()));
  for (const int count : {1, 3, 28, 40}) {
    Names divided;
    for (int index = 0; index < count; ++index) {
      RunRequest part = request();
      part.shard = {.index = index, .count = count};
      const Plan plan = planOf(part);
      const Names ids = caseIds(plan);
      EXPECT_LE(ids.size(), whole.size() / static_cast<std::size_t>(count) + 1);
      for (const PlanEntry& entry : plan.entries) EXPECT_THAT(entry.cases, Not(IsEmpty()));
      divided.insert(divided.end(), ids.begin(), ids.end());
    }
    EXPECT_THAT(divided, testing::UnorderedElementsAreArray(whole)) << count;
  }
}

TEST(Plan, FilterKeepsMatchingCases) {
  RunRequest filtered = request();
  filtered.filter = "N20/.*/bf$";
  const Names ids = caseIds(planOf(filtered));
  EXPECT_THAT(ids, SizeIs(2));
  EXPECT_THAT(ids, Each(AllOf(HasSubstr("N20"), testing::EndsWith("/bf"))));
  filtered.filter = "matches nothing";
  EXPECT_THAT(planOf(filtered).entries, IsEmpty());
  filtered.filter = "([";
  EXPECT_THAT(complaint(filtered), AllOf(HasSubstr("--filter"), HasSubstr("'(['")));
}

TEST(Plan, ShardsDivideWhatTheFilterLeaves) {
  Names divided;
  for (int index = 0; index < 2; ++index) {
    RunRequest part = request();
    part.filter = "/sap$";
    part.shard = {.index = index, .count = 2};
    const Names ids = caseIds(planOf(part));
    EXPECT_THAT(ids, SizeIs(2));
    divided.insert(divided.end(), ids.begin(), ids.end());
  }
  EXPECT_THAT(std::set(divided.begin(), divided.end()), SizeIs(4));
}

TEST(Plan, ParametersMustBeSomebodys) {
  RunRequest asked = request();
  asked.cases.algorithms = {"kd"};
  asked.parameters = {{"objects_per_leaf", "9"}, {"density", "0.05"}};
  EXPECT_THAT(planOf(asked).entries.front().cases.front().parameters, SizeIs(1));
  asked.parameters["densty"] = "0.1";
  EXPECT_THAT(complaint(asked),
              AllOf(HasSubstr("--param"), HasSubstr("'densty'"), HasSubstr("'density'")));
}

TEST(Plan, ParametersOfOneAlgorithmMustBeItsOwn) {
  RunRequest asked = request();
  asked.cases.algorithms = {"kd", "sap"};
  asked.parameters = {{"kd:objects_per_leaf", "9"}};
  EXPECT_THAT(caseIds(planOf(asked)).at(0), HasSubstr("objects_per_leaf=9"));
  const auto refused = [&](const std::string& key, const Names& words) {
    asked.parameters = {{key, "1"}};
    for (const std::string& word : words) EXPECT_THAT(complaint(asked), HasSubstr(word));
  };
  refused("kdd:objects_per_leaf", {"--param", "'kdd'", "'kd'"});
  refused("kd:objects_per_lef", {"--param", "'objects_per_lef'", "'objects_per_leaf'"});
  refused("kd:density", {"--param", "'density'"});
  refused("tracy:objects_per_cell", {"--param", "'tracy:objects_per_cell'", "no selected case"});
}

TEST(Plan, EveryValueOfAParameterMakesARecordingOrACase) {
  RunRequest asked = request();
  asked.sources = {"freefall"};
  asked.scene.objects = {10};
  asked.scene.parameters = {{"frames", "3"}, {"seed", "2,1"}};
  asked.cases.algorithms = {"kd"};
  asked.parameters = {{"density", "0.05,0.1"}, {"objects_per_leaf", "9,20"}};
  const Plan plan = planOf(asked);
  ASSERT_THAT(plan.entries, SizeIs(4));
  EXPECT_THAT(
      caseIds(plan),
      testing::ElementsAre(HasSubstr("/s1/density=0.05/kd/scalar/objects_per_leaf=9"),
                           HasSubstr("/s1/density=0.05/kd/scalar/objects_per_leaf=20"),
                           HasSubstr("/s2/density=0.05/kd/"), HasSubstr("/s2/density=0.05/kd/"),
                           HasSubstr("/s1/density=0.1/kd/"), HasSubstr("/s1/density=0.1/kd/"),
                           HasSubstr("/s2/density=0.1/kd/"), HasSubstr("/s2/density=0.1/kd/")));
  EXPECT_EQ(plan.entries.back().source.reference.seed, 2U);

  asked.parameters = {{"frames", "3"}};
  EXPECT_THAT(complaint(asked), AllOf(HasSubstr("'frames'"), HasSubstr("twice")));
  asked.parameters = {{"density", "0.1,7"}};
  EXPECT_THAT(complaint(asked), AllOf(HasSubstr("density"), HasSubstr("'7'")));
}

TEST(Plan, ParametersOfEveryCaseAreChecked) {
  RunRequest asked = request();
  asked.cases.algorithms = {"sap", "kd"};
  asked.filter = "/sap$";
  asked.parameters = {{"objects_per_leaf", "none"}};
  EXPECT_THAT(complaint(asked), AllOf(HasSubstr("objects_per_leaf"), HasSubstr("'none'")));
  asked.parameters = {{"density", "7"}};
  EXPECT_THAT(complaint(asked), AllOf(HasSubstr("density"), HasSubstr("'7'")));
}

TEST(Plan, DeviceAndAnswerAreThoseOfEveryCase) {
  RunRequest asked = request();
  asked.cases.device = "0";
  asked.cases.answer = AnswerKind::events;
  for (const PlanEntry& entry : planOf(asked).entries) {
    for (const Case& test_case : entry.cases) {
      EXPECT_EQ(test_case.device, "0");
      EXPECT_EQ(test_case.answer, AnswerKind::events);
    }
  }
}

TEST(Plan, ScreenshotsHaveNamesOfTheirOwn) {
  RunRequest asked = request();
  asked.screenshot = "p.png";
  std::set<std::filesystem::path> names;
  for (const PlanEntry& entry : planOf(asked).entries) names.insert(entry.screenshot);
  EXPECT_THAT(names, SizeIs(4));
  EXPECT_TRUE(names.contains("p Brownian Cubes N20.png"));
  asked.sources = {"freefall"};
  asked.scene.objects = {10};
  EXPECT_EQ(planOf(asked).entries.front().screenshot, "p.png");
  EXPECT_EQ(planOf(request()).entries.front().screenshot, "");
}

TEST(Plan, TheInspectorBeginsWithTheNamedAlgorithmsOnly) {
  RunRequest asked = inspection();
  EXPECT_THAT(makePlan(asked, PlanUse::open).entries.at(0).cases, SizeIs(7));
  asked.cases.algorithms.clear();
  const Plan without = makePlan(asked, PlanUse::open);
  ASSERT_THAT(without.entries, SizeIs(1)) << "kept, although it has no cases";
  EXPECT_THAT(without.entries.front().cases, IsEmpty());
  EXPECT_GT(without.algorithms.size(), 20U);
}

TEST(Plan, TheFrameToBeShownMustExist) {
  for (const PlanUse use : {PlanUse::run, PlanUse::open}) {
    RunRequest asked = request();
    asked.frame = 3;
    makePlan(asked, use);
    asked.frame = 4;
    EXPECT_THAT(complaint(asked, use), AllOf(HasSubstr("--frame"), HasSubstr("4")));
  }
  RunRequest without = inspection();
  without.sources.clear();
  without.frame = 0;
  EXPECT_THAT(complaint(without, PlanUse::open), HasSubstr("--frame"));
}

TEST(Plan, TheInspectorNeedsNoSource) {
  RunRequest asked = inspection();
  asked.sources.clear();
  const Plan plan = makePlan(asked, PlanUse::open);
  EXPECT_THAT(plan.entries, IsEmpty());
  EXPECT_THAT(plan.cases, SizeIs(7));
}

class PlanOfResults : public testing::Test {
 protected:
  PlanOfResults() {
    writeRecording(directory_ / "small.aabbs");
    wrong_ = resultOn(directory_ / "small.aabbs", "sap", 1);
    writeResults(directory_ / "results.json", {resultOn(directory_ / "small.aabbs", "bf"), wrong_});
    asked_.sources = {(directory_ / "results.json").string()};
  }

  TemporaryDirectory directory_;
  CaseResult wrong_;
  RunRequest asked_;
};

TEST_F(PlanOfResults, HasTheChosenCase) {
  asked_.case_id = wrong_.id;
  const Plan plan = planOf(asked_);
  EXPECT_THAT(caseIds(plan), testing::ElementsAre(wrong_.id));
  ASSERT_TRUE(plan.entries.front().known);
}

TEST_F(PlanOfResults, MayBeOfLines) {
  const std::string text = readTextFile(directory_ / "results.json");
  const Results results = parseResults(text, "results.json");
  for (const ResultWriter& writer : resultWriters()) {
    if (writer.name == "jsonl") {
      writeTextFile(directory_ / "results.jsonl", writer.format(results));
    }
  }
  asked_.sources = {(directory_ / "results.jsonl").string()};
  asked_.case_id = wrong_.id;
  EXPECT_THAT(caseIds(planOf(asked_)), testing::ElementsAre(wrong_.id));
}

TEST_F(PlanOfResults, NeedsAChosenCase) {
  EXPECT_THAT(complaint(asked_), AllOf(HasSubstr("results.json"), HasSubstr("--case"),
                                       HasSubstr("'" + wrong_.id + "'")));
}

TEST_F(PlanOfResults, InTheInspectorTheCaseIsChosenLater) {
  const Plan plan = makePlan(asked_, PlanUse::open);
  ASSERT_TRUE(plan.unchosen_case);
  EXPECT_EQ(plan.unchosen_case->file, asked_.sources.front());
  EXPECT_THAT(plan.entries, IsEmpty());
}

TEST_F(PlanOfResults, OtherSourcesHaveNoCasesToChoose) {
  asked_.case_id = wrong_.id;
  for (const std::string& other :
       {std::string("freefall"), (directory_ / "small.aabbs").string()}) {
    asked_.sources = {other};
    EXPECT_THAT(complaint(asked_), AllOf(HasSubstr("--case"), HasSubstr(other)));
  }
}

TEST_F(PlanOfResults, SettingsOfTheOriginalNameTheirAlgorithm) {
  writeTextFile(directory_ / "settings.json",
                originalSettingsText((directory_ / "small.aabbs").string()));
  asked_.sources = {(directory_ / "settings.json").string()};
  asked_.cases.device = "1";
  const Plan plan = planOf(asked_);
  ASSERT_THAT(plan.entries, SizeIs(1));
  EXPECT_THAT(plan.entries.front().cases, SizeIs(1));
  EXPECT_TRUE(plan.entries.front().original);
  asked_.cases.algorithms = {"sap"};
  EXPECT_THAT(complaint(asked_), HasSubstr("--algorithm"));
}

}  // namespace
}  // namespace broadmark::tests
