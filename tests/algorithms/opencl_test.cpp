// What algorithms on a compute device promise beyond the right pairs: both ways to divide work,
// buffers that grow, transfers within the total, bounded threads, several instances at once, a
// reason where there is no device. Runs on the device that is there, PoCL included.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "algorithms/runs.h"
#include "broadmark/compute_devices.h"
#include "broadmark/harness/case_run.h"

namespace broadmark::tests {
namespace {

using testing::HasSubstr;

std::vector<Algorithm> onDevice(const std::string& prefix) {
  std::vector<Algorithm> chosen = pairFinders();
  std::erase_if(chosen, [&](const Algorithm& a) { return !a.id.starts_with(prefix); });
  return chosen;
}

std::vector<Algorithm> allOnDevice() {
  std::vector<Algorithm> all = onDevice("gpu-");
  std::ranges::move(onDevice("b3-"), std::back_inserter(all));
  return all;
}

/// Two threads: a device that is a processor is then divided, if it has more.
const Configuration kTwoThreads = {Isa::scalar, 2};

/// Whether the answers of all frames are right.
testing::AssertionResult findsAll(TestRun& run, const std::vector<std::vector<Aabb>>& frames) {
  run.start(sceneOf(frames), frames[0]);
  for (std::uint32_t i = 1; i < frames.size(); ++i) {
    auto right = isRight(run.step(frames[i]), rightPairs(frames[i]), {i, frames[i]});
    if (!right) return right << " in frame " << i;
  }
  return testing::AssertionSuccess();
}

class OnDevice : public testing::TestWithParam<Algorithm> {
 protected:
  void SetUp() override {
    if (computeDevices().empty()) GTEST_SKIP() << "no OpenCL device";
  }
};

TEST_P(OnDevice, TwentyThousandBodiesAreRight) {
  TestRun run(GetParam(), kTwoThreads);
  EXPECT_TRUE(findsAll(run, framesOf({"uniform", inputs::uniform}, 20'000, 3)));
  EXPECT_GT(pairCount(run.broadPhase().overlaps()), 1000U);
}

TEST_P(OnDevice, OneThreadFindsThemToo) {
  TestRun run(GetParam());
  for (const inputs::Input& input : inputs::kAll) {
    ASSERT_TRUE(findsAll(run, framesOf(input, 257, 3))) << input.name;
  }
}

TEST_P(OnDevice, PairBuffersGrow) {
  // Two million pairs of two thousand bodies, after a frame with few.
  std::vector<std::vector<Aabb>> frames = framesOf({"uniform", inputs::uniform}, 2000, 2);
  frames.push_back(inputs::identical(2000, 0, 0));
  frames.push_back(frames[1]);
  TestRun run(GetParam(), kTwoThreads);
  EXPECT_TRUE(findsAll(run, frames));
}

TEST_P(OnDevice, TransfersAreWithinTheTotal) {
  const auto frames = framesOf({"uniform", inputs::uniform}, 2000, 4);
  TestRun run(GetParam(), kTwoThreads);
  run.start(sceneOf(frames), frames[0]);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    run.step(frames[i]);
    EXPECT_GT(run.times()[Phase::upload], 0);
    EXPECT_GT(run.times()[Phase::download], 0);
    EXPECT_LE(run.times()[Phase::upload] + run.times()[Phase::download], run.times()[Phase::total]);
  }
}

TEST_P(OnDevice, TellsOnceHowLongItsKernelsTookToBuild) {
  const auto frames = framesOf({"uniform", inputs::uniform}, 100, 2);
  TestRun run(GetParam(), kTwoThreads);
  run.start(frames[0]).step(frames[1]);
  Counters setup;
  run.broadPhase().visitSetup(
      [&](std::string_view name, std::uint64_t count) { setup.emplace(name, count); });
  EXPECT_GT(setup["kernel_build_ns"], 0U);
  EXPECT_EQ(countersOf(run.broadPhase()).count("kernel_build_ns"), 0U);
}

// Bullet's grids share global kernels: each must run with its own, made for its own context.
TEST_P(OnDevice, InstancesThatTakeTurnsAreRight) {
  const auto some = framesOf({"clustered", inputs::clustered}, 300, 5);
  const auto others = framesOf({"uniform", inputs::uniform}, 700, 5);
  TestRun a(GetParam(), kTwoThreads);
  a.start(sceneOf(some), some[0]);
  {
    TestRun b(GetParam());
    b.start(sceneOf(others), others[0]);
    for (std::uint32_t i = 1; i < 4; ++i) {
      EXPECT_TRUE(isRight(a.step(some[i]), rightPairs(some[i]), {i, some[i]}));
      EXPECT_TRUE(isRight(b.step(others[i]), rightPairs(others[i]), {i, others[i]}));
    }
  }
  // When the other is gone, kernels and all.
  EXPECT_TRUE(isRight(a.step(some[4]), rightPairs(some[4]), {4, some[4]}));
}

TEST_P(OnDevice, AnUnknownDeviceIsUnsupported) {
  const auto frames = framesOf({"uniform", inputs::uniform}, 10, 1);
  CaseRun run(makeCase(GetParam(), Isa::scalar, 1, "no such device", {}));
  EXPECT_FALSE(run.start(sceneOf(frames), {0, frames[0]}));
  EXPECT_EQ(run.status(), Status::unsupported);
  EXPECT_THAT(run.reason(), HasSubstr("no such device"));
}

INSTANTIATE_TEST_SUITE_P(Algorithms, OnDevice, testing::ValuesIn(allOnDevice()),
                         [](const auto& tested) { return testName(tested.param); });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(OnDevice);

/// Our own kernels, on either kind of device.
class OwnKernels : public OnDevice {};

TEST_P(OwnKernels, BothWaysGiveTheRightPairs) {
  for (const char* way : {"cpu", "gpu"}) {
    TestRun run(GetParam(), kTwoThreads, {{"work_division", way}});
    for (const inputs::Input& input : inputs::kAll) {
      for (const std::size_t n : {2, 127, 128, 129, 513, 1000}) {
        ASSERT_TRUE(findsAll(run, framesOf(input, n, 3)))
            << "on " << input.name << ", n = " << n << ", way " << way;
      }
    }
  }
}

TEST_P(OwnKernels, DrawCellsOrNodesRoundEveryBodyOrTheAxis) {
  const auto frames = framesOf({"assorted", inputs::assorted}, 500, 3);
  TestRun run(GetParam(), kTwoThreads);
  ASSERT_TRUE(findsAll(run, frames));
  const RecordedDrawing drawn = drawingOf(run.broadPhase());
  if (drawn.lines().size() == 1 && drawn.boxes().empty()) return;  // the axis of a sweep
  EXPECT_GT(drawn.boxes().size(), 10U);
  for (const Aabb& body : frames[2]) {
    EXPECT_TRUE(std::ranges::any_of(
        drawn.boxes(), [&](const RecordedDrawing::Box& b) { return overlaps(b.box, body); }));
  }
}

// Little enough for an interpreter that watches each access to memory.
TEST_P(OwnKernels, FewBodiesAreRight) {
  for (const char* way : {"cpu", "gpu"}) {
    TestRun run(GetParam(), kTwoThreads, {{"work_division", way}});
    for (const std::size_t n : {2, 65, 130}) {
      ASSERT_TRUE(findsAll(run, framesOf({"few", inputs::uniform}, n, 2)))
          << "n = " << n << ", way " << way;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Algorithms, OwnKernels, testing::ValuesIn(onDevice("gpu-")),
                         [](const auto& tested) { return testName(tested.param); });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(OwnKernels);

TEST(BulletSap, RefusesWhatItsSortCannotHold) {
  const std::vector<Algorithm> found = onDevice("b3-sap");
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.front().traits.max_objects, 524'287U);
}

std::vector<ComputeDevice> threeDevices() {
  return {{.name = "Big GPU", .platform = "Vendor A", .gpu = true},
          {.name = "Small GPU", .platform = "Vendor B", .gpu = true},
          {.name = "Processor", .platform = "PoCL", .units = 2}};
}

TEST(ChooseDevice, ByNumberOrPartOfNameOrPlatform) {
  EXPECT_EQ(chooseDevice(threeDevices(), ""), 0U);
  EXPECT_EQ(chooseDevice(threeDevices(), "1"), 1U);
  EXPECT_EQ(chooseDevice(threeDevices(), "small"), 1U);
  EXPECT_EQ(chooseDevice(threeDevices(), "pocl"), 2U);
}

TEST(ChooseDevice, UnknownNamesListWhatThereIs) {
  for (const std::string wanted : {"3", "-1", "nothing"}) {
    try {
      chooseDevice(threeDevices(), wanted);
      FAIL() << wanted;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("'" + wanted + "'"));
      EXPECT_THAT(error.what(), HasSubstr("1: Small GPU"));
    }
  }
  EXPECT_THROW(chooseDevice({}, ""), InputError);
}

TEST(ComputeDevices, GpusComeFirst) {
  const std::vector<ComputeDevice> devices = computeDevices();
  EXPECT_TRUE(std::ranges::is_partitioned(devices, &ComputeDevice::gpu));
  for (const ComputeDevice& device : devices) {
    EXPECT_THAT(describe(device), HasSubstr(device.name));
    EXPECT_GT(device.units, 0);
    EXPECT_GT(device.memory_bytes, 0U);
  }
}

}  // namespace
}  // namespace broadmark::tests
