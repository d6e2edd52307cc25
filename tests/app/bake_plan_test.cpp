// The inspector's batches: planning, starting, observing and cancelling, without output.

#include "bake/bake_plan.h"

#include <gmock/gmock.h>

#include <set>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/scenes/authored_simulation.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

class BatchOfBakes : public testing::Test {
 protected:
  BatchOfBakes() {
    std::string name = (fs::temp_directory_path() / "broadmark XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary directory");
    directory_ = name;
    options_.record = directory_ / "out";
    options_.sources = {"freefall", "brownian"};
    options_.scene.object_types = {"cubes", "spheres"};
    options_.scene.objects = {20, 30};
    options_.scene.parameters = {{"frames", "5"}};
    options_.scene.recorders = {"aabbs"};
  }
  ~BatchOfBakes() override { fs::remove_all(directory_); }

  /// Bakes to the end. Returns the number of finished recordings.
  std::size_t finish(BakePlan plan) {
    std::size_t ended = 0;
    bakeAll(
        std::move(plan.pending), 2, [&](const BakedJob&) { ++ended; },
        [&](const BatchState& state) {
          state_ = state;
          return !is_cancelled_ || state.done == 0;
        });
    return ended;
  }

  [[nodiscard]] std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(directory_)) {
      if (entry.is_regular_file()) names.insert(entry.path().filename());
    }
    return names;
  }

  fs::path directory_;
  BakeOptions options_;
  BatchState state_;           ///< the last reported state
  bool is_cancelled_ = false;  ///< whether to cancel at the first frame
};

TEST_F(BatchOfBakes, PlansBakesAndKeeps) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  auto plan = planBake(options_);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->recordings(), 8U);
  EXPECT_EQ(plan->bytes(), 4 * (2 * 304 + 32 * 6 * (20 + 30)));
  EXPECT_TRUE(files().empty()) << "planning writes nothing";
  prepare(*plan, options_.record);
  EXPECT_EQ(finish(std::move(*plan)), 8U);
  EXPECT_EQ(state_.done, state_.total);

  std::vector<std::uint64_t> numbers;
  plan = planBake(options_, [&](const fs::path&, std::uint64_t number, std::uint64_t total) {
    EXPECT_EQ(total, 8U);
    if (numbers.empty() || numbers.back() != number) numbers.push_back(number);
    return true;
  });
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->kept.size(), 8U);
  EXPECT_TRUE(plan->pending.empty());
  EXPECT_THAT(numbers, testing::ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
  EXPECT_EQ(testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr(), "");
}

TEST_F(BatchOfBakes, EveryValueMakesARecordingOfItsOwnName) {
  options_.sources = {"brownian"};
  options_.scene.object_types = {"cubes"};
  options_.scene.objects = {20};
  options_.scene.parameters["seed"] = "3,1";
  options_.parameters = {{"density", "0.10,0.05"}};
  const auto plan = planBake(options_);
  ASSERT_TRUE(plan);
  std::vector<std::string> names;
  for (const BakeJob& job : plan->pending) names.push_back(job.paths.front().filename());
  EXPECT_THAT(names, testing::ElementsAre("Brownian Cubes N20 F5frames density=0.05 seed=1.aabbs",
                                          "Brownian Cubes N20 F5frames density=0.05 seed=3.aabbs",
                                          "Brownian Cubes N20 F5frames density=0.1 seed=1.aabbs",
                                          "Brownian Cubes N20 F5frames density=0.1 seed=3.aabbs"));
}

TEST_F(BatchOfBakes, PlanningCanBeStopped) {
  auto plan = planBake(options_);
  prepare(*plan, options_.record);
  finish(std::move(*plan));
  EXPECT_FALSE(planBake(
      options_, [](const fs::path&, std::uint64_t number, std::uint64_t) { return number < 3; }));
}

TEST_F(BatchOfBakes, CancellingLeavesOnlyWholeRecordings) {
  options_.scene.parameters["frames"] = "20000";
  options_.scene.objects = {300};
  auto plan = planBake(options_);
  prepare(*plan, options_.record);
  is_cancelled_ = true;
  EXPECT_EQ(finish(std::move(*plan)), 0U);
  EXPECT_GT(state_.done, 0U);
  EXPECT_TRUE(files().empty());
}

TEST_F(BatchOfBakes, AuthoredScenesTakePart) {
  scenes::AuthoredScene scene{.name = "Mine", .parameters = {{"frames", "5"}}};
  scene.bodies.resize(2);
  writeTextFile(directory_ / "mine.json", scenes::formatAuthoredScene(scene));
  options_.sources.push_back(directory_ / "mine.json");
  EXPECT_THROW(planBake(options_), InputError) << "it has its own number of bodies";
  options_.scene.objects.clear();
  options_.scene.object_types.clear();
  const auto plan = planBake(options_);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->recordings(), 3U);
  EXPECT_EQ(plan->pending.back().scene.name, "Mine");
}

}  // namespace
}  // namespace broadmark
