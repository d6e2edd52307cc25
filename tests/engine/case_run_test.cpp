// A case, frame by frame: times, limits, verdict, exclusivity.

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

// In the chain, bodies i and i + 2 have a gap of 1.
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
  const Case test_case =
      caseOf({.on_answer = [](std::uint32_t, auto& answer) { answer.pop_back(); }, .margin = 1000});
  EXPECT_EQ(runOnChain(test_case, {.check = CheckMode::hash}).status, Status::mismatch);
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
  EXPECT_EQ(runOnChain(vectorised).status, Status::ok) << "has no SIMD kernels";
  vectorised.algorithm.traits.vectorised = true;
  EXPECT_EQ(runOnChain(vectorised).status, Status::unsupported);
}

TEST(CaseRun, BadInputIsNoResult) {
  Case test_case = caseOf();
  test_case.parameters = {{"cells", "10"}};
  EXPECT_THAT(inputErrorOf([&] { runOnChain(test_case); }), HasSubstr("cells"));
  test_case.parameters = {{"cell", "1"}};
  EXPECT_THAT(inputErrorOf([&] { runOnChain(test_case); }), HasSubstr("did you mean 'cells'"));
}

/// A case with given times of its passes.
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

// A slow first frame is accepted while the mean is within the limit.
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

// Under any load of the machine, work within a call takes no longer than the call.
TEST(CaseRun, PhasesAreWithinTheTotalAndHoldWhatTheyCall) {
  FrameTimes within;
  const auto passes = [&within](Phase phase) {
    const auto begin = Clock::now();
    bruteForcePairs(inputs::uniform(100, 1, 1));
    within[phase] = std::chrono::nanoseconds(Clock::now() - begin).count();
  };
  CaseRun case_run(
      caseOf({.on_update = [&](std::uint32_t) { passes(Phase::update_objects); },
              .on_answer = [&](std::uint32_t, auto&) { passes(Phase::search_overlaps); }}));
  ChainSource source;
  ASSERT_TRUE(case_run.start(source.scene(), source.rewind()));
  for (std::uint32_t index = 1; index <= kChainFrames; ++index) {
    case_run.step(source.at(index));
    const FrameTimes& times = case_run.times();
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
  CaseRun case_run(caseOf({.on_answer = [](std::uint32_t, auto& answer) { answer.clear(); }}));
  ASSERT_TRUE(case_run.start(source.scene(), source.rewind()));
  EXPECT_FALSE(case_run.answered());
  for (std::uint32_t index = 1; index <= 2; ++index) {
    const Frame frame = source.at(index);
    EXPECT_TRUE(case_run.step(frame));
    EXPECT_TRUE(case_run.answered());
    EXPECT_TRUE(case_run.check(frame, oracle)->isMismatch());
  }
  EXPECT_EQ(case_run.status(), Status::mismatch);
  EXPECT_THAT(case_run.reason(), HasSubstr("frame 1"));
}

TEST(CaseRun, SaysWhyAPassEndedAlsoAfterAMismatch) {
  ChainSource source;
  Oracle oracle;
  CaseRun case_run(caseOf({.on_update =
                               [](std::uint32_t frame) {
                                 if (frame == 2) throw std::runtime_error("out of cells");
                               },
                           .on_answer = [](std::uint32_t, auto& answer) { answer.clear(); }}));
  for (int pass = 0; pass < 2; ++pass) {
    case_run.start(source.scene(), source.rewind());
    case_run.step(source.at(1));
    case_run.check(source.at(1), oracle);
    EXPECT_FALSE(case_run.step(source.at(2)));
  }
  EXPECT_EQ(case_run.status(), Status::mismatch);
  EXPECT_THAT(case_run.reason(), AllOf(HasSubstr("frame 1"), testing::EndsWith("out of cells")));
  EXPECT_EQ(case_run.reason().find("out of cells"), case_run.reason().rfind("out of cells"))
      << "said once";
}

TEST(CaseRun, APassBeyondTheLimitStillHasItsLastAnswer) {
  ChainSource source;
  Oracle oracle;
  CaseRun case_run(caseOf(), {.frame_limit_seconds = 0});
  case_run.start(source.scene(), source.rewind());
  EXPECT_TRUE(case_run.step(source.at(1)));
  EXPECT_TRUE(case_run.step(source.at(2)));
  EXPECT_FALSE(case_run.step(source.at(3)));
  EXPECT_EQ(case_run.status(), Status::timeout);
  EXPECT_FALSE(case_run.running());
  ASSERT_TRUE(case_run.answered());
  EXPECT_FALSE(case_run.check(source.at(3), oracle)->isMismatch());
  case_run.stop();
  EXPECT_FALSE(case_run.answered());
}

TEST(CaseRun, APassThatFailedHasNoInstance) {
  ChainSource source;
  CaseRun case_run(caseOf({.on_update = [](std::uint32_t) { throw std::runtime_error("no"); }}));
  ASSERT_TRUE(case_run.start(source.scene(), source.rewind()));
  EXPECT_FALSE(case_run.step(source.at(1)));
  EXPECT_FALSE(case_run.hasInstance());
  EXPECT_EQ(case_run.status(), Status::error);
}

/// Records the execution context of each instance.
class ContextWitness final : public BoxBroadPhase {
 public:
  explicit ContextWitness(std::vector<const ExecutionContext*>& contexts) : contexts_(contexts) {}
  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    BoxBroadPhase::initialize(scene, first, execution);
    contexts_.push_back(&execution);
  }

 private:
  void findPairs() override {}
  std::vector<const ExecutionContext*>& contexts_;
};

