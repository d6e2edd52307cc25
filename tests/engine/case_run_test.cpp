// One case, frame by frame: clock, limits, verdict, exclusivity.

#include "broadmark/harness/case_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <latch>
#include <thread>

#include "broadmark/exclusive_use.h"
#include "broadmark/reference_pairs.h"
#include "engine/spoilt_cases.h"
#include "support/wrapped_host.h"
#include "torture/inputs.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using Clock = std::chrono::steady_clock;

// Bodies two apart in the chain have a gap of 1.
TEST(CaseRun, AConservativeAnswerIsCheckedAgainstItsMargin) {
  for (const CheckMode check : {CheckMode::full, CheckMode::hash}) {
    const auto spoil = [](std::uint32_t, std::vector<Pair>& answer) { answer.push_back({0, 2}); };
    const CaseResult within =
        runOnChain(caseOf({.on_answer = spoil, .margin = 0.5F}), {.check = check});
    EXPECT_EQ(within.status, Status::ok);
    EXPECT_EQ(within.allowed_extra_count, kChainFrames) << "allowed, but counted";
    EXPECT_TRUE(within.differences.empty());

    const CaseResult beyond =
        runOnChain(caseOf({.on_answer = spoil, .margin = 0.4F}), {.check = check});
    EXPECT_EQ(beyond.status, Status::mismatch);
    EXPECT_EQ(beyond.differences.size(), kChainFrames);
  }
}

TEST(CaseRun, AConservativeAnswerMayMissNothing) {
  const Case run =
      caseOf({.on_answer = [](std::uint32_t, auto& answer) { answer.pop_back(); }, .margin = 1000});
  EXPECT_EQ(runOnChain(run, {.check = CheckMode::hash}).status, Status::mismatch);
}

TEST(CaseRun, WhatItThrowsBecomesTheStatus) {
  const Case unsupported =
      caseOf({.on_initialize = [] { throw UnsupportedError("no such device"); }});
  EXPECT_EQ(runOnChain(unsupported).status, Status::unsupported);
  EXPECT_EQ(runOnChain(unsupported).reason, "no such device");

  const Case failing = caseOf({.on_update = [](std::uint32_t frame) {
    if (frame == kFaultyFrame) throw std::runtime_error("out of cells");
  }});
  const CaseResult result = runOnChain(failing, {}, 3);
  EXPECT_EQ(result.status, Status::error);
  EXPECT_THAT(result.reason, AllOf(HasSubstr("frame 3"), HasSubstr("out of cells")));
  EXPECT_TRUE(result.repetitions.empty());
}

TEST(CaseRun, WhatCannotRunHereIsUnsupported) {
  const CaseResult too_many = runOnChain(caseOf({.traits = {.max_objects = 3}}));
  EXPECT_EQ(too_many.status, Status::unsupported);
  EXPECT_THAT(too_many.reason, AllOf(HasSubstr("at most 3"), HasSubstr("has 4")));
}

TEST(CaseRun, AnInstructionSetThatIsMissingIsUnsupported) {
  Case vectorised = caseOf();
  vectorised.isa = isaSupported(Isa::neon) ? Isa::avx512 : Isa::neon;  // no processor has both
  EXPECT_EQ(runOnChain(vectorised).status, Status::ok) << "heeds no instruction set";
  vectorised.algorithm.traits.vectorised = true;
  EXPECT_EQ(runOnChain(vectorised).status, Status::unsupported);
}

TEST(CaseRun, BadInputIsNoResult) {
  Case run = caseOf();
  run.parameters = {{"cells", "10"}};
  EXPECT_THAT(inputErrorOf([&] { runOnChain(run); }), HasSubstr("cells"));
  run.parameters = {{"cell", "1"}};
  EXPECT_THAT(inputErrorOf([&] { runOnChain(run); }), HasSubstr("did you mean 'cells'"));
}

/// A case whose passes take these times.
class TimedRun {
 public:
  TimedRun(HostOfTimes::Times times, const RunPolicy& policy)
      : run_(caseOf(), policy, [times](const Case& test_case, const CancelQuery&) {
          return std::make_unique<HostOfTimes>(test_case, times);
        }) {}

  CaseResult result(int repetitions = 1) {
    ChainSource source;
    Oracle oracle;
    CaseResult result = beginCase(run_.description(), {.scene = source.scene()});
    for (int i = 0; i < repetitions && result.status == Status::ok; ++i) {
      runRepetition(result, run_, source, oracle);
    }
    return result;
  }

 private:
  CaseRun run_;
};

FrameTimes totalOf(double seconds) {
  FrameTimes times;
  times[Phase::total] = std::llround(seconds * 1e9);
  return times;
}

