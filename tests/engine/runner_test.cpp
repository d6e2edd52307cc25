// The runner, with broad phases that are wrong or slow or fail on purpose: what it says of each,
// and what it keeps.

#include "broadmark/runner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <functional>
#include <numeric>
#include <thread>

#include "engine/helpers.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr std::uint32_t kFrames = 6;
constexpr std::uint32_t kFaultyFrame = 3;

void wait(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

/// `frames` frames of a chain of bodies that moves as a whole.
class ChainSource final : public FrameSource {
 public:
  explicit ChainSource(std::uint32_t objects = 4, std::uint32_t frames = kFrames)
      : scene_{"Chain", "Cubes", objects, frames, {{0, 0, 0, 0}, {100, 100, 100, 0}}} {}

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }
  Frame rewind() override { return at(0); }
  std::optional<Frame> next() override {
    if (index_ == scene_.frames) return std::nullopt;
    return at(index_ + 1);
  }

 private:
  Frame at(std::uint32_t index) {
    index_ = index;
    boxes_ = chain(scene_.objects);
    for (Aabb& box : boxes_) {
      box.min[1] += static_cast<float>(index);
      box.max[1] += static_cast<float>(index);
    }
    return {index, boxes_};
  }

  SceneInfo scene_;
  std::uint32_t index_ = 0;
  std::vector<Aabb> boxes_;
};

/// Everything that a run may go through, to be replaced one by one.
struct Behaviour {
  std::function<void()> on_initialize = [] {};
  std::function<void(std::uint32_t frame)> on_update = [](std::uint32_t) {};
  std::function<void(std::uint32_t frame, std::vector<Pair>&)> on_answer =
      [](std::uint32_t, std::vector<Pair>&) {};
  Capabilities capabilities;
  std::function<void()> on_destroy = [] {};  // of an instance that was initialised
};

/// Brute force, spoilt by a behaviour.
class Spoilt final : public BoxBroadPhase {
 public:
  explicit Spoilt(Behaviour behaviour) : behaviour_(std::move(behaviour)) {}
  ~Spoilt() override {
    if (initialised_) behaviour_.on_destroy();
  }

  [[nodiscard]] Capabilities capabilities() const override { return behaviour_.capabilities; }
  void visitParameters(const ParameterVisitor& visit) override {
    visit({.name = "cells", .doc = "does nothing", .value = &cells_, .min = 1, .max = 9});
  }
  void initialize(const SceneInfo& scene, const Frame& first, Execution& execution) override {
    BoxBroadPhase::initialize(scene, first, execution);
    initialised_ = true;
    behaviour_.on_initialize();
  }
  void updateObjects(const Frame& frame) override {
    BoxBroadPhase::updateObjects(frame);
    frame_ = frame.index;
    if (frame_ > 0) behaviour_.on_update(frame_);
  }
  void searchOverlaps() override {
    std::vector<Pair> answer = bruteForcePairs(boxes());
    behaviour_.on_answer(frame_, answer);
    std::ranges::copy(answer, pairs().room(answer.size()));
    pairs().advance(answer.size());
    publishPairs();
  }

 private:
  Behaviour behaviour_;
  bool initialised_ = false;
  std::uint32_t frame_ = 0;
  std::int64_t cells_ = 2;
};

Case caseOf(Behaviour behaviour = {}) {
  Case run;
  run.algorithm.id = "spoilt";
  run.algorithm.family = "Tests";
  run.algorithm.create = [behaviour] { return std::make_unique<Spoilt>(behaviour); };
  return run;
}

/// Spoils the answer of one frame.
Case spoilingAnswer(std::function<void(std::vector<Pair>&)> spoil) {
  return caseOf({.on_answer = [spoil](std::uint32_t frame, std::vector<Pair>& answer) {
    if (frame == kFaultyFrame) spoil(answer);
  }});
}

CaseResult runOnChain(const Case& run, const RunOptions& options = {}, int repetitions = 1) {
  ChainSource source;
  return runCase(run, source, options, repetitions);
}

