// Algorithms on a compute device, beyond the right pairs: both work divisions, buffers that grow,
// transfers within the total, bounded threads, several instances at once, a reason if there is no
// device. Runs on any available device, PoCL included.

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

/// Two threads: a CPU device with more threads is then partitioned.
const Configuration kTwoThreads = {Isa::scalar, 2};

/// Whether the answers of all frames are right.
testing::AssertionResult findsAll(TestRun& test_run, const std::vector<std::vector<Aabb>>& frames) {
  test_run.start(sceneOf(frames), frames[0]);
  for (std::uint32_t i = 1; i < frames.size(); ++i) {
    auto right = isRight(test_run.step(frames[i]), rightPairs(frames[i]), {i, frames[i]});
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
  TestRun test_run(GetParam(), kTwoThreads);
  EXPECT_TRUE(findsAll(test_run, framesOf({"uniform", inputs::uniform}, 20'000, 3)));
  EXPECT_GT(pairCount(test_run.broadPhase().overlaps()), 1000U);
}

TEST_P(OnDevice, OneThreadFindsThemToo) {
  TestRun test_run(GetParam());
  for (const inputs::Input& input : inputs::kAll) {
    ASSERT_TRUE(findsAll(test_run, framesOf(input, 257, 3))) << input.name;
  }
}

TEST_P(OnDevice, PairBuffersGrow) {
  // Two million pairs of two thousand bodies, after a frame with few.
  std::vector<std::vector<Aabb>> frames = framesOf({"uniform", inputs::uniform}, 2000, 2);
  frames.push_back(inputs::identical(2000, 0, 0));
  frames.push_back(frames[1]);
  TestRun test_run(GetParam(), kTwoThreads);
  EXPECT_TRUE(findsAll(test_run, frames));
}

TEST_P(OnDevice, TransfersAreWithinTheTotal) {
  const auto frames = framesOf({"uniform", inputs::uniform}, 2000, 4);
  TestRun test_run(GetParam(), kTwoThreads);
  test_run.start(sceneOf(frames), frames[0]);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    test_run.step(frames[i]);
    EXPECT_GT(test_run.times()[Phase::upload], 0);
    EXPECT_GT(test_run.times()[Phase::download], 0);
    EXPECT_LE(test_run.times()[Phase::upload] + test_run.times()[Phase::download],
              test_run.times()[Phase::total]);
  }
}

TEST_P(OnDevice, TellsOnceHowLongItsKernelsTookToBuild) {
  const auto frames = framesOf({"uniform", inputs::uniform}, 100, 2);
  TestRun test_run(GetParam(), kTwoThreads);
  test_run.start(frames[0]).step(frames[1]);
  Counters setup;
  test_run.broadPhase().visitSetup(
      [&](std::string_view name, std::uint64_t count) { setup.emplace(name, count); });
  EXPECT_GT(setup["kernel_build_ns"], 0U);
  EXPECT_EQ(countersOf(test_run.broadPhase()).count("kernel_build_ns"), 0U);
}

// Bullet's grids share global kernels: each must use kernels of its own context.
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
  // After the other instance and its kernels have been destroyed.
  EXPECT_TRUE(isRight(a.step(some[4]), rightPairs(some[4]), {4, some[4]}));
}

TEST_P(OnDevice, AnUnknownDeviceIsUnsupported) {
  const auto frames = framesOf({"uniform", inputs::uniform}, 10, 1);
  CaseRun case_run(makeCase(GetParam(), Isa::scalar, 1, "no such device", {}));
  EXPECT_FALSE(case_run.start(sceneOf(frames), {0, frames[0]}));
  EXPECT_EQ(case_run.status(), Status::unsupported);
  EXPECT_THAT(case_run.reason(), HasSubstr("no such device"));
}

INSTANTIATE_TEST_SUITE_P(Algorithms, OnDevice, testing::ValuesIn(allOnDevice()),
                         [](const auto& tested) { return testName(tested.param); });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(OnDevice);

/// The project's own kernels, on either kind of device.
class OwnKernels : public OnDevice {};

TEST_P(OwnKernels, BothWaysGiveTheRightPairs) {
  for (const char* work_division : {"cpu", "gpu"}) {
    TestRun test_run(GetParam(), kTwoThreads, {{"work_division", work_division}});
    for (const inputs::Input& input : inputs::kAll) {
      for (const std::size_t n : {2, 127, 128, 129, 513, 1000}) {
        ASSERT_TRUE(findsAll(test_run, framesOf(input, n, 3)))
            << "on " << input.name << ", n = " << n << ", work_division " << work_division;
      }
    }
  }
}

TEST_P(OwnKernels, DrawCellsOrNodesRoundEveryBodyOrTheAxis) {
  const auto frames = framesOf({"assorted", inputs::assorted}, 500, 3);
  TestRun test_run(GetParam(), kTwoThreads);
  ASSERT_TRUE(findsAll(test_run, frames));
  const RecordedDrawing drawn = drawingOf(test_run.broadPhase());
  if (drawn.lines().size() == 1 && drawn.boxes().empty()) return;  // the axis of a sweep
  EXPECT_GT(drawn.boxes().size(), 10U);
  for (const Aabb& body : frames[2]) {
    EXPECT_TRUE(std::ranges::any_of(
        drawn.boxes(), [&](const RecordedDrawing::Box& b) { return overlaps(b.box, body); }));
  }
}

// Little enough for an interpreter that checks all memory accesses.
TEST_P(OwnKernels, FewBodiesAreRight) {
  for (const char* work_division : {"cpu", "gpu"}) {
    TestRun test_run(GetParam(), kTwoThreads, {{"work_division", work_division}});
    for (const std::size_t n : {2, 65, 130}) {
      ASSERT_TRUE(findsAll(test_run, framesOf({"few", inputs::uniform}, n, 2)))
          << "n = " << n << ", work_division " << work_division;
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
