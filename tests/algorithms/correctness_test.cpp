// What every listed algorithm must do, whoever wrote it: the right pairs, on easy and awkward
// inputs, for every number of bodies, instruction set and team size, frame after frame.

#include <gtest/gtest.h>

#include <list>

#include "algorithms/runs.h"

namespace broadmark::tests {
namespace {

constexpr std::uint32_t kFrames = 4;
constexpr std::size_t kCounts[] = {0, 1, 2, 3, 15, 16, 17, 31, 33, 100, 257, 1000};

/// The right pairs of each frame but the first, which is never searched.
std::vector<std::vector<Pair>> rightPairs(const std::vector<std::vector<Aabb>>& frames) {
  std::vector<std::vector<Pair>> right = {{}};
  for (std::size_t i = 1; i < frames.size(); ++i) right.push_back(bruteForcePairs(frames[i]));
  return right;
}

class EveryAlgorithm : public testing::TestWithParam<Algorithm> {
 protected:
  /// Runs all configurations over the frames and checks every answer. False if it cannot run here.
  void check(const std::string& input, const std::vector<std::vector<Aabb>>& frames) {
    const SceneInfo scene = sceneOf(frames);
    const std::vector<std::vector<Pair>> right = rightPairs(frames);
    for (Execution& execution : executions_) {
      SCOPED_TRACE(describe(GetParam(), {execution.isa(), execution.threads()}) + " on " + input +
                   ", n = " + std::to_string(scene.objects));
      try {
        if (GetParam().create()->capabilities().max_objects < scene.objects) continue;
        Instance run(GetParam(), execution, scene, frames[0]);
        for (std::uint32_t i = 1; i < frames.size(); ++i) {
          const PairRuns answer = run.step(frames[i]);
          const float margin = run.broadPhase().capabilities().margin;
          ASSERT_TRUE(isRight(answer, right[i], {i, frames[i]}, margin)) << "in frame " << i;
          ASSERT_EQ(run.broadPhase().validate(), "") << "in frame " << i;
        }
      } catch (const UnsupportedError& error) {
        GTEST_SKIP() << error.what();
      } catch (const std::exception& error) {
        FAIL() << error.what();
      }
    }
  }

  void SetUp() override {
    for (const Configuration& way : configurations(GetParam())) {
      executions_.emplace_back(way.threads, way.isa);
    }
  }

 private:
  std::list<Execution> executions_;
};

TEST_P(EveryAlgorithm, FindsExactlyTheRightPairs) {
  for (const inputs::Input& input : inputs::kAll) {
    for (const std::size_t n : kCounts) {
      check(std::string(input.name), framesOf(input, n, kFrames));
      if (HasFatalFailure() || IsSkipped()) return;
    }
  }
}

// Frame 1 has nothing to do with the initial pose, and every frame is of another kind.
TEST_P(EveryAlgorithm, CopesWithUnrelatedFrames) {
  constexpr std::size_t kCount = 300;
  std::vector<std::vector<Aabb>> frames;
  for (std::uint32_t i = 0; i < inputs::kAll.size(); ++i) {
    // 7 is coprime to the number of inputs: neighbours in the list do not follow each other.
    frames.push_back(inputs::kAll[i * 7 % inputs::kAll.size()].boxes(kCount, i, i));
  }
  check("unrelated frames", frames);
}

// The original's sweep and prune mixed up its bodies after the first frame: as many pairs as there
// should be, but the wrong ones.
TEST_P(EveryAlgorithm, KeepsBodiesApartOverManyFrames) {
  check("drifting", framesOf({"drifting", inputs::drifting}, 200, 60));
}

// The original's KD tree never reported pairs of bodies that did not move.
TEST_P(EveryAlgorithm, ReportsPairsThatNeverMove) {
  check("still", framesOf({"still", inputs::still}, 600, 5));
}

TEST_P(EveryAlgorithm, IsDescribed) {
  const Algorithm& algorithm = GetParam();
  for (const std::string& text : {algorithm.id, algorithm.family, algorithm.summary,
                                  algorithm.principle, algorithm.optimisations, algorithm.exactness,
                                  algorithm.time, algorithm.space, algorithm.source}) {
    EXPECT_NE(text, "");
  }
  EXPECT_EQ(algorithm.parallel, algorithm.id.ends_with("-mt") || algorithm.id.starts_with("gpu-") ||
                                    algorithm.id.starts_with("b3-"));
}

INSTANTIATE_TEST_SUITE_P(Algorithms, EveryAlgorithm, testing::ValuesIn(pairFinders()),
                         [](const auto& tested) { return testName(tested.param); });

}  // namespace
}  // namespace broadmark::tests
