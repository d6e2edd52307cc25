// The runner, with broad phases that are wrong, slow or fail on purpose: statuses, reasons and
// stored results.

#include "broadmark/harness/runner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>

#include "engine/spoilt_cases.h"
#include "support/changing_worlds.h"

namespace broadmark::tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(Runner, ARightAnswerIsOk) {
  for (const CheckMode check : {CheckMode::full, CheckMode::hash, CheckMode::off}) {
    const CaseResult result = runOnChain(caseOf(), {.check = check}, 3);
    EXPECT_EQ(result.status, Status::ok);
    EXPECT_EQ(result.reason, "");
    EXPECT_EQ(result.checked, check != CheckMode::off);
    EXPECT_EQ(result.missed_count + result.false_count + result.allowed_extra_count +
                  result.invalid_count,
              0U);
    EXPECT_EQ(result.pairs_mean, 3);
    EXPECT_EQ(result.pairs_max, 3U);
    ASSERT_EQ(result.repetitions.size(), 3U);
    for (const Repetition& repetition : result.repetitions) {
      EXPECT_EQ(repetition.frames.size(), kChainFrames);
    }
  }
}

/// A fault in a single frame, and the expected report.
struct Fault {
  const char* name;
  std::function<void(std::vector<Pair>&)> spoil;
  std::uint64_t missed, extra, invalid;
  std::function<std::vector<Pair>(const FrameDifference&)> listed;
  Pair pair;
};

class FaultyAnswer : public testing::TestWithParam<CheckMode> {};

TEST_P(FaultyAnswer, IsAMismatchWithTheFrameAndThePair) {
  const auto missed = [](const FrameDifference& d) { return d.missed_pairs; };
  const auto extra = [](const FrameDifference& d) { return d.false_pairs; };
  const auto invalid = [](const FrameDifference& d) { return d.invalid_pairs; };
  const Fault faults[] = {
      {"misses", [](auto& a) { std::erase(a, Pair{1, 2}); }, 1, 0, 0, missed, {1, 2}},
      {"false", [](auto& a) { a.push_back({0, 3}); }, 0, 1, 0, extra, {0, 3}},
      {"duplicate", [](auto& a) { a.push_back({0, 1}); }, 0, 0, 1, invalid, {0, 1}},
      {"self", [](auto& a) { a.push_back({2, 2}); }, 0, 0, 1, invalid, {2, 2}},
      {"out of range", [](auto& a) { a.push_back({2, 4}); }, 0, 0, 1, invalid, {2, 4}},
      {"replaced", [](auto& a) { a[0] = a[1]; }, 1, 0, 1, missed, {0, 1}}};
  for (const Fault& fault : faults) {
    SCOPED_TRACE(fault.name);
    const CaseResult result = runOnChain(spoilingAnswer(fault.spoil), {.check = GetParam()});
    EXPECT_EQ(result.status, Status::mismatch);
    EXPECT_THAT(result.reason, HasSubstr("frame 3"));
    EXPECT_THAT(result.reason, HasSubstr(mismatchText(result.differences.at(0))));
    EXPECT_EQ(result.missed_count, fault.missed);
    EXPECT_EQ(result.false_count, fault.extra);
    EXPECT_EQ(result.invalid_count, fault.invalid);
    ASSERT_EQ(result.differences.size(), 1U);
    EXPECT_EQ(result.differences[0].frame, kFaultyFrame);
    EXPECT_EQ(result.differences[0].repetition, 1);
    EXPECT_THAT(fault.listed(result.differences[0]), ElementsAre(fault.pair));
    EXPECT_EQ(result.repetitions.at(0).frames.size(), kChainFrames)
        << "times are stored, with the status";
  }
}

INSTANTIATE_TEST_SUITE_P(Modes, FaultyAnswer, testing::Values(CheckMode::full, CheckMode::hash));

TEST(Runner, UncheckedFaultsAreNotClaimedToBeRight) {
  const Case wrong = spoilingAnswer([](auto& answer) { answer.clear(); });
  const CaseResult unchecked = runOnChain(wrong, {.check = CheckMode::off});
  EXPECT_EQ(unchecked.status, Status::ok);
  EXPECT_FALSE(unchecked.checked);

  Case self_check = wrong;
  self_check.algorithm.traits.finds_pairs = false;
  EXPECT_FALSE(runOnChain(self_check).checked);
}

TEST(Runner, EveryWrongFrameIsListedAndTheFirstIsTheReason) {
  const Case wrong = caseOf({.on_answer = [](std::uint32_t, auto& answer) { answer.clear(); }});
  const CaseResult result = runOnChain(wrong);
  EXPECT_EQ(result.missed_count, 3U * kChainFrames);
  ASSERT_EQ(result.differences.size(), kChainFrames);
  for (std::uint32_t i = 0; i < kChainFrames; ++i) EXPECT_EQ(result.differences[i].frame, i + 1);
  EXPECT_THAT(result.reason, StartsWith("frame 1: 3 missed"));
}

