// Torture: rounds depend on their numbers only, worlds are of all kinds, and faults are found.

#include "broadmark/fuzz/torture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "algorithms/runs.h"
#include "support/faulty_algorithm.h"
#include "torture/random_world.h"
#include "torture/trial.h"

namespace broadmark::tests {
namespace {

TortureOptions optionsFor(std::vector<Algorithm> algorithms) {
  return {.algorithms = std::move(algorithms), .seed = 3};
}

TEST(TortureRound, FollowsFromItsNumber) {
  const TortureOptions options = optionsFor({algorithmOf("bf"), algorithmOf("kd-mt")});
  for (const std::uint64_t number : {0U, 1U, 77U}) {
    const TortureRound once = runTortureRound(options, number);
    const TortureRound again = runTortureRound(options, number);
    EXPECT_FALSE(once.finding);
    EXPECT_GT(once.coverage.size(), 5U);
    ASSERT_EQ(once.coverage.size(), again.coverage.size());
    auto other = again.coverage.begin();
    for (const auto& [key, count] : once.coverage) {
      EXPECT_EQ(key, other->first);
      EXPECT_EQ(count.frames, other->second.frames);
      ++other;
    }
  }
}

TEST(TortureRound, CoversAllKindsOfWorldsInAllWays) {
  const TortureOptions options = optionsFor({algorithmOf("sap-simd-mt")});
  std::set<std::string> worlds;
  std::set<std::pair<std::string, int>> variants;
  TortureCount sum;
  for (std::uint64_t number = 0; number < 60; ++number) {
    for (const auto& [key, count] : runTortureRound(options, number).coverage) {
      worlds.insert(key.world);
      variants.insert({key.isa + "/" + key.answer, key.threads});
      sum += count;
    }
  }
  const std::vector<std::string> all = tortureWorlds();
  EXPECT_EQ(worlds, std::set<std::string>(all.begin(), all.end()));
  EXPECT_GE(variants.size(), supportedIsas().size() * 2 * 3) << "of four numbers of threads";
  EXPECT_GT(sum.changing, sum.frames / 5);
  EXPECT_GT(sum.filtered, sum.frames / 5);
  EXPECT_LT(sum.changing, sum.frames / 2);
  EXPECT_GT(sum.filter_changes, sum.frames / 12);
}

TEST(TortureRound, FindsAndShrinksEachPlantedFault) {
  for (const Algorithm& algorithm : faulty::variants()) {
    if (algorithm.id == "faulty") continue;  // fails only occasionally
    SCOPED_TRACE(algorithm.id);
    const TortureOptions options = optionsFor({algorithm});
    std::optional<TortureFinding> finding;
    for (std::uint64_t number = 0; number < 20 && !finding; ++number) {
      finding = runTortureRound(options, number).finding;
    }
    ASSERT_TRUE(finding);
    EXPECT_EQ(finding->fault.kind, FaultKind::wrong_answer) << finding->fault.text;
    EXPECT_TRUE(finding->minimal);
    EXPECT_LE(finding->part.bodies.size(), 3U);
    EXPECT_LE(finding->part.frames.size(), 3U);
    EXPECT_EQ(finding->part.filter_changes.size(), algorithm.id == "stale-filter" ? 1U : 0U);
    // The shrunk part fails in its last frame.
    SubRecording part(*finding->frames, finding->part, "part");
    Trial trial(finding->test_case, options);
    const auto fault = trial.run(part);
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->kind, finding->fault.kind);
    EXPECT_EQ(fault->frame, part.scene().frames);
  }
}

TEST(TortureRound, FindsFaultsOfManyBodiesAndOfLateFrames) {
  for (const Algorithm& algorithm : faulty::rareVariants()) {
    SCOPED_TRACE(algorithm.id);
    const bool is_late = algorithm.id == "late-fault";
    TortureOptions options = optionsFor({algorithm});
    // It takes all of the bodies, and minutes.
    if (!is_late) options.is_news = [](const std::string&, FaultKind) { return false; };
    std::optional<TortureFinding> finding;
    for (std::uint64_t number = 0; number < 300 && !finding; ++number) {
      finding = runTortureRound(options, number).finding;
    }
    ASSERT_TRUE(finding);
    EXPECT_EQ(finding->fault.kind, FaultKind::wrong_answer);
    if (is_late) {
      EXPECT_EQ(finding->test_case.answer, AnswerKind::pairs);
      EXPECT_TRUE(finding->minimal);
      EXPECT_EQ(finding->part.bodies.size(), 2U);
      EXPECT_EQ(finding->part.frames.size(), 42U);
    } else {
      EXPECT_EQ(finding->frames->scene().objects, 70'000U);
    }
  }
}

/// Wrong only with one value of one parameter.
class Choosy final : public BoxBroadPhase {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({.name = "needed", .doc = "", .value = &needed_, .min = 0, .max = 10});
    visit({.name = "other", .doc = "", .value = &other_, .min = 0, .max = 10});
  }

 private:
  void findPairs() override {
    std::vector<Pair> answer = sweptPairs(boxes());
    if (needed_ == 7 && !answer.empty()) answer.pop_back();
    for (const Pair pair : answer) pairs().add(pair.a, pair.b);
  }

  std::int64_t needed_ = 0;
  std::int64_t other_ = 0;
};

TEST(TortureRound, SimplifiesSettingsThatTheFaultDoesNotNeed) {
  const Algorithm algorithm{.id = "choosy", .traits = {.parallel = true}, .create = [] {
                              return std::make_unique<Choosy>();
                            }};
  TortureOptions options = optionsFor({});
  options.only_case = makeCase(algorithm, Isa::scalar, 3, "", {{"needed", "7"}, {"other", "3"}},
                               AnswerKind::events);
  const TortureRound round = runTortureRound(options, 0);
  ASSERT_TRUE(round.finding);
  EXPECT_EQ(caseName(round.finding->test_case), "choosy/t1/needed=7");
  EXPECT_TRUE(round.finding->minimal);
  EXPECT_EQ(round.finding->part.bodies.size(), 2U);
}

TEST(TortureRound, ReportsASuspectedFaultThatDoesNotRecur) {
  const TortureOptions options = optionsFor({algorithmOf("bf")});
  const SuspectedFault suspected{{FaultKind::failure, 0, "crashed"}, 5};
  const TortureRound round = runTortureRound(options, 0, suspected);
  ASSERT_TRUE(round.finding);
  EXPECT_EQ(round.finding->fault.kind, FaultKind::nondeterministic);
  EXPECT_EQ(round.finding->fault.text, "crashed, but not when rerun");
  ASSERT_TRUE(round.finding->frames);
  EXPECT_EQ(round.coverage.size(), runTortureRound(options, 0).coverage.size());
}

TEST(TortureRound, DoesNotShrinkWhatIsNoNews) {
  TortureOptions options = optionsFor({faulty::variants().at(1)});
  options.is_news = [](const std::string&, FaultKind) { return false; };
  for (std::uint64_t number = 0; number < 20; ++number) {
    const TortureRound round = runTortureRound(options, number);
    if (!round.finding) continue;
    EXPECT_FALSE(round.finding->minimal);
    EXPECT_EQ(round.finding->part.bodies.size(), round.finding->frames->scene().objects);
    return;
  }
  FAIL() << "nothing found";
}

TEST(RandomWorlds, AreWhatRecordingsCanHold) {
  inputs::Random random(1, 1);
  std::set<std::string> names;
  for (int i = 0; i < 500; ++i) {
    const RandomWorld world = randomWorld(random, {});
    names.insert(world.name);
    const SceneInfo& scene = world.frames->scene();
    EXPECT_GE(scene.frames, 1U);
    for (std::uint32_t index = 0; index <= scene.frames; ++index) {
      for (const Aabb& box : world.frames->at(index).boxes) {
        EXPECT_TRUE(overlaps(box, box) || (box == kEmptyBox && !scene.all_present));
      }
    }
  }
  EXPECT_EQ(names.size(), tortureWorlds().size());
}

TEST(RandomWorlds, KeepTheirPairsInAnotherOrder) {
  inputs::Random random(1, 2);
  for (int i = 0; i < 100; ++i) {
    const RandomWorld world = randomWorld(random, {});
    const std::unique_ptr<IndexedFrames> other = shuffled(random, *world.frames);
    const std::uint32_t last = other->scene().frames;
    ASSERT_EQ(last, world.frames->scene().frames);
    const auto count = [last](IndexedFrames& frames) {
      const Frame frame = frames.at(last);
      return bruteForcePairs(frame.boxes, frame.filterIn(frames.scene())).size();
    };
    EXPECT_EQ(count(*other), count(*world.frames));
  }
}

TEST(RandomWorlds, ArePartsOfGivenRecordings) {
  TortureOptions options;
  options.only_given = true;
  options.given.push_back(
      {sceneOf({std::vector<Aabb>(3000, Aabb{{0, 0, 0, 0}, {1, 1, 1, 0}})}), {}});
  TortureRecording& given = options.given.front();
  given.scene.frames = 99;
  for (std::uint32_t frame = 0; frame < 100; ++frame) {
    given.frames.push_back(inputs::uniform(3000, frame, 1));
  }
  inputs::Random random(1, 3);
  for (int i = 0; i < 20; ++i) {
    const RandomWorld world = randomWorld(random, options);
    EXPECT_EQ(world.name, "given");
    EXPECT_EQ(world.frames->scene().objects, 1000U);
    EXPECT_EQ(world.frames->scene().frames, 30U);
  }
}

}  // namespace
}  // namespace broadmark::tests