TEST(CaseRun, TheTimeLimitIsJudgedAfterThreeFramesAndKeepsThem) {
  const auto slow = [](std::uint32_t) { return totalOf(0.01); };
  const CaseResult result = TimedRun({.of_frame = slow}, {.frame_limit_seconds = 0.005}).result(2);
  EXPECT_EQ(result.status, Status::timeout);
  EXPECT_THAT(result.reason, AllOf(HasSubstr("after frame 3"), HasSubstr("limit of 0.005 s")));
  ASSERT_EQ(result.repetitions.size(), 1U);
  EXPECT_EQ(result.repetitions[0].frames.size(), 3U);
  EXPECT_DOUBLE_EQ(result.summary().seconds_per_frame, 0.01);
  EXPECT_EQ(result.pairs_mean, 3);
}

// A slow first frame alone is forgiven when the mean is within the limit.
TEST(CaseRun, TheTimeLimitIsOnTheRunningMean) {
  const auto slow_start = [](std::uint32_t frame) { return totalOf(frame == 1 ? 0.02 : 0); };
  const auto with_limit = [&](double seconds) {
    return TimedRun({.of_frame = slow_start}, {.frame_limit_seconds = seconds}).result().status;
  };
  EXPECT_EQ(with_limit(0.007), Status::ok);
  EXPECT_EQ(with_limit(0.006), Status::timeout);
}

TEST(CaseRun, InitialisationHasItsOwnLimit) {
  const HostOfTimes::Times slow{.initialize_ns = 20'000'000};
  const CaseResult result = TimedRun(slow, {.initialize_limit_seconds = 0.019}).result();
  EXPECT_EQ(result.status, Status::timeout);
  EXPECT_THAT(result.reason, HasSubstr("initialisation"));

  const CaseResult patient = TimedRun(slow, {.frame_limit_seconds = 0.001}).result();
  EXPECT_EQ(patient.status, Status::ok) << "initialising counts for no frame";
  EXPECT_EQ(patient.repetitions.at(0).initialize_ns, 20'000'000);
}

// Whatever else the machine does, what happens within a call takes no longer than the call.
TEST(CaseRun, PhasesAreWithinTheTotalAndHoldWhatTheyCall) {
  FrameTimes within;
  const auto passes = [&within](Phase phase) {
    const auto begin = Clock::now();
    bruteForcePairs(inputs::uniform(100, 1, 1));
    within[phase] = std::chrono::nanoseconds(Clock::now() - begin).count();
  };
  CaseRun run(caseOf({.on_update = [&](std::uint32_t) { passes(Phase::update_objects); },
                      .on_answer = [&](std::uint32_t, auto&) { passes(Phase::search_overlaps); }}));
  ChainSource source;
  ASSERT_TRUE(run.start(source.scene(), source.rewind()));
  for (std::uint32_t index = 1; index <= kChainFrames; ++index) {
    run.step(source.at(index));
    const FrameTimes& times = run.times();
    std::int64_t sum = 0;
    for (const auto& [phase, name] : kPhases.entries) {
      EXPECT_GE(times[phase], within[phase]) << name;
      if (phase != Phase::total) sum += times[phase];
    }
    EXPECT_LE(sum, times[Phase::total]);
  }
}

TEST(CaseRun, GoesOnAfterAMismatchAndKeepsTheFirstReason) {
  ChainSource source;
  Oracle oracle;
  CaseRun run(caseOf({.on_answer = [](std::uint32_t, auto& answer) { answer.clear(); }}));
  ASSERT_TRUE(run.start(source.scene(), source.rewind()));
  EXPECT_FALSE(run.answered());
  for (std::uint32_t index = 1; index <= 2; ++index) {
    const Frame frame = source.at(index);
    EXPECT_TRUE(run.step(frame));
    EXPECT_TRUE(run.answered());
    EXPECT_TRUE(run.check(frame, oracle)->isMismatch());
  }
  EXPECT_EQ(run.status(), Status::mismatch);
  EXPECT_THAT(run.reason(), HasSubstr("frame 1"));
}

TEST(CaseRun, SaysWhyAPassEndedAlsoAfterAMismatch) {
  ChainSource source;
  Oracle oracle;
  CaseRun run(caseOf({.on_update =
                          [](std::uint32_t frame) {
                            if (frame == 2) throw std::runtime_error("out of cells");
                          },
                      .on_answer = [](std::uint32_t, auto& answer) { answer.clear(); }}));
  for (int pass = 0; pass < 2; ++pass) {
    run.start(source.scene(), source.rewind());
    run.step(source.at(1));
    run.check(source.at(1), oracle);
    EXPECT_FALSE(run.step(source.at(2)));
  }
  EXPECT_EQ(run.status(), Status::mismatch);
  EXPECT_THAT(run.reason(), AllOf(HasSubstr("frame 1"), testing::EndsWith("out of cells")));
  EXPECT_EQ(run.reason().find("out of cells"), run.reason().rfind("out of cells")) << "said once";
}

