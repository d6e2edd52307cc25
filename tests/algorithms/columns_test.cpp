// The Columns family and its parts: layouts, bins, keys, the kernels of every instruction set.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "algorithms/runs.h"
#include "columns/cell_entries.h"
#include "columns/column_bins.h"
#include "columns/hit_buffer.h"
#include "columns/kernels.h"
#include "columns/layout.h"
#include "prefetch.h"

namespace broadmark::tests {
namespace {

using columns::BoxBlock;
using columns::CellEntry;
using columns::ColumnBins;
using columns::Layout;
using columns::Quantizer;

constexpr double kCopyCost = 150;

/// A quantised coordinate, as computed by the kernels.
std::uint32_t quantized(const Quantizer& quantizer, float coordinate) {
  const float scaled = (coordinate - quantizer.origin) * quantizer.scale;
  const float not_negative = scaled > 0 ? scaled : 0;
  return static_cast<std::uint32_t>(
      static_cast<std::int32_t>(not_negative < quantizer.max ? not_negative : quantizer.max));
}

/// The column boundaries that a box crosses on each cut axis.
std::array<std::uint32_t, 2> crossingsOf(const BoxBlock& block, std::size_t k) {
  std::array<std::uint32_t, 2> crossings;
  for (std::size_t i = 0; i < 2; ++i) {
    crossings[i] =
        (block.cut_max[i][k] >> Layout::kCoordBits) - (block.cut_min[i][k] >> Layout::kCoordBits);
  }
  return crossings;
}

bool isIn(const BoxBlock::Set& set, std::size_t k) { return (set[k / 64] >> k % 64 & 1) != 0; }

/// Quantised bounds on the cut axes.
struct QuantizedBox {
  std::uint32_t min[2];
  std::uint32_t max[2];
  [[nodiscard]] std::uint32_t key() const { return columns::keyOf(min[0], min[1], max[0], max[1]); }
};

/// Few different coordinates, such that most pairs of boxes have equal bounds, and both extremes.
QuantizedBox randomQuantizedBox(inputs::Random& random) {
  constexpr std::array<std::uint32_t, 6> kCoords = {0, 1, 127, 128, 254, 255};
  QuantizedBox box;
  for (int axis = 0; axis < 2; ++axis) {
    const auto a = static_cast<std::size_t>(random.integer(0, 5));
    const auto b = static_cast<std::size_t>(random.integer(0, 5));
    box.min[axis] = kCoords[std::min(a, b)];
    box.max[axis] = kCoords[std::max(a, b)];
  }
  return box;
}

bool overlapQuantized(const QuantizedBox& a, const QuantizedBox& b) {
  return a.min[0] <= b.max[0] && b.min[0] <= a.max[0] && a.min[1] <= b.max[1] &&
         b.min[1] <= a.max[1];
}

TEST(ColumnKeys, OverlapWhereQuantizedBoxesDo) {
  inputs::Random random(1, 0);
  for (int i = 0; i < 5000; ++i) {
    const QuantizedBox a = randomQuantizedBox(random);
    const QuantizedBox b = randomQuantizedBox(random);
    ASSERT_EQ(columns::overlapQuantized({0, ~1U, a.key(), 0}, {1, ~2U, b.key(), 1}),
              overlapQuantized(a, b));
  }
}

// A hit yields no pair, a certain one or an ambiguous one, the same by every instruction set.
TEST(ColumnKernels, ExtractPairsFromHits) {
  inputs::Random random(1, 0);
  constexpr std::uint32_t kMaxCoord = (1U << Layout::kSweepBits) - 1;
  constexpr std::array<std::uint32_t, 6> kCoords = {0, 1, 2, 1'000'000, kMaxCoord - 1, kMaxCoord};
  LargeArray<CellEntry> entries;
  entries.resize(61);
  std::vector<QuantizedBox> keys;
  for (CellEntry& entry : entries) {
    const std::uint32_t coord_a = kCoords[random.integer(0, 5)];
    const std::uint32_t coord_b = kCoords[random.integer(0, 5)];
    keys.push_back(randomQuantizedBox(random));
    entry = {std::min(coord_a, coord_b), ~std::max(coord_a, coord_b), keys.back().key(),
             static_cast<std::uint32_t>(random.integer(0, 1) == 0 ? entries.end() - &entry
                                                                  : 7 * keys.size())};
    for (int axis = 0; axis < 3; ++axis) {
      if (random.integer(0, 3) == 0) entry.body |= phantomBit(axis);
    }
  }
  std::vector<std::uint64_t> positions;
  std::vector<Pair> expected;
  std::vector<Pair> expected_ambiguous;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    for (std::size_t j = i + 1; j < entries.size(); ++j) {
      if (!overlapQuantized(keys[i], keys[j])) continue;  // no hit then
      positions.push_back(i | std::uint64_t{j - i} << 32);
      const CellEntry& a = entries[i];
      const CellEntry& b = entries[j];
      if (a.sweep_min > b.sweepMax() || b.sweep_min > a.sweepMax() ||
          !isHomeCellPair(a.body, b.body))
        continue;
      bool equal_bounds = a.sweep_min == b.sweepMax() || b.sweep_min == a.sweepMax();
      for (int axis = 0; axis < 2; ++axis) {
        equal_bounds |=
            keys[i].min[axis] == keys[j].max[axis] || keys[j].min[axis] == keys[i].max[axis];
      }
      (equal_bounds ? expected_ambiguous : expected)
          .push_back(orderedPair(bodyId(a.body), bodyId(b.body)));
    }
  }
  ASSERT_GT(expected.size(), 50U);
  ASSERT_GT(expected_ambiguous.size(), 50U);
  constexpr std::size_t kPadding = columns::Kernels::kExtractWidth;
  for (const Isa isa : supportedIsas()) {
    for (const std::size_t batch_size : {std::size_t{1}, std::size_t{13}, positions.size()}) {
      std::vector<Pair> found(positions.size() + kPadding);
      std::vector<Pair> ambiguous(positions.size() + kPadding);
      Pair* found_end = found.data();
      Pair* ambiguous_end = ambiguous.data();
      for (std::size_t begin = 0; begin < positions.size(); begin += batch_size) {
        const std::size_t count = std::min(batch_size, positions.size() - begin);
        std::vector<std::uint64_t> batch(positions.begin() + begin,
                                         positions.begin() + begin + count);
        std::vector<std::uint64_t> masks(count, 1);  // lane 0 at offset 0
        batch.resize(count + kPadding);
        masks.resize(count + kPadding, ~std::uint64_t{0});  // beyond the hits
        ASSERT_EQ(columns::kernels(isa).extract_pairs(batch.data(), masks.data(), count,
                                                      entries.data(), found_end, ambiguous_end),
                  0U);
      }
      found.resize(static_cast<std::size_t>(found_end - found.data()));
      ambiguous.resize(static_cast<std::size_t>(ambiguous_end - ambiguous.data()));
      EXPECT_EQ(found, expected) << isaName(isa);
      EXPECT_EQ(ambiguous, expected_ambiguous) << isaName(isa);
    }
  }
}

// The sweep of every instruction set against its definition, on windows of all lengths.
TEST(ColumnKernels, FindThePairsInTheWindows) {
  constexpr std::size_t kCount = 300;
  inputs::Random random(2, 0);
  std::vector<QuantizedBox> quantized_boxes;
  columns::SortedColumn sorted;
  sorted.resize(kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    quantized_boxes.push_back(randomQuantizedBox(random));
    // All overlap on the sweep axis, and all boxes overlap: only the keys differ.
    sorted.entries[i] = {0, ~1U, quantized_boxes[i].key(), static_cast<CellBody>(i)};
    sorted.keys[i] = quantized_boxes[i].key();
    const int length = i % 7 == 0 ? 200 : 12;  // some are far longer than neighbouring ones
    sorted.ends[i] = static_cast<std::uint32_t>(
        std::min<std::size_t>(kCount, i + 1 + static_cast<std::size_t>(random.integer(0, length))));
  }
  const std::vector<Aabb> boxes = inputs::identical(kCount, 0, 0);
  std::vector<Pair> expected;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    for (std::uint32_t j = i + 1; j < sorted.ends[i]; ++j) {
      if (overlapQuantized(quantized_boxes[i], quantized_boxes[j])) expected.push_back({i, j});
    }
  }
  for (const Isa isa : supportedIsas()) {
    PairBuffer pairs;
    columns::HitBuffer hits(columns::kernels(isa), sorted, boxes.data(), pairs);
    constexpr std::size_t kRows = columns::Kernels::kSweepRows;
    for (std::size_t row = 0; row < kCount; row += kRows) {
      columns::kernels(isa).sweep(sorted.keys.data(), sorted.ends.data(),
                                  {row, std::min(row + kRows, kCount)}, hits);
      hits.flush();
    }
    const PairRun found = pairs.run();
    EXPECT_EQ(tests::sorted({&found, 1}), expected) << isaName(isa);
  }
}