TEST(Runner, ARightAnswerIsOk) {
  for (const CheckMode check : {CheckMode::full, CheckMode::hash, CheckMode::off}) {
    const CaseResult result = runOnChain(caseOf(), {.check = check}, 3);
    EXPECT_EQ(result.status, Status::ok);
    EXPECT_EQ(result.reason, "");
    EXPECT_EQ(result.checked, check != CheckMode::off);
    EXPECT_EQ(result.missed + result.extra + result.invalid, 0U);
    EXPECT_EQ(result.pairs_mean, 3);
    EXPECT_EQ(result.pairs_max, 3U);
    ASSERT_EQ(result.repetitions.size(), 3U);
    for (const Repetition& repetition : result.repetitions) {
      EXPECT_EQ(repetition.frames.size(), kFrames);
    }
  }
}

/// A way to be wrong in one frame, and what is to be said of it.
struct Fault {
  const char* name;
  std::function<void(std::vector<Pair>&)> spoil;
  std::uint64_t missed, extra, invalid;
  std::string reason;
  std::function<std::vector<Pair>(const FrameDifference&)> listed;
  Pair pair;
};

class FaultyAnswer : public testing::TestWithParam<CheckMode> {};

TEST_P(FaultyAnswer, IsAMismatchWithTheFrameAndThePair) {
  const auto missed = [](const FrameDifference& d) { return d.missed; };
  const auto extra = [](const FrameDifference& d) { return d.extra; };
  const auto invalid = [](const FrameDifference& d) { return d.invalid; };
  const Fault faults[] = {{"misses",
                           [](auto& a) {
                             std::erase(a, Pair{1, 2});
                           },
                           1,
                           0,
                           0,
                           "frame 3: 1 missed, 0 false, 0 invalid",
                           missed,
                           {1, 2}},
                          {"extra",
                           [](auto& a) {
                             a.push_back({0, 3});
                           },
                           0,
                           1,
                           0,
                           "frame 3: 0 missed, 1 false, 0 invalid",
                           extra,
                           {0, 3}},
                          {"duplicate",
                           [](auto& a) {
                             a.push_back({0, 1});
                           },
                           0,
                           0,
                           1,
                           "frame 3: 0 missed, 0 false, 1 invalid",
                           invalid,
                           {0, 1}},
                          {"self",
                           [](auto& a) {
                             a.push_back({2, 2});
                           },
                           0,
                           0,
                           1,
                           "frame 3: 0 missed, 0 false, 1 invalid",
                           invalid,
                           {2, 2}},
                          {"out of range",
                           [](auto& a) {
                             a.push_back({2, 4});
                           },
                           0,
                           0,
                           1,
                           "frame 3: 0 missed, 0 false, 1 invalid",
                           invalid,
                           {2, 4}},
                          {"replaced",
                           [](auto& a) { a[0] = a[1]; },
                           1,
                           0,
                           1,
                           "frame 3: 1 missed, 0 false, 1 invalid",
                           missed,
                           {0, 1}}};
  for (const Fault& fault : faults) {
    SCOPED_TRACE(fault.name);
    const CaseResult result = runOnChain(spoilingAnswer(fault.spoil), {.check = GetParam()});
    EXPECT_EQ(result.status, Status::mismatch);
    EXPECT_EQ(result.reason, fault.reason);
    EXPECT_EQ(result.missed, fault.missed);
    EXPECT_EQ(result.extra, fault.extra);
    EXPECT_EQ(result.invalid, fault.invalid);
    ASSERT_EQ(result.differences.size(), 1U);
    EXPECT_EQ(result.differences[0].frame, kFaultyFrame);
    EXPECT_EQ(result.differences[0].repetition, 1);
    EXPECT_THAT(fault.listed(result.differences[0]), ElementsAre(fault.pair));
    EXPECT_EQ(result.repetitions.at(0).frames.size(), kFrames) << "times are kept, with the status";
  }
}

INSTANTIATE_TEST_SUITE_P(Modes, FaultyAnswer, testing::Values(CheckMode::full, CheckMode::hash));

TEST(Runner, UncheckedFaultsAreNotClaimedToBeRight) {
  const Case wrong = spoilingAnswer([](auto& answer) { answer.clear(); });
  const CaseResult unchecked = runOnChain(wrong, {.check = CheckMode::off});
  EXPECT_EQ(unchecked.status, Status::ok);
  EXPECT_FALSE(unchecked.checked);

  Case self_check = wrong;
  self_check.algorithm.finds_pairs = false;
  EXPECT_FALSE(runOnChain(self_check).checked);
}

