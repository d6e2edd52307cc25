// Third-party libraries as algorithms, on inputs critical for their arithmetic and bookkeeping.

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "algorithms/runs.h"

namespace broadmark::tests {
namespace {

/// The algorithms of third-party libraries in this build.
std::vector<Algorithm> rivals() {
  std::vector<Algorithm> algorithms = pairFinders();
  std::erase_if(algorithms, [](const Algorithm& algorithm) {
    const auto is_from = [&](const char* library) { return algorithm.family.starts_with(library); };
    return !is_from("Embree") && !is_from("Boost") && !is_from("FCL") && !is_from("ODE");
  });
  return algorithms;
}

/// Checks all configurations on the frames.
void check(const Algorithm& algorithm, const std::vector<std::vector<Aabb>>& frames) {
  for (const Configuration& config : configurations(algorithm)) {
    SCOPED_TRACE(describe(algorithm, config));
    TestRun test_run(algorithm, config);
    test_run.start(sceneOf(frames), frames[0]);
    for (std::uint32_t i = 1; i < frames.size(); ++i) {
      ASSERT_TRUE(isRight(test_run.step(frames[i]), rightPairs(frames[i]), {i, frames[i]}))
          << "in frame " << i;
    }
  }
}

class Rivals : public testing::TestWithParam<Algorithm> {};

TEST_P(Rivals, CopeWithTheLimitsOfFloats) {
  check(GetParam(), framesOf({"limits", inputs::limits}, 200, 4));
}

// Sizes and positions around the smallest normal number.
TEST_P(Rivals, TellSmallestNumbersApart) {
  constexpr float kStep = std::numeric_limits<float>::min() / 8;
  constexpr std::size_t kMany = 500;
  const std::vector<Aabb> boxes = inputs::generate(kMany, 0, 1, [](inputs::Random& random, auto) {
    inputs::Vec3 corner;
    for (float& x : corner) x = kStep * static_cast<float>(random.integer(-20, 20));
    return inputs::boxAt(corner, {2 * kStep, kStep, kStep});
  });
  check(GetParam(), {boxes, boxes});
}

// A body moves by less than the precision of a double at its distance from the origin.
TEST_P(Rivals, SeeSmallMovesFarAway) {
  constexpr float kFar = 1e20F;
  const auto boxes = [](float x) {
    return std::vector<Aabb>{{{x, kFar, 0, 0}, {1, kFar, 1, 0}},
                             {{-1, kFar, 0, 0}, {0, kFar, 1, 0}}};
  };
  check(GetParam(), {boxes(1e-3F), boxes(0), boxes(1e-3F), boxes(0)});
}

// Bookkeeping errors that accumulate, such as wrong leaves of bodies.
TEST_P(Rivals, FollowTheFewThatMoveForLong) {
  constexpr std::size_t kMany = 500;
  std::vector<std::vector<Aabb>> frames = {inputs::clustered(kMany, 0, 1)};
  for (std::uint32_t frame = 1; frame < 60; ++frame) {
    frames.push_back(frames.back());
    const std::vector<Aabb> elsewhere = inputs::clustered(kMany, frame, 1);
    for (std::size_t i = frame % 7; i < kMany; i += 7) frames.back()[i] = elsewhere[i];
  }
  check(GetParam(), frames);
}

INSTANTIATE_TEST_SUITE_P(Algorithms, Rivals, testing::ValuesIn(rivals()),
                         [](const auto& tested) { return testName(tested.param); });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Rivals);  // builds without these libraries

}  // namespace
}  // namespace broadmark::tests