TEST(Runner, ACancelledRepetitionIsDropped) {
  ChainSource source;
  Oracle oracle;
  CaseRun case_run(caseOf());
  CaseResult result = beginCase(case_run.description(), {.scene = source.scene()});
  ASSERT_TRUE(runRepetition(result, case_run, source, oracle));

  int asked = 0;
  const RunHooks hooks = {.cancelled = [&] { return ++asked > 2; }, .progress = {}};
  EXPECT_FALSE(runRepetition(result, case_run, source, oracle, hooks));
  EXPECT_EQ(asked, 3);
  EXPECT_EQ(result.repetitions.size(), 1U);
  EXPECT_EQ(result.status, Status::ok);
}

TEST(Runner, AWarmUpIsCheckedButNotRecorded) {
  ChainSource source;
  Oracle oracle;
  CaseRun case_run(caseOf());
  CaseResult result = beginCase(case_run.description(), {.scene = source.scene()});
  EXPECT_TRUE(runRepetition(result, case_run, source, oracle, {}, false));
  EXPECT_TRUE(result.repetitions.empty());
  EXPECT_TRUE(runRepetition(result, case_run, source, oracle, {}));
  EXPECT_EQ(result.repetitions.size(), 1U);
  EXPECT_EQ(result.pairs_mean, 3);

  CaseRun wrong(spoilingAnswer([](auto& answer) { answer.clear(); }));
  CaseResult spoilt = beginCase(wrong.description(), {.scene = source.scene()});
  runRepetition(spoilt, wrong, source, oracle, {}, false);
  EXPECT_EQ(spoilt.status, Status::mismatch);
  EXPECT_TRUE(spoilt.repetitions.empty());
}

TEST(Runner, WrongPairsOfAFrameCountOnceHoweverOftenItIsRun) {
  ChainSource source;
  Oracle oracle;
  CaseRun wrong(spoilingAnswer([](auto& answer) { answer.pop_back(); }));
  CaseResult result = beginCase(wrong.description(), {.scene = source.scene()});
  for (int pass = 0; pass < 3; ++pass) runRepetition(result, wrong, source, oracle);
  ASSERT_EQ(result.frames.size(), kChainFrames);
  std::uint64_t missed = 0;
  for (const FrameCounts& counts : result.frames) missed += counts[FrameCount::missed];
  EXPECT_GT(missed, 0U);
  EXPECT_EQ(result.missed_count, missed);
  EXPECT_LE(missed, kChainFrames);
}

/// Two separate bodies: body 0 moves in every frame but the last, body 1 in frame 2 only.
class TwoBodies final : public IndexedFrames {
 public:
  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }

 private:
  static Aabb boxAt(float x) { return {{x, 0, 0, 0}, {x + 1, 1, 1, 0}}; }
  std::span<const Aabb> readBoxes(std::uint32_t index) override {
    boxes_ = {boxAt(static_cast<float>(std::min(index, 2U))), boxAt(index < 2 ? 10.0F : 11.0F)};
    return boxes_;
  }

  SceneInfo scene_{"Two", "Cubes", 2, 3, {{0, 0, 0, 0}, {100, 100, 100, 0}}};
  std::vector<Aabb> boxes_;
};

TEST(Runner, BodiesThatMoveAreCounted) {
  TwoBodies frames;
  const CaseResult result = runCase(caseOf({.on_answer = [](auto, auto& answer) { answer = {}; }}),
                                    frames, {.check = CheckMode::off});
  std::vector<std::uint64_t> changed;
  for (const FrameCounts& counts : result.frames) {
    changed.push_back(counts[FrameCount::changed_bodies]);
  }
  EXPECT_THAT(changed, ElementsAre(1, 2, 0));
}

TEST(Runner, BodiesThatArePresentAreCountedWhereSomeMayBeAbsent) {
  Behaviour silent{.on_answer = [](auto, auto& answer) { answer = {}; }};
  TwoBodies always;
  EXPECT_FALSE(runCase(caseOf(silent), always, {.check = CheckMode::off}).bodies);
  FrameList sometimes = changing(
      always, [](std::uint32_t body, std::uint32_t frame) { return body == 0 || frame > 1; });
  silent.traits.changing_worlds = ChangingWorlds::native;
  const CaseResult result = runCase(caseOf(silent), sometimes, {.check = CheckMode::off});
  ASSERT_TRUE(result.bodies) << result.reason;
  EXPECT_DOUBLE_EQ(result.bodies->mean, 5 / 3.0);
  EXPECT_EQ(result.bodies->max, 2U);
}