TEST(Runner, EveryWrongFrameIsListedAndTheFirstIsTheReason) {
  const Case wrong = caseOf({.on_answer = [](std::uint32_t, auto& answer) { answer.clear(); }});
  const CaseResult result = runOnChain(wrong);
  EXPECT_EQ(result.missed, 3U * kFrames);
  ASSERT_EQ(result.differences.size(), kFrames);
  for (std::uint32_t i = 0; i < kFrames; ++i) EXPECT_EQ(result.differences[i].frame, i + 1);
  EXPECT_THAT(result.reason, StartsWith("frame 1: 3 missed"));
}

// Bodies two apart in the chain have a gap of 1.
TEST(Runner, AConservativeAnswerIsCheckedAgainstItsMargin) {
  for (const CheckMode check : {CheckMode::full, CheckMode::hash}) {
    const auto spoil = [](std::uint32_t, std::vector<Pair>& answer) { answer.push_back({0, 2}); };
    const CaseResult within = runOnChain(
        caseOf({.on_answer = spoil, .capabilities = {.margin = 0.5F}}), {.check = check});
    EXPECT_EQ(within.status, Status::ok);
    EXPECT_EQ(within.extra, kFrames) << "allowed, but counted";
    EXPECT_TRUE(within.differences.empty());

    const CaseResult beyond = runOnChain(
        caseOf({.on_answer = spoil, .capabilities = {.margin = 0.4F}}), {.check = check});
    EXPECT_EQ(beyond.status, Status::mismatch);
    EXPECT_EQ(beyond.differences.size(), kFrames);
  }
}

TEST(Runner, AConservativeAnswerMayMissNothing) {
  const Case run = caseOf({.on_answer = [](std::uint32_t, auto& answer) { answer.pop_back(); },
                           .capabilities = {.margin = 1000}});
  EXPECT_EQ(runOnChain(run, {.check = CheckMode::hash}).status, Status::mismatch);
}

TEST(Runner, WhatItThrowsBecomesTheStatus) {
  const Case unsupported =
      caseOf({.on_initialize = [] { throw UnsupportedError("no such device"); }});
  EXPECT_EQ(runOnChain(unsupported).status, Status::unsupported);
  EXPECT_EQ(runOnChain(unsupported).reason, "no such device");

  const Case failing = caseOf({.on_update = [](std::uint32_t frame) {
    if (frame == kFaultyFrame) throw std::runtime_error("out of cells");
  }});
  const CaseResult result = runOnChain(failing, {}, 3);
  EXPECT_EQ(result.status, Status::error);
  EXPECT_EQ(result.reason, "out of cells");
  EXPECT_TRUE(result.repetitions.empty());
}

TEST(Runner, WhatCannotRunHereIsUnsupported) {
  const CaseResult too_many = runOnChain(caseOf({.capabilities = {.max_objects = 3}}));
  EXPECT_EQ(too_many.status, Status::unsupported);
  EXPECT_THAT(too_many.reason, AllOf(HasSubstr("at most 3"), HasSubstr("has 4")));
}

TEST(Runner, AnInstructionSetThatIsMissingIsUnsupported) {
  if (isaSupported(Isa::avx512)) GTEST_SKIP() << "this processor has all instruction sets";
  Case vectorised = caseOf();
  vectorised.isa = Isa::avx512;
  EXPECT_EQ(runOnChain(vectorised).status, Status::ok) << "heeds no instruction set";
  vectorised.algorithm.vectorised = true;
  EXPECT_EQ(runOnChain(vectorised).status, Status::unsupported);
}

TEST(Runner, BadInputIsNoResult) {
  Case run = caseOf();
  run.parameters = {{"cells", "10"}};
  EXPECT_THAT(inputErrorOf([&] { runOnChain(run); }), HasSubstr("cells"));
  run.parameters = {{"cell", "1"}};
  EXPECT_THAT(inputErrorOf([&] { runOnChain(run); }), HasSubstr("did you mean 'cells'"));
}