TEST(ColumnKernels, StreamExactlyTheBoxes) {
  constexpr std::size_t kMaxCount = 40;
  const std::vector<Aabb> boxes = inputs::uniform(kMaxCount + 1, 0, 1);
  for (const Isa isa : supportedIsas()) {
    for (std::size_t count = 0; count <= kMaxCount; ++count) {
      const Aabb* const from = boxes.data() + count % 2;  // may be unaligned
      LargeArray<Aabb> target;
      target.resize(kMaxCount + 1);
      std::fill(target.begin(), target.end(), kEmptyBox);
      columns::kernels(isa).stream_copy(from, count, target.data());
      streamFence();
      ASSERT_TRUE(std::equal(target.begin(), target.begin() + count, from)) << count;
      ASSERT_TRUE(isEmpty(target[count])) << count;
    }
  }
}

// All instruction sets agree.
TEST(ColumnKernels, QuantizeBoxesAlike) {
  std::array<CellBody, BoxBlock::kBoxes> bodies;
  std::iota(bodies.begin(), bodies.end(), 1000);
  for (const inputs::Generator boxes_of : {inputs::assorted, inputs::limits, inputs::tiny}) {
    const std::vector<Aabb> boxes = boxes_of(BoxBlock::kBoxes, 1, 3);
    const Layout layout(boxes, 1'000'000, kCopyCost);
    for (const Isa isa : supportedIsas()) {
      for (const std::size_t count : {1U, 7U, 16U, 33U, 128U}) {
        BoxBlock block;
        columns::kernels(isa).quantize_boxes(boxes.data(), bodies.data(), count,
                                             layout.quantizers(), block);
        const auto expect_coords = [&](const Quantizer& quantizer, std::size_t k, std::uint32_t min,
                                       std::uint32_t max) {
          ASSERT_EQ(min, quantized(quantizer, boxes[k].min[quantizer.axis])) << isaName(isa);
          ASSERT_EQ(max, quantized(quantizer, boxes[k].max[quantizer.axis])) << isaName(isa);
        };
        for (std::size_t k = 0; k < count; ++k) {
          for (int i = 0; i < 2; ++i) {
            expect_coords(layout.quantizers().cut[i], k, block.cut_min[i][k], block.cut_max[i][k]);
          }
          const CellEntry& entry = block.entries[k];
          expect_coords(layout.quantizers().sweep, k, entry.sweep_min, entry.sweepMax());
          ASSERT_EQ(entry.key, block.keys[k]);
          ASSERT_EQ(entry.body, bodies[k]);
          ASSERT_LT(block.columns[k], layout.size());
          const auto [crossings_a, crossings_b] = crossingsOf(block, k);
          ASSERT_EQ(isIn(block.cross_one, k), crossings_a + crossings_b == 1) << isaName(isa);
          ASSERT_EQ(isIn(block.cross_several, k), crossings_a + crossings_b > 1) << isaName(isa);
          if (crossings_a + crossings_b != 1) continue;
          const int axis = layout.quantizers().cut[crossings_a != 0 ? 0 : 1].axis;
          ASSERT_EQ(block.next_bodies[k], bodies[k] | phantomBit(axis));
          ASSERT_EQ(
              block.next_columns[k],
              block.columns[k] + (crossings_a != 0 ? 1 : layout.quantizers().columns_per_row));
        }
        for (std::size_t k = count; k < BoxBlock::kBoxes; ++k) {
          ASSERT_FALSE(isIn(block.cross_one, k) || isIn(block.cross_several, k)) << isaName(isa);
        }
      }
    }
  }
}