TEST(Runner, FramesComeInOrderAndEveryRepetitionIsAFreshInstance) {
  std::vector<std::uint32_t> frames;
  int initialised = 0;
  CaseRun case_run(caseOf({.on_initialize = [&] { ++initialised; },
                           .on_update = [&](std::uint32_t frame) { frames.push_back(frame); }}));
  std::vector<std::uint32_t> reported;
  const RunHooks hooks = {.cancelled = {},
                          .progress = [&](std::uint32_t frame) { reported.push_back(frame); }};
  ChainSource source;
  Oracle oracle;
  CaseResult result = beginCase(case_run.description(), {.scene = source.scene()});
  for (int pass = 0; pass < 2; ++pass) runRepetition(result, case_run, source, oracle, hooks);
  EXPECT_EQ(initialised, 2);
  EXPECT_EQ(frames, (std::vector<std::uint32_t>{1, 2, 3, 4, 5, 6, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(reported, frames);
}

TEST(Runner, NothingButTheAlgorithmIsTimed) {
  using Clock = std::chrono::steady_clock;
  std::vector<Clock::time_point> asked;     // end of the last cancel query before a frame
  std::vector<Clock::time_point> reported;  // progress report after a frame
  const RunHooks hooks = {.cancelled =
                              [&] {
                                asked.resize(reported.size() + 1);
                                asked.back() = Clock::now();
                                return false;
                              },
                          .progress = [&](std::uint32_t) { reported.push_back(Clock::now()); }};
  ChainSource source;
  Oracle oracle;
  CaseRun case_run(caseOf());
  CaseResult result = beginCase(case_run.description(), {.scene = source.scene()});
  runRepetition(result, case_run, source, oracle, hooks);
  ASSERT_EQ(reported.size(), kChainFrames);
  for (std::size_t frame = 0; frame < reported.size(); ++frame) {
    const std::int64_t total = result.repetitions.at(0).frames.at(frame)[Phase::total];
    EXPECT_LE(std::chrono::nanoseconds(total), reported[frame] - asked[frame]);
  }
}

TEST(Runner, WhatIsCountedOnceIsNoFrameCounter) {
  const CaseResult result = runOnChain(caseOf(), {}, 2);
  EXPECT_EQ(result.setup, (std::map<std::string, std::uint64_t>{{"tables", 5}}));
  EXPECT_TRUE(result.counters.empty());
}

TEST(Runner, AgeingIsCountedInTheFirstAndTheLastTenth) {
  const Case test_case = caseOf({.count_work = [](std::uint32_t frame) { return frame; }});
  for (const std::uint32_t frames : {99U, 109U}) {
    ChainSource source(4, frames);
    const CaseResult result = runCase(test_case, source, {}, 2);
    ASSERT_EQ(result.ageing.has_value(), frames == 109);
    if (!result.ageing) continue;
    EXPECT_EQ(result.ageing->early, (std::map<std::string, double>{{"work", 5.5}}));
    EXPECT_EQ(result.ageing->late, (std::map<std::string, double>{{"work", 104.5}}));
  }
}

TEST(Runner, SceneWithoutFramesOrBodies) {
  for (const auto& [objects, frames] :
       std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0, 3}, {3, 0}, {0, 0}}) {
    ChainSource source(objects, frames);
    const CaseResult result = runCase(caseOf(), source);
    EXPECT_EQ(result.status, Status::ok);
    EXPECT_EQ(result.repetitions.at(0).frames.size(), frames);
  }
}

TEST(Runner, CaseNamesAndIds) {
  Case test_case = caseOf();
  test_case.threads = 4;
  test_case.isa = Isa::avx2;
  EXPECT_EQ(caseName(test_case), "spoilt");
  test_case.algorithm.traits.vectorised = true;
  test_case.algorithm.traits.parallel = true;
  test_case.parameters = {{"cells", "3"}};
  EXPECT_EQ(caseName(test_case), "spoilt/avx2/t4/cells=3");
  RecordingReference recording = {.scene = ChainSource().scene()};
  EXPECT_EQ(caseId(recording, test_case), "Chain/Cubes/N4/F6/spoilt/avx2/t4/cells=3");
  recording.seed = 7;
  EXPECT_EQ(caseId(recording, test_case), "Chain/Cubes/N4/F6/s7/spoilt/avx2/t4/cells=3");

  const CaseResult result = beginCase(test_case, recording);
  EXPECT_EQ(result.id, caseId(recording, test_case));
  EXPECT_EQ(result.threads, 4);
  EXPECT_EQ(result.isa, Isa::avx2);
  EXPECT_EQ(result.parameters, (ParameterValues{{"cells", "3"}}));
  test_case.parameters.clear();
  EXPECT_EQ(beginCase(test_case, recording).parameters, (ParameterValues{{"cells", "2"}}))
      << "defaults included";
}

}  // namespace
}  // namespace broadmark::tests
