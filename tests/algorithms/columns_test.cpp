// Columns and what they are made of: layouts, chains, keys, the kernels of every instruction set.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "algorithms/runs.h"
#include "columns/chains.h"
#include "columns/copies.h"
#include "columns/hits.h"
#include "columns/kernels.h"
#include "columns/layout.h"
#include "prefetch.h"

namespace broadmark::tests {
namespace {

using columns::BoxBlock;
using columns::Chains;
using columns::Copy;
using columns::Layout;
using columns::StepScale;

constexpr double kCopyCost = 150;

/// What kernels make of a coordinate.
std::uint32_t stepOf(const StepScale& scale, float coordinate) {
  const float step = (coordinate - scale.low) * scale.factor;
  const float at_least = step > 0 ? step : 0;
  return static_cast<std::uint32_t>(
      static_cast<std::int32_t>(at_least < scale.last ? at_least : scale.last));
}

/// How many sides between columns a box crosses.
std::array<std::uint32_t, 2> crossedBy(const BoxBlock& block, std::size_t k) {
  std::array<std::uint32_t, 2> crossed;
  for (std::size_t which = 0; which < 2; ++which) {
    crossed[which] =
        (block.high[which][k] >> Layout::kStepBits) - (block.low[which][k] >> Layout::kStepBits);
  }
  return crossed;
}

bool isIn(const BoxBlock::Set& set, std::size_t k) { return (set[k / 64] >> k % 64 & 1) != 0; }

/// First and last steps on both axes.
struct StepBox {
  std::uint32_t first[2];
  std::uint32_t last[2];
  [[nodiscard]] std::uint32_t key() const {
    return columns::keyOf(first[0], first[1], last[0], last[1]);
  }
};

/// Few different steps, and those at both ends: most boxes share some.
StepBox randomSteps(inputs::Random& random) {
  constexpr std::array<std::uint32_t, 6> kSteps = {0, 1, 127, 128, 254, 255};
  StepBox box;
  for (int axis = 0; axis < 2; ++axis) {
    const auto a = static_cast<std::size_t>(random.integer(0, 5));
    const auto b = static_cast<std::size_t>(random.integer(0, 5));
    box.first[axis] = kSteps[std::min(a, b)];
    box.last[axis] = kSteps[std::max(a, b)];
  }
  return box;
}

bool overlapInSteps(const StepBox& a, const StepBox& b) {
  return a.first[0] <= b.last[0] && b.first[0] <= a.last[0] && a.first[1] <= b.last[1] &&
         b.first[1] <= a.last[1];
}

TEST(ColumnKeys, TellWhatOverlapsInSteps) {
  inputs::Random random(1, 0);
  for (int i = 0; i < 5000; ++i) {
    const StepBox a = randomSteps(random);
    const StepBox b = randomSteps(random);
    ASSERT_EQ(columns::overlapInSteps({0, ~1U, a.key(), 0}, {1, ~2U, b.key(), 1}),
              overlapInSteps(a, b));
  }
}

// What becomes of a hit, by every instruction set: nothing, a pair, or one that the boxes decide.
TEST(ColumnKernels, TakePairsFromHits) {
  inputs::Random random(1, 0);
  constexpr std::uint32_t kLastStep = (1U << Layout::kSweepBits) - 1;
  constexpr std::array<std::uint32_t, 6> kSteps = {0, 1, 2, 1'000'000, kLastStep - 1, kLastStep};
  LargeArray<Copy> copies;
  copies.resize(61);
  std::vector<StepBox> keys;
  for (Copy& copy : copies) {
    const std::uint32_t one = kSteps[random.integer(0, 5)];
    const std::uint32_t other = kSteps[random.integer(0, 5)];
    keys.push_back(randomSteps(random));
    copy = {std::min(one, other), ~std::max(one, other), keys.back().key(),
            static_cast<std::uint32_t>(random.integer(0, 1) == 0 ? copies.end() - &copy
                                                                 : 7 * keys.size())};
    for (int axis = 0; axis < 3; ++axis) {
      if (random.integer(0, 3) == 0) copy.body |= axisMark(axis);
    }
  }
  std::vector<std::uint64_t> places;
  std::vector<Pair> right;
  std::vector<Pair> right_doubts;
  for (std::size_t i = 0; i < copies.size(); ++i) {
    for (std::size_t j = i + 1; j < copies.size(); ++j) {
      if (!overlapInSteps(keys[i], keys[j])) continue;  // then there is no hit
      places.push_back(i | std::uint64_t{j - i} << 32);
      const Copy& a = copies[i];
      const Copy& b = copies[j];
      if (a.first > b.last() || b.first > a.last() || !reportedHere(a.body, b.body)) continue;
      bool shared = a.first == b.last() || b.first == a.last();
      for (int axis = 0; axis < 2; ++axis) {
        shared |=
            keys[i].first[axis] == keys[j].last[axis] || keys[j].first[axis] == keys[i].last[axis];
      }
      (shared ? right_doubts : right)
          .push_back(orderedPair(bodyNumber(a.body), bodyNumber(b.body)));
    }
  }
  ASSERT_GT(right.size(), 50U);
  ASSERT_GT(right_doubts.size(), 50U);
  constexpr std::size_t kSlack = columns::Kernels::kTakenTogether;
  for (const Isa isa : supportedIsas()) {
    for (const std::size_t together : {std::size_t{1}, std::size_t{13}, places.size()}) {
      std::vector<Pair> found(places.size() + kSlack);
      std::vector<Pair> doubts(places.size() + kSlack);
      Pair* found_end = found.data();
      Pair* doubts_end = doubts.data();
      for (std::size_t begin = 0; begin < places.size(); begin += together) {
        const std::size_t count = std::min(together, places.size() - begin);
        std::vector<std::uint64_t> some(places.begin() + begin, places.begin() + begin + count);
        std::vector<std::uint64_t> bits(count, 1);  // the first lane, the first step
        some.resize(count + kSlack);
        bits.resize(count + kSlack, ~std::uint64_t{0});  // nobody's
        ASSERT_EQ(columns::kernels(isa).take_pairs(some.data(), bits.data(), count, copies.data(),
                                                   found_end, doubts_end),
                  0U);
      }
      found.resize(static_cast<std::size_t>(found_end - found.data()));
      doubts.resize(static_cast<std::size_t>(doubts_end - doubts.data()));
      EXPECT_EQ(found, right) << isaName(isa);
      EXPECT_EQ(doubts, right_doubts) << isaName(isa);
    }
  }
}

// The sweep of every instruction set against its definition, on windows of all lengths.
TEST(ColumnKernels, FindThePairsInTheWindows) {
  constexpr std::size_t kCount = 300;
  inputs::Random random(2, 0);
  std::vector<StepBox> steps;
  columns::Sorted sorted;
  sorted.resize(kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    steps.push_back(randomSteps(random));
    // Bounds never decide, nor do boxes: what is tested are the keys.
    sorted.copies[i] = {0, ~1U, steps[i].key(), static_cast<MarkedBody>(i)};
    sorted.keys[i] = steps[i].key();
    const int length = i % 7 == 0 ? 200 : 12;  // some far longer than their neighbours'
    sorted.ends[i] = static_cast<std::uint32_t>(
        std::min<std::size_t>(kCount, i + 1 + static_cast<std::size_t>(random.integer(0, length))));
  }
  const std::vector<Aabb> boxes = inputs::identical(kCount, 0, 0);
  std::vector<Pair> right;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    for (std::uint32_t j = i + 1; j < sorted.ends[i]; ++j) {
      if (overlapInSteps(steps[i], steps[j])) right.push_back({i, j});
    }
  }
  for (const Isa isa : supportedIsas()) {
    PairBuffer pairs;
    columns::HitSink sink(columns::kernels(isa), sorted, boxes.data(), pairs);
    constexpr std::size_t kRows = columns::Kernels::kSweptRows;
    for (std::size_t row = 0; row < kCount; row += kRows) {
      columns::kernels(isa).sweep(sorted.keys.data(), sorted.ends.data(),
                                  {row, std::min(row + kRows, kCount)}, sink);
      sink.flush();
    }
    const PairRun run = pairs.run();
    EXPECT_EQ(tests::sorted({&run, 1}), right) << isaName(isa);
  }
}

TEST(ColumnKernels, CopyNoMoreAndNoLessPastCaches) {
  constexpr std::size_t kMost = 40;
  const std::vector<Aabb> boxes = inputs::uniform(kMost + 1, 0, 1);
  for (const Isa isa : supportedIsas()) {
    for (std::size_t count = 0; count <= kMost; ++count) {
      const Aabb* const from = boxes.data() + count % 2;  // no alignment is asked for
      LargeArray<Aabb> kept;
      kept.resize(kMost + 1);
      std::fill(kept.begin(), kept.end(), kEmptyBox);
      columns::kernels(isa).copy_past_caches(from, count, kept.data());
      showWritesPastCaches();
      ASSERT_TRUE(std::equal(kept.begin(), kept.begin() + count, from)) << count;
      ASSERT_TRUE(isEmpty(kept[count])) << count;
    }
  }
}

// A lower coordinate never gets a higher step, and all instruction sets agree.
TEST(ColumnKernels, FindTheSameSteps) {
  std::array<MarkedBody, BoxBlock::kBoxes> bodies;
  std::iota(bodies.begin(), bodies.end(), 1000);
  for (const inputs::Generator boxes_of : {inputs::assorted, inputs::limits, inputs::tiny}) {
    const std::vector<Aabb> boxes = boxes_of(BoxBlock::kBoxes, 1, 3);
    const Layout layout(boxes, 1'000'000, kCopyCost);
    for (const Isa isa : supportedIsas()) {
      for (const std::size_t count : {1U, 7U, 16U, 33U, 128U}) {
        BoxBlock block;
        columns::kernels(isa).find_steps(boxes.data(), bodies.data(), count, layout.scales(),
                                         block);
        const auto expect_steps = [&](const StepScale& scale, std::size_t k, std::uint32_t first,
                                      std::uint32_t last) {
          ASSERT_EQ(first, stepOf(scale, boxes[k].min[scale.axis])) << isaName(isa);
          ASSERT_EQ(last, stepOf(scale, boxes[k].max[scale.axis])) << isaName(isa);
        };
        for (std::size_t k = 0; k < count; ++k) {
          for (int which = 0; which < 2; ++which) {
            expect_steps(layout.scales().of[which], k, block.low[which][k], block.high[which][k]);
          }
          const Copy& copy = block.copies[k];
          expect_steps(layout.scales().sweep, k, copy.first, copy.last());
          ASSERT_EQ(copy.key, block.keys[k]);
          ASSERT_EQ(copy.body, bodies[k]);
          ASSERT_LT(block.columns[k], layout.size());
          const auto [on_a, on_b] = crossedBy(block, k);
          ASSERT_EQ(isIn(block.cross_one, k), on_a + on_b == 1) << isaName(isa);
          ASSERT_EQ(isIn(block.cross_more, k), on_a + on_b > 1) << isaName(isa);
          if (on_a + on_b != 1) continue;
          const int axis = layout.scales().of[on_a != 0 ? 0 : 1].axis;
          ASSERT_EQ(block.next_bodies[k], bodies[k] | axisMark(axis));
          ASSERT_EQ(block.next_columns[k],
                    block.columns[k] + (on_a != 0 ? 1 : layout.scales().columns_in_row));
        }
        for (std::size_t k = count; k < BoxBlock::kBoxes; ++k) {
          ASSERT_FALSE(isIn(block.cross_one, k) || isIn(block.cross_more, k)) << isaName(isa);
        }
      }
    }
  }
}

TEST(ColumnLayout, StepsKeepTheOrderOfCoordinates) {
  constexpr float kMost = std::numeric_limits<float>::max();
  for (const inputs::Generator boxes : {inputs::uniform, inputs::limits, inputs::tiny, inputs::huge,
                                        inputs::identical, inputs::zeroSize}) {
    const Layout layout(boxes(200, 0, 1), 100'000, kCopyCost);
    const auto& [cut, sweep, columns] = layout.scales();
    for (const StepScale& scale : {cut[0], cut[1], sweep}) {
      std::uint32_t before = 0;
      for (const float x : {-kMost, -1e30F, -100.0F, -1.0F, -1e-40F, 0.0F, 1e-45F, 0.3F, 1.0F, 2.0F,
                            20.0F, 1e30F, kMost}) {
        ASSERT_GE(stepOf(scale, x), before);
        ASSERT_LE(static_cast<float>(stepOf(scale, x)), scale.last);
        before = stepOf(scale, x);
      }
    }
  }
}

TEST(ColumnLayout, NothingAndOneThingAreOneColumn) {
  EXPECT_EQ(Layout().size(), 1U);
  EXPECT_EQ(Layout({}, 0, kCopyCost).size(), 1U);
  EXPECT_EQ(Layout(inputs::identical(50, 0, 1), 1'000'000, kCopyCost).size(), 1U);
}

TEST(ColumnLayout, HasMoreColumnsForMoreBoxes) {
  const std::vector<Aabb> sample = inputs::uniform(2000, 0, 1);
  EXPECT_GT(Layout(sample, 2'000'000, kCopyCost).size(), Layout(sample, 2000, kCopyCost).size());
  EXPECT_GT(Layout(sample, 2'000'000, kCopyCost).size(), Layout(sample, 2'000'000, 10'000).size());
}

// A line is swept along, and a plane is not cut through.
TEST(ColumnLayout, CutsWhereBoxesExtend) {
  const Layout plane(inputs::onePlane(2000, 0, 1), 100'000, kCopyCost);
  EXPECT_NE(plane.scales().sweep.axis, 2);
  EXPECT_GT(plane.size(), 4U);
  const std::vector<Aabb> line = inputs::generate(2000, 0, 1, [](inputs::Random& random, auto) {
    return inputs::boxAt({0, random.uniform(0, 4000), 0}, {1, 1, 1});
  });
  EXPECT_EQ(Layout(line, 2000, kCopyCost).scales().sweep.axis, 1);
}

TEST(ColumnLayout, WidensDownToOneColumn) {
  Layout layout(inputs::uniform(2000, 0, 1), 1'000'000, kCopyCost);
  ASSERT_GT(layout.size(), 64U);
  std::size_t before = layout.size();
  while (layout.size() > 1) {
    layout.widen();
    ASSERT_LT(layout.size(), before);
    before = layout.size();
  }
}

TEST(ColumnChains, KeepCopiesInTheirOrder) {
  constexpr std::uint32_t kColumns = 40;
  Chains chains;
  for (const std::uint32_t copies : {0U, 1U, 126U, 127U, 128U, 254U, 1000U}) {
    chains.clear(kColumns);
    for (std::uint32_t i = 0; i < copies; ++i) {
      for (std::uint32_t column = 0; column < kColumns; ++column) {
        chains.append(column, {0, 0, column, i});
      }
    }
    EXPECT_EQ(chains.count(), std::size_t{kColumns} * copies);
    for (std::uint32_t column = 0; column < kColumns; ++column) {
      ASSERT_EQ(chains.count(column), copies);
      std::uint32_t next = 0;
      chains.forEach(column, [&](const Copy& copy) {
        ASSERT_EQ(copy.key, column);
        ASSERT_EQ(copy.body, next++);
      });
      ASSERT_EQ(next, copies);
    }
  }
}

// However often more is asked for, and of as many workers as there are.
TEST(ColumnChains, AreSentForToTheirEnds) {
  std::array<Chains, 3> chains;
  for (Chains& each : chains) each.clear(2);
  for (std::uint32_t i = 0; i < 1000; ++i) chains[i < 900 ? 0 : 2].append(1, {0, 0, 0, i});
  for (const std::size_t column : {0U, 1U}) {
    columns::ChainsAhead ahead(chains, column);
    for (int chunk = 0; chunk < 30; ++chunk) ahead.more();
  }
  columns::ChainsAhead().more();
}

/// Edges from 0.02 to 200: the largest boxes are over all.
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

class ColumnsFamily : public testing::TestWithParam<Algorithm> {
 protected:
  /// In every configuration: with columns as they are, with as many as there may be, and with all
  /// split that can be.
  void check(const std::vector<Aabb>& boxes) {
    const std::vector<Pair> right = sweptPairs(boxes);
    for (const Configuration& way : configurations(GetParam())) {
      for (const ParameterValues& parameters :
           {ParameterValues{}, ParameterValues{{"copy_cost", "1"}},
            ParameterValues{{"copy_cost", "1"}, {"split_threshold", "1"}}}) {
        SCOPED_TRACE(caseName(caseOf(GetParam(), way, parameters)));
        TestRun run(GetParam(), way, parameters);
        SceneInfo scene;
        scene.objects = static_cast<std::uint32_t>(boxes.size());
        run.start(scene, inputs::clustered(boxes.size(), 99, 1));
        ASSERT_EQ(sorted(run.step(boxes)), right);
        ASSERT_EQ(run.broadPhase().validate(), "");
        ASSERT_EQ(countersOf(run.broadPhase()).count("copies"), 1U);
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
  // Columns within a column are cut on other axes than it.
  for (std::uint32_t frame = 0; frame < 6; ++frame) {
    check(inputs::rodsAndPlates(1500, frame, 1));
    if (HasFatalFailure()) return;
  }
  check({});
  check({inputs::boxAt({0, 0, 0}, {1, 1, 1})});
}

// Where all is in one spot, and in one of two clusters: cutting does not help.
TEST_P(ColumnsFamily, SweepBoxesWhereManyOverlap) {
  const auto spot = [](std::size_t n, float apart) {
    return inputs::generate(n, 0, 1, [apart](inputs::Random& random, std::size_t i) {
      inputs::Vec3 corner = random.inCube(0.5F);
      for (float& x : corner) x += i % 2 == 0 ? 0 : apart;
      return inputs::boxAt(corner, {1, 1, 1});
    });
  };
  check(spot(601, 0));
  check(spot(900, 50));
  TestRun run(GetParam(), {bestIsa(), GetParam().traits.parallel ? 3 : 1});
  run.start(spot(601, 0));
  run.step(spot(601, 0));
  const auto counters = countersOf(run.broadPhase());
  EXPECT_EQ(counters.at("pairs decided by their boxes"), counters.at("tests"));
  EXPECT_EQ(counters.at("tests"), 601U * 600U / 2);
}

TEST_P(ColumnsFamily, CopeWithEveryNumberOfBodies) {
  for (std::size_t n = 0; n <= 70; ++n) {
    const std::vector<Aabb> boxes = inputs::touching(n, 0, n);
    TestRun run(GetParam(), {bestIsa(), GetParam().traits.parallel ? 3 : 1}, {{"copy_cost", "1"}});
    run.start(boxes);
    ASSERT_EQ(sorted(run.step(boxes)), bruteForcePairs(boxes)) << n;
  }
}

// As many as are kept past the caches, and more.
TEST_P(ColumnsFamily, FindTheRightPairsOfAMillionBodies) {
  const std::vector<Aabb> boxes = inputs::uniform(1'000'000, 0, 1);
  TestRun run(GetParam(), {bestIsa(), GetParam().traits.parallel ? 2 : 1});
  run.start(boxes);
  ASSERT_EQ(sorted(run.step(boxes)), sweptPairs(boxes));
}

// One giant over all, and a plate on every axis, are copied into every column, and nothing else is.
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
  TestRun run(GetParam(), {bestIsa(), 1}, {{"copy_cost", "5"}});
  run.start(boxes);
  run.step(boxes);
  const Counters counters = countersOf(run.broadPhase());
  EXPECT_GT(counters.at("columns"), 20U);
  EXPECT_LT(counters.at("copies"), 2 * boxes.size() + 4 * counters.at("columns"));
}

/// Small boxes where the sample of the root looks, and plates elsewhere: as the columns choose it.
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

TEST_P(ColumnsFamily, DoNotCopyWithoutLimit) {
  const std::vector<Aabb> boxes = misleading(4000);
  TestRun run(GetParam(), {bestIsa(), 1}, {{"copy_cost", "1"}});
  run.start(boxes);
  EXPECT_EQ(sorted(run.step(boxes)), sweptPairs(boxes));
  EXPECT_LT(countersOf(run.broadPhase()).at("copies"), 10 * boxes.size());
}

// So many that they are kept past the caches.
TEST_P(ColumnsFamily, FindTheRightPairsOfVeryManyBoxes) {
  const std::vector<Aabb> boxes = inputs::uniform((std::size_t{1} << 17) + 3, 0, 1);
  TestRun run(GetParam(), {bestIsa(), GetParam().traits.parallel ? 2 : 1});
  run.start(inputs::uniform(boxes.size(), 1, 1));
  ASSERT_EQ(sorted(run.step(boxes)), sweptPairs(boxes));
}

TEST_P(ColumnsFamily, SplitCrowdedColumns) {
  std::vector<Aabb> boxes = inputs::clustered(20'000, 1, 1);
  for (std::size_t i = 0; i < boxes.size(); i += 2) {
    for (int axis = 0; axis < 3; ++axis) {
      boxes[i].min[axis] += 1e5F;
      boxes[i].max[axis] += 1e5F;
    }
  }
  TestRun run(GetParam(), {bestIsa(), 1});
  run.start(boxes);
  EXPECT_EQ(sorted(run.step(boxes)), sweptPairs(boxes));
  EXPECT_EQ(run.broadPhase().validate(), "");
  const Counters counters = countersOf(run.broadPhase());
  EXPECT_GE(counters.at("split columns"), 2U);
  EXPECT_LT(counters.at("tests"), 150 * boxes.size());
  // Their own columns are drawn in their place, a level further down.
  const RecordedDrawing drawing = drawingOf(run.broadPhase());
  EXPECT_TRUE(std::ranges::any_of(drawing.boxes(), [](const auto& box) { return box.level == 1; }));
  EXPECT_LE(drawing.boxes().size(), counters.at("columns"));
  EXPECT_GE(populationOf(drawing), boxes.size());
}

TEST_P(ColumnsFamily, ReportPairsInTheSameOrderForEveryTeam) {
  if (!GetParam().traits.parallel) GTEST_SKIP() << "uses one thread";
  for (const std::vector<Aabb>& boxes :
       {inputs::uniform(3000, 1, 1), clusters(3000, 1, 1), inputs::assorted(3000, 1, 1),
        inputs::uniform(150'000, 1, 1)}) {  // so many are kept past the caches
    std::vector<Pair> first;
    for (const int threads : {1, 2, 3, 5, 8}) {
      TestRun run(GetParam(), {bestIsa(), threads}, {{"copy_cost", "5"}, {"split_threshold", "5"}});
      run.start(boxes);
      std::vector<Pair> pairs;
      for (const PairRun part : run.step(boxes))
        pairs.insert(pairs.end(), part.begin(), part.end());
      ASSERT_FALSE(pairs.empty());
      if (first.empty()) first = pairs;
      ASSERT_EQ(pairs, first) << threads << " threads";
    }
  }
}

std::vector<Algorithm> columnsFamily() {
  std::vector<Algorithm> all = pairFinders();
  std::erase_if(all, [](const Algorithm& algorithm) { return algorithm.family != "Columns"; });
  return all;
}

INSTANTIATE_TEST_SUITE_P(Algorithms, ColumnsFamily, testing::ValuesIn(columnsFamily()),
                         [](const auto& tested) { return testName(tested.param); });

}  // namespace
}  // namespace broadmark::tests