TEST(ColumnLayout, QuantizationIsMonotonic) {
  constexpr float kMax = std::numeric_limits<float>::max();
  for (const inputs::Generator boxes : {inputs::uniform, inputs::limits, inputs::tiny, inputs::huge,
                                        inputs::identical, inputs::zeroSize}) {
    const Layout layout(boxes(200, 0, 1), 100'000, kCopyCost);
    const auto& [cut, sweep, columns] = layout.quantizers();
    for (const Quantizer& quantizer : {cut[0], cut[1], sweep}) {
      std::uint32_t before = 0;
      for (const float x : {-kMax, -1e30F, -100.0F, -1.0F, -1e-40F, 0.0F, 1e-45F, 0.3F, 1.0F, 2.0F,
                            20.0F, 1e30F, kMax}) {
        ASSERT_GE(quantized(quantizer, x), before);
        ASSERT_LE(static_cast<float>(quantized(quantizer, x)), quantizer.max);
        before = quantized(quantizer, x);
      }
    }
  }
}

TEST(ColumnLayout, IsOneColumnForNoneAndForIdenticalBoxes) {
  EXPECT_EQ(Layout().size(), 1U);
  EXPECT_EQ(Layout({}, 0, kCopyCost).size(), 1U);
  EXPECT_EQ(Layout(inputs::identical(50, 0, 1), 1'000'000, kCopyCost).size(), 1U);
}

TEST(ColumnLayout, HasMoreColumnsForMoreBoxes) {
  const std::vector<Aabb> sample = inputs::uniform(2000, 0, 1);
  EXPECT_GT(Layout(sample, 2'000'000, kCopyCost).size(), Layout(sample, 2000, kCopyCost).size());
  EXPECT_GT(Layout(sample, 2'000'000, kCopyCost).size(), Layout(sample, 2'000'000, 10'000).size());
}

// A line is swept along its length, and a plane is not swept through its thickness.
TEST(ColumnLayout, CutsAxesByExtent) {
  const Layout plane(inputs::onePlane(2000, 0, 1), 100'000, kCopyCost);
  EXPECT_NE(plane.quantizers().sweep.axis, 2);
  EXPECT_GT(plane.size(), 4U);
  const std::vector<Aabb> line = inputs::generate(2000, 0, 1, [](inputs::Random& random, auto) {
    return inputs::boxAt({0, random.uniform(0, 4000), 0}, {1, 1, 1});
  });
  EXPECT_EQ(Layout(line, 2000, kCopyCost).quantizers().sweep.axis, 1);
}

TEST(ColumnLayout, CoarsensDownToOneColumn) {
  Layout layout(inputs::uniform(2000, 0, 1), 1'000'000, kCopyCost);
  ASSERT_GT(layout.size(), 64U);
  std::size_t before = layout.size();
  while (layout.size() > 1) {
    layout.coarsen();
    ASSERT_LT(layout.size(), before);
    before = layout.size();
  }
}

TEST(ColumnBins, PreserveOrder) {
  constexpr std::uint32_t kColumns = 40;
  ColumnBins bins;
  for (const std::uint32_t count : {0U, 1U, 126U, 127U, 128U, 254U, 1000U}) {
    bins.clear(kColumns);
    for (std::uint32_t i = 0; i < count; ++i) {
      for (std::uint32_t column = 0; column < kColumns; ++column) {
        bins.append(column, {0, 0, column, i});
      }
    }
    EXPECT_EQ(bins.count(), std::size_t{kColumns} * count);
    for (std::uint32_t column = 0; column < kColumns; ++column) {
      ASSERT_EQ(bins.count(column), count);
      std::uint32_t next = 0;
      bins.forEach(column, [&](const CellEntry& entry) {
        ASSERT_EQ(entry.key, column);
        ASSERT_EQ(entry.body, next++);
      });
      ASSERT_EQ(next, count);
    }
  }
}

// More calls than chunks, and bins of several workers.
TEST(ColumnBins, ArePrefetchedToTheirEnds) {
  std::array<ColumnBins, 3> bins;
  for (ColumnBins& worker_bins : bins) worker_bins.clear(2);
  for (std::uint32_t i = 0; i < 1000; ++i) bins[i < 900 ? 0 : 2].append(1, {0, 0, 0, i});
  for (const std::size_t column : {0U, 1U}) {
    columns::ChunkPrefetcher prefetcher(bins, column);
    for (int chunk = 0; chunk < 30; ++chunk) prefetcher.next();
  }
  columns::ChunkPrefetcher().next();
}

/// Edges from 0.02 to 200: the largest boxes span the world.
std::vector<Aabb> allSizes(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  return inputs::generate(n, frame, seed, [](inputs::Random& random, std::size_t) {
    const float edge = 0.02F * std::pow(10'000.0F, std::pow(random.uniform(0, 1), 4.0F));
    return inputs::boxAt(random.inCube(60), {edge, edge, edge});
  });
}

/// Dense clusters of all sizes in an empty world.
std::vector<Aabb> clusters(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  return inputs::generate(n, frame, seed, [](inputs::Random& random, std::size_t i) {
    const auto cluster = static_cast<float>(i % 5);
    const float spread = std::pow(4.0F, cluster);
    inputs::Vec3 corner = random.inCube(spread);
    for (float& x : corner) x += cluster * 3e4F;
    return inputs::boxAt(corner, {1, 1, 1});
  });
}

/// Columns and all threads, however few the boxes.
const ParameterValues kColumnsOnly = {{"max_brute_force", "0"}, {"min_share_us", "0"}};

ParameterValues columnsOnly(ParameterValues parameters = {}) {
  parameters.insert(kColumnsOnly.begin(), kColumnsOnly.end());
  return parameters;
}

class ColumnsFamily : public testing::TestWithParam<Algorithm> {
 protected:
  /// In every configuration, with default parameters, on all threads, with the most columns, and
  /// with the most splits.
  void check(const std::vector<Aabb>& boxes) {
    const std::vector<Pair> expected = sweptPairs(boxes);
    for (const Configuration& config : configurations(GetParam())) {
      for (const ParameterValues& parameters :
           {ParameterValues{}, columnsOnly(), columnsOnly({{"copy_cost", "1"}}),
            columnsOnly({{"copy_cost", "1"}, {"split_threshold", "1"}})}) {
        SCOPED_TRACE(caseName(caseOf(GetParam(), config, parameters)));
        TestRun test_run(GetParam(), config, parameters);
        SceneInfo scene;
        scene.objects = static_cast<std::uint32_t>(boxes.size());
        test_run.start(scene, inputs::clustered(boxes.size(), 99, 1));
        ASSERT_EQ(sorted(test_run.step(boxes)), expected);
        ASSERT_EQ(test_run.broadPhase().validate(), "");
        ASSERT_EQ(countersOf(test_run.broadPhase()).count("copies"), 1U);
      }
    }
  }
};

TEST_P(ColumnsFamily, FindTheRightPairsInManyColumns) {
  for (const inputs::Input& input : inputs::kAll) {
    SCOPED_TRACE(input.name);
    check(input.boxes(400, 1, 5));
    if (HasFatalFailure()) return;
  }
}

TEST_P(ColumnsFamily, CopeWithBoxesOfAllSizesAndPlaces) {
  for (const inputs::Generator boxes : {allSizes, clusters, inputs::limits}) {
    check(boxes(700, 0, 1));
    if (HasFatalFailure()) return;
  }
  // Split columns are cut on other axes than the grid around them.
  for (std::uint32_t frame = 0; frame < 6; ++frame) {
    check(inputs::rodsAndPlates(1500, frame, 1));
    if (HasFatalFailure()) return;
  }
  check({});
  check({inputs::boxAt({0, 0, 0}, {1, 1, 1})});
}

// In one dense cluster, or two, splitting does not help.
TEST_P(ColumnsFamily, SweepBoxesWhereManyOverlap) {
  const auto dense = [](std::size_t n, float apart) {
    return inputs::generate(n, 0, 1, [apart](inputs::Random& random, std::size_t i) {
      inputs::Vec3 corner = random.inCube(0.5F);
      for (float& x : corner) x += i % 2 == 0 ? 0 : apart;
      return inputs::boxAt(corner, {1, 1, 1});
    });
  };
  check(dense(601, 0));
  check(dense(900, 50));
  TestRun test_run(GetParam(), {bestIsa(), GetParam().traits.parallel ? 3 : 1}, columnsOnly());
  test_run.start(dense(601, 0));
  test_run.step(dense(601, 0));
  const auto counters = countersOf(test_run.broadPhase());
  EXPECT_EQ(counters.at("pairs decided by their boxes"), counters.at("tests"));
  EXPECT_EQ(counters.at("tests"), 601U * 600U / 2);
}

TEST_P(ColumnsFamily, CopeWithEveryNumberOfBodies) {
  for (std::size_t n = 0; n <= 70; ++n) {
    const std::vector<Aabb> boxes = inputs::touching(n, 0, n);
    TestRun test_run(GetParam(), {bestIsa(), GetParam().traits.parallel ? 3 : 1},
                     columnsOnly({{"copy_cost", "1"}}));
    test_run.start(boxes);
    ASSERT_EQ(sorted(test_run.step(boxes)), bruteForcePairs(boxes)) << n;
  }
}

// An instance tests all pairs of few boxes, and bins many.
TEST_P(ColumnsFamily, TestAllPairsOfFewBoxes) {
  for (const Configuration& config : configurations(GetParam())) {
    SCOPED_TRACE(describe(GetParam(), config));
    ExecutionContext execution(config.threads, config.isa);
    const std::unique_ptr<BroadPhase> algorithm = GetParam().create();
    algorithm->initialize({}, {0, inputs::uniform(1000, 0, 1)}, execution);
    for (const std::uint32_t n : {50U, 500U, 0U, 1U, 98U, 99U, 1000U}) {
      const std::vector<Aabb> boxes = inputs::uniform(n, 1, 1);
      algorithm->updateObjects({1, boxes});
      algorithm->cleanCache();
      algorithm->searchOverlaps();
      ASSERT_EQ(sorted(algorithm->overlaps()), bruteForcePairs(boxes)) << n;
      ASSERT_EQ(algorithm->validate(), "");
      const Counters counters = countersOf(*algorithm);
      const bool few = n <= (config.isa == Isa::scalar ? 98U : 176U);
      EXPECT_EQ(counters.at("columns") == 0, few) << n;
      if (!few) continue;
      EXPECT_EQ(counters.at("tests"), n * (n - 1) / 2);
      EXPECT_EQ(drawingOf(*algorithm, n).tests(), std::vector<std::uint32_t>(n, n - 1));
    }
  }
}

TEST_P(ColumnsFamily, FindTheRightPairsOfAMillionBodies) {
  const std::vector<Aabb> boxes = inputs::uniform(1'000'000, 0, 1);
  TestRun test_run(GetParam(), {bestIsa(), GetParam().traits.parallel ? 2 : 1});
  test_run.start(boxes);
  ASSERT_EQ(sorted(test_run.step(boxes)), sweptPairs(boxes));
}

// Only one giant that spans the world, and a plate per axis, have entries in all columns.
TEST_P(ColumnsFamily, CopyGiantsIntoAllColumns) {
  std::vector<Aabb> boxes = inputs::uniform(3000, 0, 1);
  boxes[5] = inputs::boxAt({-1e6F, -1e6F, -1e6F}, {2e6F, 2e6F, 2e6F});
  for (int axis = 0; axis < 3; ++axis) {
    Aabb& plate = boxes[100 + static_cast<std::size_t>(axis)];
    plate = boxes[5];
    plate.min[axis] = 15;
    plate.max[axis] = 15.5F;
  }
  check(boxes);
  TestRun test_run(GetParam(), {bestIsa(), 1}, {{"copy_cost", "5"}});
  test_run.start(boxes);
  test_run.step(boxes);
  const Counters counters = countersOf(test_run.broadPhase());
  EXPECT_GT(counters.at("columns"), 20U);
  EXPECT_LT(counters.at("copies"), 2 * boxes.size() + 4 * counters.at("columns"));
}

/// Small boxes at the indices of the first sample (sampleIndex()), plates at all others.
std::vector<Aabb> misleading(std::size_t n) {
  std::set<std::size_t> sampled;
  for (std::size_t k = 0; k < 256; ++k) {
    sampled.insert(static_cast<std::uint32_t>(k * 0x9E3779B9U) * std::uint64_t{n} >> 32);
  }
  return inputs::generate(n, 0, 1, [&](inputs::Random& random, std::size_t i) {
    const inputs::Vec3 corner = random.inCube(100);
    if (sampled.contains(i)) return inputs::boxAt(corner, {0.1F, 0.1F, 0.1F});
    return inputs::boxAt({corner[0], 0, 0}, {0.01F, 100, 100});
  });
}

TEST_P(ColumnsFamily, LimitTheNumberOfEntries) {
  const std::vector<Aabb> boxes = misleading(4000);
  TestRun test_run(GetParam(), {bestIsa(), 1}, columnsOnly({{"copy_cost", "1"}}));
  test_run.start(boxes);
  EXPECT_EQ(sorted(test_run.step(boxes)), sweptPairs(boxes));
  EXPECT_LT(countersOf(test_run.broadPhase()).at("copies"), 10 * boxes.size());
}

// Enough boxes for non-temporal stores, with an incomplete last block.
TEST_P(ColumnsFamily, FindTheRightPairsOfManyBoxes) {
  const std::vector<Aabb> boxes = inputs::uniform((std::size_t{1} << 17) + 3, 0, 1);
  TestRun test_run(GetParam(), {bestIsa(), GetParam().traits.parallel ? 2 : 1});
  test_run.start(inputs::uniform(boxes.size(), 1, 1));
  ASSERT_EQ(sorted(test_run.step(boxes)), sweptPairs(boxes));
}

TEST_P(ColumnsFamily, SplitCrowdedColumns) {
  std::vector<Aabb> boxes = inputs::clustered(20'000, 1, 1);
  for (std::size_t i = 0; i < boxes.size(); i += 2) {
    for (int axis = 0; axis < 3; ++axis) {
      boxes[i].min[axis] += 1e5F;
      boxes[i].max[axis] += 1e5F;
    }
  }
  TestRun test_run(GetParam(), {bestIsa(), 1});
  test_run.start(boxes);
  EXPECT_EQ(sorted(test_run.step(boxes)), sweptPairs(boxes));
  EXPECT_EQ(test_run.broadPhase().validate(), "");
  const Counters counters = countersOf(test_run.broadPhase());
  EXPECT_GE(counters.at("split columns"), 2U);
  EXPECT_LT(counters.at("tests"), 150 * boxes.size());
  // The columns of a split are drawn instead of it, a level deeper.
  const RecordedDrawing drawing = drawingOf(test_run.broadPhase());
  EXPECT_TRUE(std::ranges::any_of(drawing.boxes(), [](const auto& box) { return box.level == 1; }));
  EXPECT_LE(drawing.boxes().size(), counters.at("columns"));
  EXPECT_GE(populationOf(drawing), boxes.size());
}

TEST_P(ColumnsFamily, ReportPairsInTheSameOrderForEveryTeam) {
  if (!GetParam().traits.parallel) GTEST_SKIP() << "uses one thread";
  for (const std::vector<Aabb>& boxes :
       {inputs::uniform(3000, 1, 1), clusters(3000, 1, 1), inputs::assorted(3000, 1, 1),
        inputs::uniform(150'000, 1, 1)}) {  // enough for non-temporal stores
    std::vector<Pair> first;
    for (const int threads : {1, 2, 3, 5, 8}) {
      TestRun test_run(GetParam(), {bestIsa(), threads},
                       columnsOnly({{"copy_cost", "5"}, {"split_threshold", "5"}}));
      test_run.start(boxes);
      std::vector<Pair> pairs;
      for (const PairRun worker_pairs : test_run.step(boxes))
        pairs.insert(pairs.end(), worker_pairs.begin(), worker_pairs.end());
      ASSERT_FALSE(pairs.empty());
      if (first.empty()) first = pairs;
      ASSERT_EQ(pairs, first) << threads << " threads";
    }
  }
}

std::vector<Algorithm> columnsFamily() {
  std::vector<Algorithm> algorithms = pairFinders();
  std::erase_if(algorithms,
                [](const Algorithm& algorithm) { return algorithm.family != "Columns"; });
  return algorithms;
}

INSTANTIATE_TEST_SUITE_P(Algorithms, ColumnsFamily, testing::ValuesIn(columnsFamily()),
                         [](const auto& tested) { return testName(tested.param); });

}  // namespace
}  // namespace broadmark::tests