TEST(Runner, TheTimeLimitIsJudgedAfterThreeFramesAndKeepsThem) {
  const Case slow = caseOf({.on_update = [](std::uint32_t) { wait(0.01); }});
  const CaseResult result = runOnChain(slow, {.frame_limit_seconds = 0.005}, 2);
  EXPECT_EQ(result.status, Status::timeout);
  EXPECT_THAT(result.reason, AllOf(HasSubstr("after frame 3"), HasSubstr("limit of 0.005 s")));
  ASSERT_EQ(result.repetitions.size(), 1U);
  EXPECT_EQ(result.repetitions[0].frames.size(), 3U);
  EXPECT_GE(result.summary().seconds_per_frame, 0.01);
  EXPECT_EQ(result.pairs_mean, 3);
}

// A slow first frame alone is forgiven when the mean is within the limit.
TEST(Runner, TheTimeLimitIsOnTheRunningMean) {
  const Case slow_start = caseOf({.on_update = [](std::uint32_t frame) {
    if (frame == 1) wait(0.02);
  }});
  EXPECT_EQ(runOnChain(slow_start, {.frame_limit_seconds = 0.5}).status, Status::ok);
  EXPECT_EQ(runOnChain(slow_start, {.frame_limit_seconds = 0.003}).status, Status::timeout);
}

TEST(Runner, InitialisationHasItsOwnLimit) {
  const Case slow = caseOf({.on_initialize = [] { wait(0.02); }});
  const CaseResult result = runOnChain(slow, {.initialize_limit_seconds = 0.005});
  EXPECT_EQ(result.status, Status::timeout);
  EXPECT_THAT(result.reason, HasSubstr("initialisation"));

  const CaseResult patient = runOnChain(slow, {.frame_limit_seconds = 0.015});
  EXPECT_EQ(patient.status, Status::ok) << "initialising counts for no frame";
  EXPECT_GE(patient.repetitions.at(0).initialize_ns, 20'000'000);
}

TEST(Runner, ACancelledRepetitionIsDropped) {
  ChainSource source;
  Oracle oracle;
  const Case run = caseOf();
  CaseResult result = beginCase(run, {.scene = source.scene()});
  ASSERT_TRUE(runRepetition(result, run, source, oracle, {}));

  int asked = 0;
  const RunOptions options = {.cancelled = [&] { return ++asked > 2; }};
  EXPECT_FALSE(runRepetition(result, run, source, oracle, options));
  EXPECT_EQ(asked, 3);
  EXPECT_EQ(result.repetitions.size(), 1U);
  EXPECT_EQ(result.status, Status::ok);
}

TEST(Runner, AWarmUpIsCheckedButNotRecorded) {
  ChainSource source;
  Oracle oracle;
  const Case run = caseOf();
  CaseResult result = beginCase(run, {.scene = source.scene()});
  EXPECT_TRUE(runRepetition(result, run, source, oracle, {}, false));
  EXPECT_TRUE(result.repetitions.empty());
  EXPECT_TRUE(runRepetition(result, run, source, oracle, {}));
  EXPECT_EQ(result.repetitions.size(), 1U);
  EXPECT_EQ(result.pairs_mean, 3);

  const Case wrong = spoilingAnswer([](auto& answer) { answer.clear(); });
  CaseResult spoilt = beginCase(wrong, {.scene = source.scene()});
  runRepetition(spoilt, wrong, source, oracle, {}, false);
  EXPECT_EQ(spoilt.status, Status::mismatch);
  EXPECT_TRUE(spoilt.repetitions.empty());
}

