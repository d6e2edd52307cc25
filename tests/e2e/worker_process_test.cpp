// The executor in a worker process against the in-process one: the same answers, and the errors if
// the other process is no worker.

#include "broadmark/harness/worker_process.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "algorithms/runs.h"
#include "broadmark/algorithms.h"
#include "broadmark/harness/case_run.h"
#include "engine/helpers.h"
#include "support/changing_worlds.h"
#include "support/places.h"
#include "worker/protocol.h"

namespace broadmark::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

WorkerOptions thisProgram() { return {.command = {places::program(), "worker"}}; }

/// Moving clusters: all bodies and pairs, or with absent bodies and a filter.
std::vector<ChangingWorld> movingClusters() {
  constexpr std::size_t kBodies = 300;
  constexpr inputs::Input kInput = {"clustered", inputs::clustered};
  return {{"plain", {}, framesOf(kInput, kBodies, 4)},
          {"changing", filters(kBodies).back().filter,
           framesWith(kInput, kBodies, 4, presences::random)},
          {.name = "changing filters",
           .filter = {},
           .frames = framesWith(kInput, kBodies, 4, presences::random),
           .filters = inputs::changingFilters(filters(kBodies).back().filter, kBodies, 3,
                                              inputs::filter_changes::half, 1)}};
}

/// The pairs, or the begun and the ended pairs.
std::vector<std::vector<Pair>> answerOf(CaseExecutor& host, Answer answer) {
  if (answer == AnswerKind::pairs) return {sorted(host.answer())};
  const PairEvents events = host.events();
  return {sorted(events.began), sorted(events.ended)};
}

void expectSameAnswers(const Case& test_case) {
  InProcessExecutor here(test_case);
  const auto there = makeWorkerProcess(test_case, thisProgram());
  for (const ChangingWorld& world : movingClusters()) {
    const std::vector<std::vector<Aabb>>& frames = world.frames;
    SceneInfo scene = sceneOf(frames);
    scene.filter = world.filterOf(0);
    scene.filter_changes = !world.filters.empty();
    const auto filter_of = [&](std::uint32_t frame) {
      return scene.filter_changes ? &world.filters[frame] : nullptr;
    };
    scene.all_present = world.name == "plain";
    ChangeDetector changed_bodies;
    const Frame first = changed_bodies.complete({0, frames[0], {}, filter_of(0)});
    try {
      here.start(scene, first);
    } catch (const UnsupportedError&) {
      GTEST_SKIP() << "cannot run here";
    }
    EXPECT_GE(there->start(scene, first), 0);
    if (test_case.answer == AnswerKind::events) {
      EXPECT_EQ(answerOf(*there, test_case.answer), answerOf(here, test_case.answer))
          << "the initial pose";
    }
    for (std::uint32_t index = 1; index < frames.size(); ++index) {
      const Frame frame = changed_bodies.complete({index, frames[index], {}, filter_of(index)});
      const StepResult run_here = here.step(frame);
      const StepResult run_there = there->step(frame);
      EXPECT_EQ(run_there.pairs, run_here.pairs);
      EXPECT_GT(run_there.times[Phase::total], 0);
      if (test_case.answer == AnswerKind::pairs) {
        EXPECT_EQ(there->digest(), here.digest());
      }
      EXPECT_EQ(answerOf(*there, test_case.answer), answerOf(here, test_case.answer));
      EXPECT_EQ(there->counters().size(), here.counters().size());
    }
    EXPECT_EQ(there->setup().size(), here.setup().size());
    const RecordedDrawing drawn = there->structure();
    const RecordedDrawing expected = here.structure();
    EXPECT_EQ(drawn.dropped(), expected.dropped());
    EXPECT_EQ(drawn.tests(), expected.tests());
    ASSERT_EQ(drawn.boxes().size(), expected.boxes().size());
    ASSERT_EQ(drawn.lines().size(), expected.lines().size());
    for (std::size_t i = 0; i < drawn.boxes().size(); ++i) {
      EXPECT_EQ(drawn.boxes()[i].box, expected.boxes()[i].box);
      EXPECT_EQ(drawn.boxes()[i].level, expected.boxes()[i].level);
    }
    there->stop();
    here.stop();
  }
}

class WorkerHost : public ::testing::TestWithParam<Algorithm> {};

TEST_P(WorkerHost, AnswersAsInThisProcess) {
  for (const auto& [answer, name] : kAnswerKinds.entries) {
    SCOPED_TRACE(name);
    expectSameAnswers(makeCase(GetParam(), bestIsa(), 2, "", {}, answer));
  }
}

