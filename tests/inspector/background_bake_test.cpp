// Baking in the background.
#include "inspector/jobs/background_bake.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <future>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "engine/helpers.h"

namespace broadmark::tests {
namespace {

using Outcome = BakeOutcome;

class BackgroundBakeTest : public testing::Test {
 protected:
  BakeOptions options(std::vector<std::uint32_t> objects, int frames) const {
    BakeOptions options;
    options.sources = {"freefall"};
    options.scene = {.objects = std::move(objects),
                     .object_types = {"cubes"},
                     .parameters = {{"frames", std::to_string(frames)}},
                     .recorders = {"aabbs"}};
    options.record = directory / "baked";
    options.threads = 2;
    return options;
  }

  BackgroundBake::Report wait() {
    bake.wait();
    EXPECT_TRUE(bake.consumeFinished());
    EXPECT_FALSE(bake.consumeFinished());
    return bake.report();
  }

  TemporaryDirectory directory;
  BackgroundBake bake;
};

TEST_F(BackgroundBakeTest, BakesAndThenKeepsWhatIsThere) {
  EXPECT_EQ(bake.report().state, TaskState::idle);
  startBake(bake, options({20, 30}, 5));
  BackgroundBake::Report report = wait();
  EXPECT_EQ(report.state, TaskState::done);
  ASSERT_EQ(report.items.size(), 2U);
  for (const auto& item : report.items) {
    EXPECT_EQ(item.outcome, Outcome::baked) << item.failure;
    EXPECT_EQ(openRecordingFile(item.path)->scene().frames, 5U);
  }
  startBake(bake, options({20, 30, 40}, 5));
  report = wait();
  EXPECT_EQ(report.count(Outcome::kept), 2U);
  EXPECT_EQ(report.count(Outcome::baked), 1U);
  EXPECT_THAT(report.text(),
              testing::AllOf(testing::HasSubstr("1 baked"), testing::HasSubstr("2 kept")));
}

TEST_F(BackgroundBakeTest, CancelledItLeavesNothingHalfDone) {
  std::promise<void> planned;
  startBake(bake, options({3000}, 10'000), [&](auto simulation, const CancelQuery&) {
    planned.set_value();
    return simulation;
  });
  planned.get_future().wait();
  EXPECT_THROW(startBake(bake, options({20}, 5)), InputError);
  bake.cancel();
  const BackgroundBake::Report report = wait();
  EXPECT_EQ(report.state, TaskState::cancelled);
  EXPECT_EQ(report.count(Outcome::waiting), 1U);
  EXPECT_FALSE(std::filesystem::exists(report.items.front().path));
  startBake(bake, options({20}, 5));  // a cancelled bake can be restarted
  EXPECT_EQ(wait().state, TaskState::done);
}

TEST_F(BackgroundBakeTest, EndsWithItsOwner) {
  BackgroundBake another;
  startBake(another, options({3000}, 10'000));
}

TEST_F(BackgroundBakeTest, WhatCannotBeWrittenIsAFailure) {
  writeTextFile(directory / "baked", "a file where the directory should be");
  startBake(bake, options({20}, 5));
  const BackgroundBake::Report report = wait();
  EXPECT_EQ(report.state, TaskState::failed);
  EXPECT_THAT(report.failure, testing::HasSubstr("baked"));
}

}  // namespace
}  // namespace broadmark::tests