TEST(CaseRun, AllPassesShareOneExecution) {
  std::vector<const ExecutionContext*> contexts;
  Case test_case;
  test_case.algorithm.create = [&] { return std::make_unique<ContextWitness>(contexts); };
  CaseRun case_run(test_case);
  ChainSource source;
  ChainSource other(2, 3);
  case_run.start(source.scene(), source.rewind());
  case_run.start(source.scene(), source.rewind());
  case_run.start(other.scene(), other.rewind());
  ASSERT_EQ(contexts.size(), 3U);
  EXPECT_EQ(contexts[0], contexts[1]);
  EXPECT_EQ(contexts[0], contexts[2]);
}

TEST(CaseRun, CallsIntoAnExclusiveAlgorithmNeverMeet) {
  std::atomic<int> inside = 0;
  std::atomic<int> max = 0;
  const auto call = [&] {
    max = std::max(max.load(), ++inside);
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
  EXPECT_EQ(max, 1);
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
  behaviour.traits.exclusive = "a library that is in use";
  CaseRun case_run(caseOf(behaviour));
  ChainSource source;
  case_run.start(source.scene(), source.rewind());
  std::latch held(1);
  std::latch wanted(1);
  Clock::time_point released;
  std::thread other([&] {
    const ExclusiveUse use(behaviour.traits.exclusive);
    held.count_down();
    wanted.wait();
    for (int turn = 0; turn < 1000; ++turn) std::this_thread::yield();
    released = Clock::now();
  });
  held.wait();
  wanted.count_down();
  case_run.step(source.at(1));
  const auto end = Clock::now();
  other.join();
  EXPECT_LE(std::chrono::nanoseconds(case_run.times()[Phase::total]), end - released);
}

TEST(ExclusiveUse, KeepsReadersOutAndReadersShare) {
  constexpr std::string_view kState = "a state of this test";
  int value = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 2; ++i) {
    threads.emplace_back([&] {
      for (int turn = 0; turn < 500; ++turn) {
        const ExclusiveUse writing(kState);
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
  std::thread([&] { const SharedUse second(kState); }).join();  // blocks unless both share
}

}  // namespace
}  // namespace broadmark::tests