std::vector<Algorithm> algorithmsWithPairs() {
  std::vector<Algorithm> all = builtinAlgorithms();
  std::erase_if(all, [](const Algorithm& algorithm) { return !algorithm.traits.finds_pairs; });
  return all;
}

INSTANTIATE_TEST_SUITE_P(All, WorkerHost, ::testing::ValuesIn(algorithmsWithPairs()),
                         [](const auto& tested) {
                           std::string name = tested.param.id;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

TEST(WorkerProcess, TakesScenesOfAnySize) {
  const auto host = makeWorkerProcess(makeCase(builtinAlgorithms().front(), Isa::scalar, 1, "", {}),
                                      thisProgram());
  for (const std::size_t bodies : {0, 1, 2, 3000, 3}) {
    std::vector<Aabb> boxes;  // disjoint
    for (std::size_t i = 0; i < bodies; ++i) {
      const auto x = static_cast<float>(2 * i);
      boxes.push_back({{x, 0, 0, 0}, {x + 1, 1, 1, 0}});
    }
    host->start(sceneOf({boxes, boxes}), {0, boxes});
    EXPECT_EQ(host->step({1, boxes, std::span<const std::uint32_t>()}).pairs, 0U);
    EXPECT_TRUE(sorted(host->answer()).empty());
    host->stop();
  }
}

/// The error for a worker program that runs `script`.
std::string complaint(const std::string& script) {
  const std::vector<Aabb> boxes = {{{0, 0, 0, 0}, {1, 1, 1, 0}}};
  const auto host = makeWorkerProcess(
      makeCase(builtinAlgorithms().front(), Isa::scalar, 1, "", {}),
      {.command = {"/bin/sh", "-c", script}, .hard_limit = std::chrono::milliseconds(1)});
  return inputErrorOf([&] { host->start(sceneOf({boxes, boxes}), {0, boxes}); });
}

TEST(WorkerProcess, ADifferentProgramIsNamed) {
  // The hard limit does not include the start of the process.
  EXPECT_THAT(complaint("exit 7"), AllOf(HasSubstr("/bin/sh"), HasSubstr("status 7")));
  EXPECT_THAT(complaint("printf '{\"protocol\": 99}' >&3; cat <&3 >/dev/null"),
              AllOf(HasSubstr("/bin/sh"), HasSubstr("99"), HasSubstr("version")));
  const std::vector<Aabb> boxes = {{{0, 0, 0, 0}, {1, 1, 1, 0}}};
  const auto missing =
      makeWorkerProcess(makeCase(builtinAlgorithms().front(), Isa::scalar, 1, "", {}),
                        {.command = {"/no/such/program"}});
  EXPECT_THAT(inputErrorOf([&] { missing->start(sceneOf({boxes, boxes}), {0, boxes}); }),
              HasSubstr("/no/such/program"));
}

/// The error of a run with a worker program that sends a valid greeting and then runs `script`.
std::string ending(const std::string& script,
                   std::chrono::milliseconds limit = std::chrono::hours(1)) {
  const std::vector<Aabb> boxes = {{{0, 0, 0, 0}, {1, 1, 1, 0}}};
  CaseRun case_run(
      makeCase(builtinAlgorithms().front(), Isa::scalar, 1, "", {}), {},
      [&](const Case& test_case, CancelQuery) {
        return makeWorkerProcess(
            test_case,
            WorkerOptions{.command = {"/bin/sh", "-c",
                                      fmt::format("printf '{{\"protocol\": {}}}' >&3; {}",
                                                  worker::kProtocolVersion, script)},
                          .hard_limit = limit,
                          .begin_limit = limit});
      });
  EXPECT_FALSE(case_run.start(sceneOf({boxes, boxes}), {0, boxes}));
  EXPECT_NE(case_run.status(), Status::ok);
  return case_run.reason();
}

TEST(WorkerProcess, WhatDoesNotKeepToTheProtocolIsAnError) {
  EXPECT_THAT(ending("printf 'no JSON' >&3; cat <&3 >/dev/null"), HasSubstr("JSON"));
  // The answers to 'case', 'start' and 'stop'.
  EXPECT_THAT(ending("for i in 1 2 3; do printf '{}' >&3; done; cat <&3 >/dev/null"),
              HasSubstr("initialize_ns"));
  EXPECT_THAT(ending("cat <&3 >/dev/null", std::chrono::milliseconds(1)), HasSubstr("hard limit"));
  EXPECT_THAT(ending("kill -9 $$"), HasSubstr("SIGKILL"));
}

}  // namespace
}  // namespace broadmark::tests