TEST(Runner, FramesComeInOrderAndEveryRepetitionIsAFreshInstance) {
  std::vector<std::uint32_t> frames;
  int initialised = 0;
  const Case run = caseOf({.on_initialize = [&] { ++initialised; },
                           .on_update = [&](std::uint32_t frame) { frames.push_back(frame); }});
  std::vector<std::uint32_t> told;
  runOnChain(run, {.progress = [&](std::uint32_t frame) { told.push_back(frame); }}, 2);
  EXPECT_EQ(initialised, 2);
  EXPECT_EQ(frames, (std::vector<std::uint32_t>{1, 2, 3, 4, 5, 6, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(told, frames);
}

TEST(Runner, PhasesAreWithinTheTotal) {
  const Case run = caseOf({.on_update = [](std::uint32_t) { wait(0.001); },
                           .on_answer = [](std::uint32_t, auto&) { wait(0.002); }});
  const CaseResult result = runOnChain(run);
  for (const FrameTimes& times : result.repetitions.at(0).frames) {
    std::int64_t sum = 0;
    for (const Phase phase : kAllPhases) {
      EXPECT_GE(times[phase], 0);
      if (phase != Phase::total) sum += times[phase];
    }
    EXPECT_LE(sum, times[Phase::total]);
    EXPECT_GE(times[Phase::update_objects], 1'000'000);
    EXPECT_GE(times[Phase::search_overlaps], 2'000'000);
  }
}

TEST(Runner, NothingButTheAlgorithmIsTimed) {
  const RunOptions slow_harness = {.frame_limit_seconds = 0.004,
                                   .cancelled =
                                       [] {
                                         wait(0.005);
                                         return false;
                                       },
                                   .progress = [](std::uint32_t) { wait(0.005); }};
  EXPECT_EQ(runOnChain(caseOf(), slow_harness).status, Status::ok);
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
  Case run = caseOf();
  run.threads = 4;
  run.isa = Isa::avx2;
  EXPECT_EQ(caseName(run), "spoilt");
  run.algorithm.vectorised = true;
  run.algorithm.parallel = true;
  run.parameters = {{"cells", "3"}};
  EXPECT_EQ(caseName(run), "spoilt/avx2/t4/cells=3");
  RecordingReference recording = {.scene = ChainSource().scene()};
  EXPECT_EQ(caseId(recording, run), "Chain/Cubes/N4/F6/spoilt/avx2/t4/cells=3");
  recording.seed = 7;
  EXPECT_EQ(caseId(recording, run), "Chain/Cubes/N4/F6/s7/spoilt/avx2/t4/cells=3");

  const CaseResult result = beginCase(run, recording);
  EXPECT_EQ(result.id, caseId(recording, run));
  EXPECT_EQ(result.threads, 4);
  EXPECT_EQ(result.isa, Isa::avx2);
  EXPECT_EQ(result.parameters, (ParameterValues{{"cells", "3"}}));
  run.parameters.clear();
  EXPECT_EQ(beginCase(run, recording).parameters, (ParameterValues{{"cells", "2"}}))
      << "defaults included";
}

TEST(Runner, ExclusiveInstancesNeverLiveAtTheSameTime) {
  std::atomic<int> alive = 0;
  std::atomic<int> most = 0;
  Behaviour behaviour;
  behaviour.capabilities.exclusive = "a library with one global margin";
  behaviour.on_initialize = [&] {
    most = std::max(most.load(), ++alive);
    wait(0.002);
  };
  behaviour.on_destroy = [&] { --alive; };
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back(
        [&] { EXPECT_EQ(runOnChain(caseOf(behaviour), {}, 3).status, Status::ok); });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(most, 1);
}

TEST(PeakMemory, IsWhatTheAlgorithmTakes) {
  if (kSanitized) GTEST_SKIP() << "sanitizers take memory of their own";
  constexpr std::size_t kBytes = 64 << 20;
  const auto take = [] {
    const std::unique_ptr<char[]> memory(new char[kBytes]);
    std::memset(memory.get(), 1, kBytes);
    EXPECT_EQ(std::accumulate(memory.get(), memory.get() + 9, 0), 9);  // so that it is not left out
  };
  ChainSource source;
  // The parent has just freed twice as much, in pieces below one that is still held, so that the
  // heap does not shrink: that must not hide what the child takes.
  std::vector<std::vector<char>> pieces(2 * kBytes / 4096, std::vector<char>(4096, 1));
  const std::vector<char> held = std::move(pieces.back());
  pieces.clear();
  const auto peak = measurePeakBytes(caseOf({.on_initialize = take}), source);
  ASSERT_TRUE(peak);
  EXPECT_GE(*peak, kBytes * 95 / 100);
  EXPECT_LE(*peak, kBytes + (16 << 20));

  const auto idle = measurePeakBytes(caseOf(), source);
  ASSERT_TRUE(idle);
  EXPECT_LE(*idle, std::uint64_t{8} << 20);
}

TEST(PeakMemory, IsUnknownWhenTheRunFails) {
  ChainSource source;
  const Case failing = caseOf({.on_initialize = [] { throw std::runtime_error("no"); }});
  EXPECT_FALSE(measurePeakBytes(failing, source));
}

}  // namespace
}  // namespace broadmark::tests
