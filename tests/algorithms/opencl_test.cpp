// What algorithms on a compute device promise beyond the right pairs: both ways to divide work,
// buffers that grow, transfers within the total, bounded threads, clear words where there is no
// device. Runs on whatever device there is, PoCL among them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadmark/compute_devices.h"
#include "broadmark/runner.h"
#include "algorithms/runs.h"

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

/// Whether the answers of all frames are right.
testing::AssertionResult findsAll(const Algorithm& algorithm, Execution& execution,
                                  const std::vector<std::vector<Aabb>>& frames,
                                  const ParameterValues& parameters = {}) {
  Instance run(algorithm, execution, sceneOf(frames), frames[0], parameters);
  for (std::uint32_t i = 1; i < frames.size(); ++i) {
    const PairRuns answer = run.step(frames[i]);
    auto right = isRight(answer, bruteForcePairs(frames[i]), {i, frames[i]}, 0);
    if (!right) return right << " in frame " << i;
  }
  return testing::AssertionSuccess();
}

/// A slow machine fails no test.
const RunOptions kPatient = {.frame_limit_seconds = 1e6, .initialize_limit_seconds = 1e6};

class OnDevice : public testing::TestWithParam<Algorithm> {
 protected:
  void SetUp() override {
    if (computeDevices().empty()) GTEST_SKIP() << "no OpenCL device";
  }
};

/// Frames as a source, in memory.
class Frames final : public FrameSource {
 public:
  explicit Frames(std::vector<std::vector<Aabb>> frames)
      : frames_(std::move(frames)), scene_(sceneOf(frames_)) {}
  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }
  Frame rewind() override {
    index_ = 0;
    return {0, frames_[0]};
  }
  std::optional<Frame> next() override {
    if (index_ + 1 == frames_.size()) return {};
    ++index_;
    return Frame{index_, frames_[index_]};
  }

 private:
  std::vector<std::vector<Aabb>> frames_;
  SceneInfo scene_;
  std::uint32_t index_ = 0;
};

TEST_P(OnDevice, TwentyThousandBodiesAreRight) {
  Frames frames(framesOf({"uniform", inputs::uniform}, 20'000, 3));
  const CaseResult result = runCase({.algorithm = GetParam(), .threads = 2}, frames, kPatient);
  EXPECT_EQ(result.status, Status::ok) << result.reason;
  EXPECT_GT(result.pairs_mean, 1000);
}

TEST_P(OnDevice, OneThreadFindsThemToo) {
  Execution execution(1, Isa::scalar);
  for (const inputs::Input& input : inputs::kAll) {
    ASSERT_TRUE(findsAll(GetParam(), execution, framesOf(input, 257, 3))) << input.name;
  }
}

TEST_P(OnDevice, PairBuffersGrow) {
  // Two million pairs of two thousand bodies, after a frame with none.
  std::vector<std::vector<Aabb>> frames = framesOf({"uniform", inputs::uniform}, 2000, 2);
  frames.push_back(inputs::identical(2000, 0, 0));
  frames.push_back(frames[1]);
  Frames source(frames);
  const CaseResult result = runCase({.algorithm = GetParam(), .threads = 2}, source, kPatient);
  EXPECT_EQ(result.status, Status::ok) << result.reason;
  EXPECT_EQ(result.pairs_max, 2000U * 1999 / 2);
}

TEST_P(OnDevice, TransfersAreWithinTheTotal) {
  Frames frames(framesOf({"uniform", inputs::uniform}, 2000, 4));
  const CaseResult result = runCase({.algorithm = GetParam(), .threads = 2}, frames, kPatient);
  ASSERT_EQ(result.status, Status::ok) << result.reason;
  for (const FrameTimes& times : result.repetitions.at(0).frames) {
    EXPECT_GT(times[Phase::upload], 0);
    EXPECT_GT(times[Phase::download], 0);
    EXPECT_LE(times[Phase::upload] + times[Phase::download], times[Phase::total]);
  }
  EXPECT_GT(result.counters.at("kernel_build_ns"), 0);
}

TEST_P(OnDevice, AnUnknownDeviceIsUnsupported) {
  Frames frames(framesOf({"uniform", inputs::uniform}, 10, 2));
  const CaseResult result =
      runCase({.algorithm = GetParam(), .threads = 1, .device = "no such device"}, frames);
  EXPECT_EQ(result.status, Status::unsupported);
  EXPECT_THAT(result.reason, HasSubstr("no such device"));
}

INSTANTIATE_TEST_SUITE_P(Algorithms, OnDevice, testing::ValuesIn(allOnDevice()),
                         [](const auto& tested) { return testName(tested.param); });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(OnDevice);

/// Our own kernels, on either kind of device.
class OwnKernels : public OnDevice {};

TEST_P(OwnKernels, BothWaysGiveTheRightPairs) {
  Execution execution(2, Isa::scalar);
  for (const inputs::Input& input : inputs::kAll) {
    for (const std::size_t n : {2, 127, 128, 129, 513, 1000}) {
      const std::vector<std::vector<Aabb>> frames = framesOf(input, n, 3);
      for (const char* way : {"cpu", "gpu"}) {
        ASSERT_TRUE(findsAll(GetParam(), execution, frames, {{"way", way}}))
            << "on " << input.name << ", n = " << n << ", way " << way;
      }
    }
  }
}

class Drawn final : public DebugDraw {
 public:
  void box(const Aabb& box, Rgb, int) override { boxes.push_back(box); }
  void line(const std::array<float, 3>&, const std::array<float, 3>&, Rgb) override { ++lines; }
  std::vector<Aabb> boxes;
  int lines = 0;
};

TEST_P(OwnKernels, DrawCellsOrNodesRoundEveryBodyOrTheAxis) {
  Execution execution(2, Isa::scalar);
  const auto frames = framesOf({"assorted", inputs::assorted}, 500, 3);
  Instance run(GetParam(), execution, sceneOf(frames), frames[0]);
  run.step(frames[1]);
  run.step(frames[2]);
  Drawn drawn;
  run.broadPhase().drawStructure(drawn);
  if (drawn.lines == 1 && drawn.boxes.empty()) return;  // the axis of a sweep
  EXPECT_GT(drawn.boxes.size(), 10U);
  for (const Aabb& body : frames[2]) {
    EXPECT_TRUE(std::ranges::any_of(drawn.boxes, [&](const Aabb& b) { return overlaps(b, body); }));
  }
}

// Little enough for an interpreter that watches each access to memory.
TEST_P(OwnKernels, FewBodiesAreRight) {
  Execution execution(2, Isa::scalar);
  for (const std::size_t n : {2, 65, 130}) {
    const std::vector<std::vector<Aabb>> frames = framesOf({"few", inputs::uniform}, n, 2);
    for (const char* way : {"cpu", "gpu"}) {
      ASSERT_TRUE(findsAll(GetParam(), execution, frames, {{"way", way}}))
          << "n = " << n << ", way " << way;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Algorithms, OwnKernels, testing::ValuesIn(onDevice("gpu-")),
                         [](const auto& tested) { return testName(tested.param); });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(OwnKernels);

TEST(BulletSap, RefusesWhatItsSortCannotHold) {
  const std::vector<Algorithm> found = onDevice("b3-sap");
  if (found.empty()) GTEST_SKIP() << "built without OpenCL";
  EXPECT_EQ(found.front().create()->capabilities().max_objects, 524'287U);
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
