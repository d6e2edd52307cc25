// Components of brute force and sweep and prune.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "algorithms/runs.h"
#include "radix_sort.h"
#include "simd/overlap_kernels.h"
#include "simd/sweep_kernels.h"

namespace broadmark::tests {
namespace {

TEST(SortKey, OrdersAsFloatsDo) {
  using Limits = std::numeric_limits<float>;
  const float ascending[] = {-Limits::infinity(),  Limits::lowest(),      -1.5F, -1.0F,
                             -Limits::min(),       -Limits::denorm_min(), -0.0F, 0.0F,
                             Limits::denorm_min(), Limits::min(),         1.0F,  1.5F,
                             Limits::max(),        Limits::infinity()};
  for (std::size_t i = 1; i < std::size(ascending); ++i) {
    EXPECT_LT(sortKey(ascending[i - 1]), sortKey(ascending[i])) << ascending[i];
  }
}

TEST(RadixSort, SortsStablyWhateverTheTeam) {
  for (const int threads : {1, 2, 3, 5}) {
    ThreadTeam team(threads);
    RadixSorter sorter;
    for (const std::size_t count : {0, 1, 2, 4, 1000, 4099}) {
      for (const std::uint32_t mask : {0U, 7U, 0x00F0'0000U, 0xFFFF'FFFFU}) {
        sorter.resize(count, threads);
        inputs::Random random(count, mask);
        for (std::uint32_t i = 0; SortEntry & entry : sorter.entries()) {
          const auto key = static_cast<std::uint32_t>(random.integer(0, 0x7FFF'FFFE)) * 2U;
          entry = {key & mask, i++};
        }
        std::vector<SortEntry> expected(sorter.entries().begin(), sorter.entries().end());
        std::ranges::stable_sort(expected, {}, &SortEntry::key);
        sorter.sort(team);
        EXPECT_TRUE(
            std::ranges::equal(sorter.entries(), expected,
                               [](auto& a, auto& b) { return a.key == b.key && a.body == b.body; }))
            << count << " entries, " << threads << " threads";
      }
    }
  }
}

// A kernel may load whole vectors, but must report only pairs in its ranges.
TEST(OverlapKernels, TileReportsItsOwnPairsOnly) {
  constexpr std::size_t kCount = 70;
  const std::vector<Aabb> boxes = inputs::identical(kCount, 0, 0);
  BoxArrays arrays;
  arrays.assign(boxes);
  for (const auto& [isa, name] : kIsas.entries) {
    if (!isaSupported(isa)) continue;
    for (const Range rows : {Range{0, 70}, {0, 0}, {3, 4}, {5, 16}, {17, 39}, {69, 70}}) {
      for (const Range columns : {Range{0, 70}, {0, 0}, {1, 2}, {15, 33}, {20, 25}, {68, 70}}) {
        std::vector<Pair> expected;
        for (auto i = static_cast<std::uint32_t>(rows.begin); i < rows.end; ++i) {
          for (std::uint32_t j = i + 1; j < kCount; ++j) {
            if (j >= columns.begin && j < columns.end) expected.push_back({i, j});
          }
        }
        PairBuffer found;
        overlapKernels(isa).test_tile(arrays, rows, columns, found);
        const PairRun pair_run = found.run();
        EXPECT_EQ(sorted({&pair_run, 1}), expected)
            << name << " rows " << rows.begin << "–" << rows.end << " columns " << columns.begin
            << "–" << columns.end;
      }
    }
  }
}

// Windows of any length from any row on: several rows are swept at once, then one by one beyond
// their common part; no pair may be missed or reported by both.
TEST(SweepKernels, SweepReportsEveryWindowOnce) {
  constexpr std::size_t kCount = 90;
  BoxArrays arrays;
  arrays.assign(inputs::identical(kCount, 0, 0));
  inputs::Random random(5, 0);
  for (int round = 0; round < 50; ++round) {
    std::vector<std::uint32_t> ends;
    std::vector<std::uint32_t> bodies;
    for (std::uint32_t i = 0; i < kCount; ++i) {
      const int longest = static_cast<int>(kCount - i);
      ends.push_back(i + static_cast<std::uint32_t>(random.integer(1, longest)));
      bodies.push_back(1000 - i);
    }
    const auto begin = static_cast<std::size_t>(random.integer(0, 20));
    const Range rows = {begin, begin + static_cast<std::size_t>(random.integer(0, 70))};
    std::vector<Pair> expected;
    for (std::size_t i = rows.begin; i < rows.end; ++i) {
      for (std::size_t j = i + 1; j < ends[i]; ++j) {
        expected.push_back(orderedPair(bodies[i], bodies[j]));
      }
    }
    std::ranges::sort(expected);
    for (const auto& [isa, name] : kIsas.entries) {
      if (!isaSupported(isa)) continue;
      PairBuffer found;
      sweepKernels(isa).sweep(arrays, ends.data(), bodies.data(), rows, found);
      const PairRun pair_run = found.run();
      EXPECT_EQ(sorted({&pair_run, 1}), expected) << name << " rows from " << rows.begin;
    }
  }
}

// Values that no recording contains: their sums and differences overflow, only comparisons work.
TEST(BruteForceAndSweep, SurviveTheLimitsOfFloats) {
  const auto frames = framesOf({"limits", inputs::limits}, 300, 4);
  const SceneInfo scene = sceneOf(frames);
  for (const Algorithm& algorithm : pairFinders()) {
    if (algorithm.family != "BF" && algorithm.family != "SAP") continue;
    for (const Configuration& config : configurations(algorithm)) {
      TestRun test_run(algorithm, config);
      test_run.start(scene, frames[0]);
      for (std::size_t i = 1; i < frames.size(); ++i) {
        EXPECT_EQ(sorted(test_run.step(frames[i])), bruteForcePairs(frames[i]))
            << describe(algorithm, config);
      }
    }
  }
}

TEST(SweepAndPrune, SweepsAlongTheAxisOfLargestVariance) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<std::vector<Aabb>> frames;
    for (std::uint32_t i = 0; i < 2; ++i) {
      frames.push_back(inputs::uniform(100, i, 3));
      for (Aabb& box : frames.back()) {
        box.min[axis] *= 10;
        box.max[axis] *= 10;
      }
    }
    for (const Algorithm& algorithm : pairFinders()) {
      if (algorithm.family != "SAP") continue;
      TestRun test_run(algorithm);
      test_run.start(sceneOf(frames), frames[0]).step(frames[1]);
      const RecordedDrawing drawn = drawingOf(test_run.broadPhase());
      ASSERT_EQ(drawn.lines().size(), 1U);
      for (std::size_t other = 0; other < 3; ++other) {
        const float length = drawn.lines()[0].to[other] - drawn.lines()[0].from[other];
        EXPECT_EQ(length > 0, other == axis) << algorithm.id;
      }
    }
  }
}

}  // namespace
}  // namespace broadmark::tests