TEST(CaseRun, APassBeyondTheLimitStillHasItsLastAnswer) {
  ChainSource source;
  Oracle oracle;
  CaseRun run(caseOf(), {.frame_limit_seconds = 0});
  run.start(source.scene(), source.rewind());
  EXPECT_TRUE(run.step(source.at(1)));
  EXPECT_TRUE(run.step(source.at(2)));
  EXPECT_FALSE(run.step(source.at(3)));
  EXPECT_EQ(run.status(), Status::timeout);
  EXPECT_FALSE(run.running());
  ASSERT_TRUE(run.answered());
  EXPECT_FALSE(run.check(source.at(3), oracle)->isMismatch());
  run.stop();
  EXPECT_FALSE(run.answered());
}

TEST(CaseRun, APassThatFailedHasNoInstance) {
  ChainSource source;
  CaseRun run(caseOf({.on_update = [](std::uint32_t) { throw std::runtime_error("no"); }}));
  ASSERT_TRUE(run.start(source.scene(), source.rewind()));
  EXPECT_FALSE(run.step(source.at(1)));
  EXPECT_FALSE(run.hasInstance());
  EXPECT_EQ(run.status(), Status::error);
}

/// Says which execution each of its instances was given.
class ExecutionTeller final : public BoxBroadPhase {
 public:
  explicit ExecutionTeller(std::vector<const ExecutionContext*>& told) : told_(told) {}
  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    BoxBroadPhase::initialize(scene, first, execution);
    told_.push_back(&execution);
  }

 private:
  void findPairs() override {}
  std::vector<const ExecutionContext*>& told_;
};

TEST(CaseRun, AllPassesShareOneExecution) {
  std::vector<const ExecutionContext*> told;
  Case run;
  run.algorithm.create = [&] { return std::make_unique<ExecutionTeller>(told); };
  CaseRun case_run(run);
  ChainSource source;
  ChainSource other(2, 3);
  case_run.start(source.scene(), source.rewind());
  case_run.start(source.scene(), source.rewind());
  case_run.start(other.scene(), other.rewind());
  ASSERT_EQ(told.size(), 3U);
  EXPECT_EQ(told[0], told[1]);
  EXPECT_EQ(told[0], told[2]);
}

TEST(CaseRun, CallsIntoAnExclusiveAlgorithmNeverMeet) {
  std::atomic<int> inside = 0;
  std::atomic<int> most = 0;
  const auto call = [&] {
    most = std::max(most.load(), ++inside);
    std::this_thread::yield();
    --inside;
  };
  Behaviour behaviour;
  behaviour.traits.exclusive = "a library with one global margin";
  behaviour.on_initialize = call;
  behaviour.on_update = [&](std::uint32_t) { call(); };
  behaviour.on_destroy = call;
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back(
        [&] { EXPECT_EQ(runOnChain(caseOf(behaviour), {}, 3).status, Status::ok); });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(most, 1);
}

TEST(CaseRun, ExclusiveAlgorithmsTakeTurnsOnOneThread) {
  Behaviour behaviour;
  behaviour.traits.exclusive = "a library with one global margin";
  CaseRun a(caseOf(behaviour));
  CaseRun b(caseOf(behaviour));
  ChainSource source;
  a.start(source.scene(), source.rewind());
  b.start(source.scene(), source.rewind());
  for (std::uint32_t index = 1; index <= kChainFrames; ++index) {
    EXPECT_TRUE(a.step(source.at(index)));
    EXPECT_TRUE(b.step(source.at(index)));
  }
}

TEST(CaseRun, WaitingForAnExclusiveUseIsNotTimed) {
  Behaviour behaviour;
  behaviour.traits.exclusive = "a library that somebody else uses";
  CaseRun run(caseOf(behaviour));
  ChainSource source;
  run.start(source.scene(), source.rewind());
  std::latch held(1);
  std::latch wanted(1);
  Clock::time_point released;
  std::thread other([&] {
    const ExclusiveUse alone(behaviour.traits.exclusive);
    held.count_down();
    wanted.wait();
    for (int turn = 0; turn < 1000; ++turn) std::this_thread::yield();
    released = Clock::now();
  });
  held.wait();
  wanted.count_down();
  run.step(source.at(1));
  const auto end = Clock::now();
  other.join();
  EXPECT_LE(std::chrono::nanoseconds(run.times()[Phase::total]), end - released);
}

TEST(ExclusiveUse, KeepsReadersOutAndReadersShare) {
  constexpr std::string_view kState = "a state of this test";
  int value = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 2; ++i) {
    threads.emplace_back([&] {
      for (int turn = 0; turn < 500; ++turn) {
        const ExclusiveUse alone(kState);
        ++value;
        ++value;
      }
    });
    threads.emplace_back([&] {
      for (int turn = 0; turn < 500; ++turn) {
        const SharedUse reading(kState);
        EXPECT_EQ(value % 2, 0);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(value, 2000);
  const SharedUse first(kState);
  std::thread([&] { const SharedUse second(kState); }).join();  // never ends unless they share
}

}  // namespace
}  // namespace broadmark::tests
