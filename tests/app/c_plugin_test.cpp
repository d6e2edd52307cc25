// Algorithms with the C interface: what is refused, and what reaches them.

#include "request/c_plugin.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "algorithms/runs.h"
#include "broadmark/error.h"

namespace broadmark::tests {
namespace {

using testing::HasSubstr;

/// What the functions of the table were given, and what they answer.
struct Instance {
  std::vector<double> parameters;
  std::int32_t events = 0;
  std::int32_t status = 0;
  broadmark_pair pair{0, 1};
} instance;

broadmark_algorithm table() {
  static const broadmark_parameter parameters[] = {{"cells", "a number", 4, 1, 10, 1},
                                                   {"margin", "a length", 0.5, 0, 1, 0}};
  broadmark_algorithm table{};
  table.id = "mine";
  table.family = "Mine";
  table.summary = "one pair";
  table.parameters = parameters;
  table.parameter_count = 2;
  table.margin = [](const double* values) { return static_cast<float>(values[1]); };
  table.create = [](const broadmark_scene* scene, const broadmark_frame*) -> void* {
    instance.parameters.assign(scene->parameters, scene->parameters + 2);
    instance.events = scene->events;
    return &instance;
  };
  table.destroy = [](void*) {};
  table.update_objects = [](void*, const broadmark_frame*) {};
  table.search_overlaps = [](void*, broadmark_answer* answer) {
    answer->pairs = {&instance.pair, 1};
    return instance.status;
  };
  table.error = [](void*) { return "no more"; };
  return table;
}

std::vector<Algorithm> load(const broadmark_algorithm& entry,
                            std::size_t size = sizeof(broadmark_algorithm),
                            std::uint32_t version = BROADMARK_PLUGIN_VERSION) {
  const broadmark_plugin plugin{version, 1, size, &entry};
  return algorithmsOf(&plugin, "mine.so");
}

void expectRefusal(const std::function<void()>& call, const std::string& words) {
  try {
    call();
    FAIL() << "not refused: " << words;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(words));
    EXPECT_THAT(error.what(), HasSubstr("mine.so"));
  }
}

TEST(CPlugin, WhatCannotWorkIsRefused) {
  expectRefusal([] { algorithmsOf(nullptr, "mine.so"); }, "returns null");
  expectRefusal([] { load(table(), sizeof(broadmark_algorithm), 0); }, "version 0");
  expectRefusal([] { load(table(), sizeof(broadmark_algorithm), 2); }, "supports up to 1");
  const broadmark_plugin empty{BROADMARK_PLUGIN_VERSION, 0, sizeof(broadmark_algorithm), nullptr};
  expectRefusal([&] { algorithmsOf(&empty, "mine.so"); }, "has no algorithms");
  broadmark_algorithm incomplete = table();
  incomplete.destroy = nullptr;
  expectRefusal([&] { load(incomplete); }, "'mine': create, destroy");
}

TEST(CPlugin, MembersThatAnOlderTableLacksAreNull) {
  const std::vector<Algorithm> algorithms = load(table(), offsetof(broadmark_algorithm, draw));
  ASSERT_EQ(algorithms.size(), 1U);
  instance = {.status = 1};
  TestRun run(algorithms.front(), {});
  try {
    const std::vector<std::vector<Aabb>> frames(2, std::vector<Aabb>(2));
    run.start(sceneOf(frames), frames[0]);
    run.step(frames[1]);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "search_overlaps failed");
  }
}

TEST(CPlugin, ParametersEventsAndErrorsArePassedOn) {
  broadmark_algorithm entry = table();
  entry.traits = BROADMARK_EVENTS;
  const Algorithm algorithm = load(entry).front();
  EXPECT_TRUE(algorithm.traits.events);
  const std::unique_ptr<BroadPhase> made = algorithm.create();
  setParameters(*made, {{"cells", "7"}, {"margin", "0.25"}});
  EXPECT_THROW(setParameters(*made, {{"cells", "7.5"}}), InputError);
  EXPECT_EQ(made->margin(), 0.25F);

  instance = {};
  made->reportEvents();
  ExecutionContext execution(1, Isa::scalar);
  const std::vector<Aabb> boxes(2);
  const std::vector<std::uint32_t> none;
  made->initialize({.objects = 2}, {0, boxes, none}, execution);
  EXPECT_EQ(instance.parameters, (std::vector<double>{7, 0.25}));
  EXPECT_EQ(instance.events, 1);
  EXPECT_EQ(pairCount(made->events().began), 1U) << "those of the initial pose";

  instance.status = 1;
  try {
    made->searchOverlaps();
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "search_overlaps failed: no more");
  }
}

}  // namespace
}  // namespace broadmark::tests
