// Tide when few bodies move, when many bodies move, and when it switches between its modes. The
// tests of all algorithms check its pairs on all inputs, also with the grid only.

#include <gtest/gtest.h>

#include <numeric>

#include "algorithms/runs.h"
#include "tide/cost_model.h"
#include "tide/kernels.h"
#include "tide/loose_grid.h"

namespace broadmark::tests {
namespace {

using tide::LooseGrid;

/// A box of a random size from 2^-6 to half the world, at a random position; sometimes empty.
Aabb randomBox(inputs::Random& random) {
  if (random.integer(0, 9) == 0) return kEmptyBox;
  const float edge = std::exp2(random.uniform(-6, 5));
  return inputs::boxAt(random.inCube(60), {edge, edge * random.uniform(0.1F, 1), edge});
}

/// A small step, which seldom changes the cell; sometimes a new random box.
Aabb moved(const Aabb& box, inputs::Random& random) {
  if (isEmpty(box) || random.integer(0, 7) == 0) return randomBox(random);
  Aabb to = box;
  for (int axis = 0; axis < 3; ++axis) {
    const float step = random.uniform(-0.4F, 0.4F);
    to.min[axis] += step;
    to.max[axis] += step;
  }
  return to;
}

std::vector<Aabb> randomBoxes(std::size_t n, inputs::Random& random) {
  std::vector<Aabb> boxes(n);
  for (Aabb& box : boxes) box = randomBox(random);
  return boxes;
}

/// Moves up to `movers` random bodies.
std::vector<Aabb> withMovers(std::vector<Aabb> boxes, std::size_t movers, inputs::Random& random) {
  for (std::size_t i = 0; i < movers; ++i) {
    Aabb& box =
        boxes[static_cast<std::size_t>(random.integer(0, static_cast<int>(boxes.size()) - 1))];
    box = moved(box, random);
  }
  return boxes;
}

SceneInfo sceneFor(std::size_t bodies) {
  SceneInfo scene;
  scene.objects = static_cast<std::uint32_t>(bodies);
  scene.all_present = false;
  return scene;
}

const ParameterValues kGridOnly = algorithmOf("tide").traits.rare_parameters.front();
const ParameterValues kCandidates = algorithmOf("tide").traits.rare_parameters.back();

/// One for each kind of answer.
std::vector<TestRun> testRuns(const ParameterValues& parameters) {
  std::vector<TestRun> test_runs;
  for (const AnswerKind answer : {AnswerKind::pairs, AnswerKind::events}) {
    test_runs.emplace_back(algorithmOf("tide"), Configuration{bestIsa(), 1, answer}, parameters);
  }
  return test_runs;
}

TEST(Tide, FindsBodiesOfAllSizesThatMoveAppearAndVanish) {
  constexpr std::size_t kBodies = 400;
  for (TestRun& test_run : testRuns(kGridOnly)) {
    inputs::Random random(1, 0);
    std::vector<Aabb> boxes = randomBoxes(kBodies, random);
    test_run.start(sceneFor(kBodies), boxes);
    for (int frame = 0; frame < 200; ++frame) {
      boxes = withMovers(
          boxes, static_cast<std::size_t>(random.integer(0, frame % 10 == 0 ? 400 : 20)), random);
      ASSERT_EQ(sorted(test_run.step(boxes)), bruteForcePairs(boxes)) << "frame " << frame;
      ASSERT_EQ(test_run.broadPhase().validate(), "") << "frame " << frame;
    }
  }
}

bool usesCandidates(TestRun& test_run) {
  return countersOf(test_run.broadPhase()).contains("candidates");
}

/// All bodies creep, each in a direction of its own.
void creep(std::vector<Aabb>& boxes, float step) {
  for (std::size_t body = 0; body < boxes.size(); ++body) {
    for (int axis = 0; axis < 3; ++axis) {
      const float move = (body >> axis & 1) != 0 ? step : -step;
      boxes[body].min[axis] += move;
      boxes[body].max[axis] += move;
    }
  }
}

// Bodies that creep: a search serves many frames. Then one of them jumps in each frame.
TEST(Tide, TestsCandidatesWhereBodiesCreep) {
  constexpr std::size_t kBodies = 2000;
  bool reports_events = false;
  for (TestRun& test_run : testRuns({})) {
    std::vector<Aabb> boxes = inputs::uniform(kBodies, 0, 1);
    test_run.start(sceneFor(kBodies), boxes);
    std::uint64_t searches = 0;
    for (int frame = 0; frame < 60; ++frame) {
      creep(boxes, 0.002F);
      ASSERT_EQ(sorted(test_run.step(boxes)), bruteForcePairs(boxes)) << "frame " << frame;
      ASSERT_EQ(test_run.broadPhase().validate(), "") << "frame " << frame;
      EXPECT_EQ(usesCandidates(test_run), frame >= 2) << "frame " << frame;
      if (usesCandidates(test_run)) searches += countersOf(test_run.broadPhase()).at("searches");
    }
    EXPECT_LE(searches, 6U);
    inputs::Random random(3, 0);
    for (int frame = 0; frame < 60; ++frame) {
      creep(boxes, 0.002F);
      boxes[17] = inputs::boxAt(random.inCube(20), {1, 1, 1});
      ASSERT_EQ(sorted(test_run.step(boxes)), bruteForcePairs(boxes)) << "frame " << frame;
    }
    EXPECT_TRUE(reports_events || !usesCandidates(test_run)) << "each frame needs a search";
    reports_events = true;  // the second run
  }
}

// One that vanishes while all creep, and comes back with another filter, is found by a new search.
TEST(Tide, TestsCandidatesWithBodiesThatComeAndGo) {
  constexpr std::size_t kBodies = 60;
  for (TestRun& test_run : testRuns(kCandidates)) {
    inputs::Random random(4, 0);
    std::vector<Aabb> boxes = inputs::uniform(kBodies, 0, 1);
    std::vector<Aabb> hidden(kBodies, kEmptyBox);
    test_run.start(sceneFor(kBodies), boxes);
    for (int frame = 0; frame < 100; ++frame) {
      creep(boxes, frame % 20 < 10 ? 0.01F : -0.01F);
      const auto body = static_cast<std::size_t>(random.integer(0, kBodies - 1));
      if (frame % 3 == 0) std::swap(boxes[body], hidden[body]);
      ASSERT_EQ(sorted(test_run.step(boxes)), bruteForcePairs(boxes)) << "frame " << frame;
      ASSERT_EQ(test_run.broadPhase().validate(), "") << "frame " << frame;
    }
  }
}

bool usesGrid(TestRun& test_run) {
  return countersOf(test_run.broadPhase()).contains("cell queries");
}

// Few bodies move, then many, then few again: a grid is rebuilt once that pays.
TEST(Tide, SwitchesToFullSearchAndBack) {
  constexpr std::size_t kBodies = 500;
  constexpr int kFirstWithMany = 3;
  constexpr int kLastWithMany = 7;
  for (TestRun& test_run : testRuns({})) {
    inputs::Random random(2, 0);
    std::vector<Aabb> boxes = randomBoxes(kBodies, random);
    test_run.start(sceneFor(kBodies), boxes);
    std::vector<int> built;
    for (int frame = 0; frame < 80; ++frame) {
      const bool many = frame >= kFirstWithMany && frame <= kLastWithMany;
      boxes = withMovers(boxes, many ? 400 : 5, random);
      ASSERT_EQ(sorted(test_run.step(boxes)), bruteForcePairs(boxes)) << "frame " << frame;
      ASSERT_EQ(test_run.broadPhase().validate(), "") << "frame " << frame;
      if (countersOf(test_run.broadPhase()).at("grids built") > 0) built.push_back(frame);
      const bool is_built = !built.empty() && built[0] < frame;
      EXPECT_EQ(usesGrid(test_run), frame < kFirstWithMany || is_built) << "frame " << frame;
    }
    ASSERT_EQ(built.size(), 1U);
    EXPECT_GT(built[0], kLastWithMany + 1) << "built before it pays";
  }
}

// Boxes of several sizes occupy several levels, all of which a move queries: so a full search is
// cheaper at a lower number of moving bodies.
TEST(Tide, SwitchesToFullSearchWhereThatIsCheaper) {
  constexpr std::size_t kBodies = 4000;
  const auto stays_in_grid = [](inputs::Generator input, std::size_t movers) {
    TestRun test_run(algorithmOf("tide"), Configuration{bestIsa(), 1, AnswerKind::events});
    std::vector<Aabb> boxes = input(kBodies, 0, 1);
    test_run.start(boxes);
    for (int frame = 0; frame < 3; ++frame) {
      for (std::size_t body = 0; body < movers; ++body) {
        boxes[body].min[0] -= 0.125F;
        boxes[body].max[0] -= 0.125F;
      }
      EXPECT_EQ(sorted(test_run.step(boxes)), sweptPairs(boxes)) << "frame " << frame;
    }
    return usesGrid(test_run);
  };
  EXPECT_TRUE(stays_in_grid(inputs::uniform, kBodies / 20));
  EXPECT_TRUE(stays_in_grid(inputs::uniform, kBodies / 6));
  EXPECT_FALSE(stays_in_grid(inputs::uniform, kBodies / 2));
  EXPECT_TRUE(stays_in_grid(inputs::assorted, kBodies / 20));
  EXPECT_FALSE(stays_in_grid(inputs::assorted, kBodies / 6));
}

TEST(Tide, DrawsThePopulationOfItsCells) {
  constexpr std::size_t kBodies = 400;
  for (TestRun& test_run : testRuns(kGridOnly)) {
    inputs::Random random(3, 0);
    std::vector<Aabb> boxes = randomBoxes(kBodies, random);
    test_run.start(sceneFor(kBodies), boxes);
    boxes = withMovers(boxes, 20, random);
    test_run.step(boxes);
    const auto present = kBodies - static_cast<std::size_t>(std::ranges::count_if(boxes, isEmpty));
    EXPECT_EQ(populationOf(drawingOf(test_run.broadPhase())), present);
  }
}

TEST(Tide, DoesNothingWhenNothingMoves) {
  const std::vector<Aabb> boxes = inputs::uniform(1000, 0, 1);
  for (TestRun& test_run : testRuns({})) {
    test_run.start(boxes);
    ASSERT_EQ(sorted(test_run.step(boxes)), sweptPairs(boxes));
    const Counters counters = countersOf(test_run.broadPhase());
    EXPECT_EQ(counters.at("tests"), 0U);
    EXPECT_EQ(counters.at("cell queries"), 0U);
  }
}

// A grid built for spread bodies has too few cells once they are crowded.
TEST(Tide, RebuildsTheGridWhenBodiesCrowd) {
  constexpr std::size_t kBodies = 2000;
  const std::vector<Aabb> apart = inputs::uniform(kBodies, 0, 1);
  for (TestRun& test_run : testRuns(kGridOnly)) {
    test_run.start(apart);
    std::uint64_t built = 0;
    std::vector<std::uint64_t> tests;
    for (int frame = 1; frame <= 40; ++frame) {
      std::vector<Aabb> boxes = apart;
      const float share = std::max(0.04F, 1 - 0.05F * static_cast<float>(frame));
      for (Aabb& box : boxes) {
        const inputs::Vec3 corner = {box.min[0] * share, box.min[1] * share, box.min[2] * share};
        box = inputs::boxAt(corner, {0.02F, 0.02F, 0.02F});
        box.max[0] += 1e-5F * static_cast<float>(frame);  // all bodies move in every frame
      }
      ASSERT_EQ(sorted(test_run.step(boxes)), sweptPairs(boxes)) << "frame " << frame;
      const Counters counters = countersOf(test_run.broadPhase());
      built += counters.at("grids built");
      tests.push_back(counters.at("tests"));
    }
    EXPECT_GE(built, 1U);
    EXPECT_LE(built, 5U);
    EXPECT_LT(tests.back(), 100 * kBodies) << "a move costs too many tests";
  }
}

// A full search takes 12 ns per body, a frame in the grid 71 ns per moving body, and a build 100 ns
// per body.
constexpr tide::Costs kRoundCosts = {
    .build = 100, .move = 35, .cell_query = 36, .test = 13, .body = 12, .layout = 0, .sampled = 0};

/// Ten moves each, one of them of a very large body.
constexpr std::array<tide::WorkCounts, tide::CostModel::kCalibrationBatches> kBatches = [] {
  std::array<tide::WorkCounts, tide::CostModel::kCalibrationBatches> batches{};
  for (tide::WorkCounts& work : batches) work.cell_queries = 10;
  batches[0].tests = 1'000'000;
  return batches;
}();

TEST(TideCosts, AGridPaysOnceItsAbsenceHasCostAsMuch) {
  constexpr std::size_t kBodies = 1000;
  constexpr std::size_t kFew = 50;
  tide::CostModel costs(kRoundCosts, 1, kBodies);
  costs.calibrate(kBatches, 10);
  EXPECT_FALSE(costs.fullSearchIsCheaper(kFew));
  EXPECT_TRUE(costs.fullSearchIsCheaper(4 * kFew));
  for (int frame = 0; frame < 2; ++frame) {
    for (int quiet = 1; quiet <= 11; ++quiet) EXPECT_FALSE(costs.gridPays(kFew)) << quiet;
    EXPECT_TRUE(costs.gridPays(kFew));
    costs.calibrate(kBatches, 10);
  }
  for (int quiet = 1; quiet <= 11; ++quiet) costs.gridPays(kFew);
  costs.gridPays(kBodies);
  EXPECT_FALSE(costs.gridPays(kFew)) << "a frame in which many bodies move counts against the grid";
}

TEST(TideCosts, ARebuildPaysOnceMovesHaveBecomeExpensive) {
  constexpr std::size_t kBodies = 1000;
  tide::CostModel costs(kRoundCosts, 1, kBodies);
  costs.calibrate(kBatches, 10);
  for (int frame = 0; frame < 100; ++frame) {
    EXPECT_FALSE(costs.rebuildPays({.cell_queries = 100, .tests = 900}, 0, 100))
        << "not expensive yet";
  }
  EXPECT_TRUE(costs.rebuildPays({.cell_queries = 1000, .tests = 100'000}, 0, 1000));
}

TEST(TideCosts, LearnFromFramesInWhichManyMove) {
  constexpr std::size_t kBodies = 1000;
  constexpr tide::WorkCounts kExpensive = {.cell_queries = 1000, .tests = 30'000};
  tide::CostModel costs(kRoundCosts, 1, kBodies);
  costs.calibrate(kBatches, 10);
  for (int frame = 0; frame < 100; ++frame) costs.rebuildPays({.tests = 90'000}, 0, 10);
  EXPECT_FALSE(costs.fullSearchIsCheaper(100)) << "too few moves to learn from";
  costs.rebuildPays(kExpensive, 0, 1000);
  EXPECT_FALSE(costs.fullSearchIsCheaper(100)) << "this may be a single very large body";
  for (int frame = 0; frame < 10; ++frame) costs.rebuildPays(kExpensive, 0, 1000);
  EXPECT_TRUE(costs.fullSearchIsCheaper(100));

  int frames = 1;
  while (!costs.gridPays(100) && frames < 10'000) ++frames;
  EXPECT_GT(frames, 100) << "wasted builds are too frequent";
  EXPECT_LT(frames, 1000) << "the learnt cost does not decay";
}

/// Steps a grid without Tide around it.
class LooseGridTest : public testing::Test {
 protected:
  /// Checks the events against the pairs before and after the frame.
  void step(LooseGrid& grid, const std::vector<Aabb>& before, const std::vector<Aabb>& now) {
    std::vector<std::uint32_t> changed;
    for (std::uint32_t body = 0; body < now.size(); ++body) {
      if (!sameBits(before[body], now[body])) changed.push_back(body);
    }
    PairBuffer began;
    PairBuffer ended;
    grid.moveBodies(changed, now);
    grid.findEvents({}, began, ended);
    grid.endFrame();
    ASSERT_EQ(grid.validate(), "");
    EXPECT_EQ(sortedList(began.run()), difference(bruteForcePairs(now), bruteForcePairs(before)));
    EXPECT_EQ(sortedList(ended.run()), difference(bruteForcePairs(before), bruteForcePairs(now)));
  }

  static std::vector<Pair> sortedList(PairRun pairs) {
    std::vector<Pair> list(pairs.begin(), pairs.end());
    std::ranges::sort(list);
    return list;
  }
  static std::vector<Pair> difference(const std::vector<Pair>& pairs,
                                      const std::vector<Pair>& others) {
    std::vector<Pair> result;
    std::ranges::set_difference(pairs, others, std::back_inserter(result));
    return result;
  }
};

TEST_F(LooseGridTest, EmitsEachEventOnce) {
  constexpr std::size_t kBodies = 300;
  inputs::Random random(3, 0);
  std::vector<Aabb> boxes = randomBoxes(kBodies, random);
  LooseGrid grid(bestIsa());
  grid.build(boxes);
  for (int frame = 0; frame < 180; ++frame) {
    const std::vector<Aabb> before = boxes;
    boxes = withMovers(boxes, frame % 7 == 0 ? 2 * kBodies : 30, random);
    step(grid, before, boxes);
    if (HasFailure()) return;
  }
}

TEST_F(LooseGridTest, HandlesOverflowBuckets) {
  for (const Isa isa : supportedIsas()) {
    SCOPED_TRACE(isaName(isa));
    std::vector<Aabb> boxes = inputs::identical(700, 0, 1);
    LooseGrid grid(isa);
    grid.build(boxes);
    for (int frame = 0; frame < 4; ++frame) {
      const std::vector<Aabb> before = boxes;
      for (std::size_t body = 0; body < boxes.size(); body += 50) {
        boxes[body] = frame % 2 == 0 ? inputs::boxAt({1e6F, 0, 0}, {1, 1, 1}) : boxes[1];
      }
      step(grid, before, boxes);
      if (HasFailure()) return;
    }
  }
}

// Random bounds: a single byte that is too large by one is a miss.
TEST(TideKernels, FindOverlappingBounds) {
  constexpr std::uint32_t kQueries = 500;
  inputs::Random random(4, 0);
  const auto random_bounds = [&](int min) {
    tide::PackedBounds bounds = 0;
    for (const int byte : {0, 1, 2, 4, 5, 6}) {
      bounds |= static_cast<tide::PackedBounds>(random.integer(min, 127)) << 8 * byte;
    }
    return bounds;
  };
  std::vector<tide::CellBucket> buckets(std::size_t{tide::CellQuery::kBuckets} * kQueries);
  for (tide::CellBucket& bucket : buckets) {
    const int bodies = random.integer(0, tide::CellBucket::kSlots);
    for (int slot = 0; slot < bodies; ++slot) bucket.bounds[slot] = random_bounds(0);
    for (std::uint32_t& body : bucket.bodies)
      body = static_cast<std::uint32_t>(random.integer(0, 9));
    if (random.integer(0, 9) == 0) bucket.next = 7;
  }
  std::vector<tide::CellQuery> queries(kQueries);
  for (std::uint32_t query = 0; query < kQueries; ++query) {
    queries[query].active = 0;
    for (std::uint32_t i = 0; i < tide::CellQuery::kBuckets; ++i) {
      queries[query].buckets[i] = &buckets[tide::CellQuery::kBuckets * query + i];
      queries[query].packed[i] = random_bounds(random.integer(0, 127));
      if (random.integer(0, 3) != 0) queries[query].active |= tide::CellQuery::kBucketBits << 8 * i;
    }
  }
  constexpr std::uint32_t kFirstQuery = 5;
  for (const Isa isa : supportedIsas()) {
    SCOPED_TRACE(isaName(isa));
    std::vector<tide::Hit> hits(kQueries);
    std::vector<tide::Hit> overflows(kQueries);
    const tide::Kernels::Counts counts = tide::kernels(isa).run_queries(
        queries.data(), kQueries, kFirstQuery, hits.data(), overflows.data());
    std::size_t hit = 0;
    std::size_t next = 0;
    for (std::uint32_t query = 0; query < kQueries; ++query) {
      std::uint64_t slots = 0;
      std::uint64_t overflow = 0;
      for (std::uint32_t i = 0; i < tide::CellQuery::kBuckets; ++i) {
        if ((queries[query].active >> 8 * i & 0xFF) == 0) continue;
        const tide::CellBucket& bucket = *queries[query].buckets[i];
        for (std::uint32_t slot = 0; slot < tide::CellBucket::kSlots; ++slot) {
          if (tide::packedOverlap(bucket.bounds[slot], queries[query].packed[i])) {
            slots |= std::uint64_t{1} << (8 * i + slot);
          }
        }
        if (bucket.next != tide::kInvalidIndex)
          overflow |= tide::CellQuery::kOverflowBits & std::uint64_t{0xFF} << 8 * i;
      }
      if (slots != 0) {
        ASSERT_LT(hit, counts.hits);
        EXPECT_EQ(hits[hit].query, kFirstQuery + query);
        EXPECT_EQ(hits[hit++].bits, slots);
      }
      if (overflow != 0) {
        ASSERT_LT(next, counts.overflows);
        EXPECT_EQ(overflows[next].query, kFirstQuery + query);
        EXPECT_EQ(overflows[next++].bits, overflow);
      }
    }
    EXPECT_EQ(hit, counts.hits);
    EXPECT_EQ(next, counts.overflows);
    EXPECT_GT(hit, kQueries / 20) << "too few queries hit to test anything";
    EXPECT_LT(hit, kQueries);
  }
}

// Near the limits of floats, and with all bodies at one point.
TEST_F(LooseGridTest, NeedsNoWorldBounds) {
  for (const inputs::Input& input : inputs::kAll) {
    SCOPED_TRACE(input.name);
    std::vector<Aabb> boxes = input.boxes(100, 0, 1);
    LooseGrid grid(bestIsa());
    grid.build(boxes);
    for (std::uint32_t frame = 1; frame < 6; ++frame) {
      const std::vector<Aabb> before = boxes;
      boxes = input.boxes(100, frame, 1);
      if (frame % 2 == 0) boxes[7] = inputs::boxAt({-3e38F, 2e38F, 0}, {1e38F, 0, 3e38F});
      step(grid, before, boxes);
      if (HasFailure()) return;
    }
  }
}

TEST_F(LooseGridTest, MayBeEmpty) {
  for (const std::size_t n : {0U, 1U, 2U}) {
    const std::vector<Aabb> absent(n, kEmptyBox);
    const std::vector<Aabb> present(n, inputs::boxAt({5, 5, 5}, {1, 1, 1}));
    LooseGrid grid(bestIsa());
    grid.build(absent);
    step(grid, absent, present);
    step(grid, present, absent);
    step(grid, absent, absent);
    std::vector<Aabb> boxes;
    grid.copyBoxes(boxes);
    EXPECT_EQ(boxes, absent);
  }
}

}  // namespace
}  // namespace broadmark::tests
