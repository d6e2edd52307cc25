// CGAL's box intersection: independence of its parameter, and its limits.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "algorithms/runs.h"

namespace broadmark::tests {
namespace {

class Cgal : public testing::Test {
 protected:
  void SetUp() override {
    const std::vector<Algorithm> all = builtinAlgorithms();
    const auto found = std::ranges::find(all, "cgal", &Algorithm::id);
    ASSERT_NE(found, all.end());
    algorithm_ = *found;
  }

  /// The pairs of a frame.
  std::vector<Pair> pairsOf(const std::vector<Aabb>& boxes, const ParameterValues& values = {}) {
    return sorted(TestRun(algorithm_, {}, values).start(boxes).step(boxes));
  }

  Algorithm algorithm_;
};

TEST_F(Cgal, HasTheLibrarysCutoffByDefault) {
  EXPECT_EQ(parameterValues(*algorithm_.create()), (ParameterValues{{"cutoff", "10"}}));
}

TEST_F(Cgal, FindsTheSamePairsWhateverTheCutoff) {
  for (const inputs::Input& input : inputs::kAll) {
    const std::vector<Aabb> boxes = input.boxes(500, 1, 1);
    const std::vector<Pair> right = bruteForcePairs(boxes);
    for (const char* cutoff : {"1", "2", "10", "100", "1000000000"}) {
      EXPECT_EQ(pairsOf(boxes, {{"cutoff", cutoff}}), right) << input.name << ", " << cutoff;
    }
  }
}

// A segment of the library's tree is open at its upper end; the last segment ends at that float.
TEST_F(Cgal, RefusesBoxesThatBeginAtTheLargestFloat) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<Aabb> boxes = inputs::clustered(100, 1, 1);
    for (Aabb& box : boxes) box.max[axis] = kLargest;
    for (std::size_t i = 0; i < 75; ++i) boxes[i].min[axis] = std::nextafter(kLargest, 0.0F);
    EXPECT_EQ(pairsOf(boxes), bruteForcePairs(boxes));
    for (std::size_t i = 0; i < 75; ++i) boxes[i].min[axis] = kLargest;
    EXPECT_THROW(pairsOf(boxes), UnsupportedError);
  }
}

}  // namespace
}  // namespace broadmark::tests
