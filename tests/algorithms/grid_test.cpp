// The grid families and their components: cells, phantom bits, work shares.

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <set>

#include "algorithms/runs.h"
#include "cell_grid.h"
#include "work_shares.h"

namespace broadmark::tests {
namespace {

Aabb boundsOf(const std::vector<Aabb>& boxes) {
  Aabb bounds = boxes.front();
  for (const Aabb& box : boxes) bounds = merged(bounds, box);
  return bounds;
}

CellGrid gridOver(const std::vector<Aabb>& boxes, std::size_t cells, bool columns = false) {
  CellGrid grid;
  grid.fit(boxes, cells, columns);
  return grid;
}

/// Cubes with edges of 8 or 0.5 in a cube of edge 30: most pairs share several cells.
std::vector<Aabb> large(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  return inputs::generate(n, frame, seed, [&](inputs::Random& random, std::size_t i) {
    const float edge = i % 4 == 0 ? 8.0F : 0.5F;
    return inputs::boxAt(random.inCube(30), {edge, edge, edge});
  });
}

TEST(CellGrid, NothingAndOneThingAreOneCell) {
  CellGrid grid;
  grid.fit({}, 100, false);
  EXPECT_EQ(grid.size(), 1U);
  EXPECT_EQ(gridOver(inputs::identical(50, 0, 1), 100).size(), 1U);
  EXPECT_EQ(gridOver({inputs::boxAt({1, 2, 3}, {0, 0, 0})}, 100).size(), 1U);
}

TEST(CellGrid, HasAboutAsManyCellsAsWanted) {
  const std::vector<Aabb> boxes = inputs::uniform(20'000, 0, 1);
  for (const std::size_t cells : {1U, 8U, 27U, 500U}) {
    for (const bool columns : {false, true}) {
      const std::size_t size = gridOver(boxes, cells, columns).size();
      EXPECT_LE(size, cells * 3 / 2);
      EXPECT_GE(size, cells / 2);
    }
  }
}

TEST(CellGrid, ColumnsAreNotCutOnY) {
  const CellGrid grid = gridOver(inputs::uniform(20'000, 0, 1), 100, true);
  EXPECT_EQ(grid.counts()[0], 10);
  EXPECT_EQ(grid.counts()[1], 1);
  EXPECT_EQ(grid.counts()[2], 10);
}

TEST(CellGrid, FlatScenesAreCutWhereTheyExtend) {
  const CellGrid grid = gridOver(inputs::onePlane(20'000, 0, 1), 100);
  EXPECT_EQ(grid.counts()[0], 10);
  EXPECT_EQ(grid.counts()[1], 10);
  EXPECT_EQ(grid.counts()[2], 1);
}

// A body that has fallen out of the world must not put all others into a single cell.
TEST(CellGrid, IsNotStretchedByABodyFarOff) {
  std::vector<Aabb> boxes = inputs::uniform(5000, 0, 1);
  boxes[1234] = inputs::boxAt({0, -1e9F, 0}, {1, 1, 1});
  const CellGrid grid = gridOver(boxes, 64);
  std::map<std::size_t, int> bodies;
  for (const Aabb& box : boxes) {
    grid.forEachCell(grid.touched(box), [&](std::size_t cell, CellBody) { ++bodies[cell]; });
  }
  int fullest = 0;
  for (const auto& [cell, count] : bodies) fullest = std::max(fullest, count);
  EXPECT_GE(bodies.size(), 48U);
  EXPECT_LT(fullest, 400);
}

// A huge box must not make all cells huge.
TEST(CellGrid, IsNotCoarsenedByAHugeBox) {
  std::vector<Aabb> boxes = inputs::uniform(200, 0, 1);
  boxes[100] = inputs::boxAt({-1e6F, -1e6F, -1e6F}, {2e6F, 2e6F, 2e6F});
  const CellGrid grid = gridOver(boxes, 64);
  EXPECT_GE(grid.size(), 48U);
  EXPECT_EQ(grid.touched(boxes[100]).count(), grid.size());
}

// Shapes of objects alternate by number; a sample with a stride could contain only one shape.
TEST(CellGrid, SeesAllShapesThatComeInTurn) {
  std::vector<Aabb> boxes;
  for (std::size_t i = 0; i < 20'480; ++i) {
    const float edge = i % 80 == 0 ? 0.1F : 4.0F;
    const auto x = static_cast<float>(i * 7919 % 20'480) * 0.01F;
    boxes.push_back(inputs::boxAt({x, 0, 0}, {edge, edge, edge}));
  }
  const CellGrid grid = gridOver(boxes, 20'480);
  EXPECT_LE(grid.counts()[0], 205 / 7);  // cells are nearly twice as long as most boxes, or more
}

/// The number of common cells in which a pair would be reported.
int timesReported(const CellGrid& grid, const Aabb& a, const Aabb& b) {
  std::map<std::size_t, CellBody> cells;
  grid.forEachCell(grid.touched(a),
                   [&](std::size_t cell, CellBody phantoms) { cells.emplace(cell, phantoms); });
  int times = 0;
  grid.forEachCell(grid.touched(b), [&](std::size_t cell, CellBody phantoms) {
    const auto shared = cells.find(cell);
    if (shared != cells.end() && isHomeCellPair(shared->second, phantoms)) ++times;
  });
  return times;
}

TEST(CellGrid, EveryOverlappingPairIsReportedInExactlyOneCell) {
  std::vector<inputs::Input> all(inputs::kAll.begin(), inputs::kAll.end());
  all.push_back({"limits", inputs::limits});
  all.push_back({"large", large});
  for (const inputs::Input& input : all) {
    const std::vector<Aabb> boxes = input.boxes(200, 1, 5);
    for (const bool columns : {false, true}) {
      const CellGrid grid = gridOver(boxes, boxes.size(), columns);
      for (const Pair pair : bruteForcePairs(boxes)) {
        ASSERT_EQ(timesReported(grid, boxes[pair.a], boxes[pair.b]), 1) << input.name;
      }
    }
  }
}

TEST(CellGrid, CellsTileTheBounds) {
  const std::vector<Aabb> boxes = inputs::uniform(5000, 0, 1);
  const Aabb bounds = boundsOf(boxes);
  const CellGrid grid = gridOver(boxes, 64);
  ASSERT_EQ(grid.size(), 64U);
  double volume = 0;
  Aabb covered = grid.cell(0, bounds);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const Aabb cell = grid.cell(i, bounds);
    covered = merged(covered, cell);
    double cell_volume = 1;
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_LT(cell.min[axis], cell.max[axis]);
      cell_volume *= static_cast<double>(cell.max[axis]) - cell.min[axis];
    }
    volume += cell_volume;
  }
  EXPECT_EQ(covered, bounds);
  double expected = 1;
  for (int axis = 0; axis < 3; ++axis) expected *= double{bounds.max[axis]} - bounds.min[axis];
  EXPECT_NEAR(volume / expected, 1, 1e-4);
}

TEST(WorkShares, HoldEveryRowOnceAndTheSameWork) {
  for (const int threads : {1, 2, 3, 5}) {
    ThreadTeam team(threads);
    for (const std::uint32_t count : {0U, 1U, 63U, 64U, 65U, 10'007U}) {
      // A crowded cell after many sparse rows.
      std::vector<std::uint32_t> ends(count);
      for (std::uint32_t i = 0; i < count; ++i) ends[i] = i < count / 2 ? i + 1 : count;
      WorkShares shares;
      shares.measureRows(ends, team);
      std::size_t next = 0;
      std::uint64_t max = 0;
      std::uint64_t total = 0;
      for (int worker = 0; worker < threads; ++worker) {
        const Range rows = shares.of(worker);
        ASSERT_EQ(rows.begin, next);
        ASSERT_LE(rows.begin, rows.end);
        next = rows.end;
        std::uint64_t work = 0;
        for (std::size_t i = rows.begin; i < rows.end; ++i) work += ends[i] - i;
        max = std::max(max, work);
        total += work;
      }
      EXPECT_EQ(next, count);
      if (count > 10'000) {
        EXPECT_LT(static_cast<double>(max), 1.1 * static_cast<double>(total) / threads);
      }
    }
  }
}

class Grids : public testing::TestWithParam<Algorithm> {
 protected:
  /// A run with an unrelated initial pose.
  TestRun startedRun(const Configuration& config, const std::string& objects_per_cell,
                     std::size_t n) {
    TestRun test_run(GetParam(), config, {{"objects_per_cell", objects_per_cell}});
    SceneInfo scene;
    scene.objects = static_cast<std::uint32_t>(n);
    scene.world = {{-1, -1, -1, 0}, {1, 1, 1, 0}};  // most bodies are outside
    test_run.start(scene, inputs::clustered(n, 99, 1));
    return test_run;
  }

  /// Checks every configuration, with cells for one body, for a few, and for all.
  void check(const std::vector<Aabb>& boxes) {
    const std::vector<Pair> right = sweptPairs(boxes);
    for (const Configuration& config : configurations(GetParam())) {
      for (const std::string objects_per_cell : {"1", "10", "1000000000"}) {
        SCOPED_TRACE(describe(GetParam(), config) + ", objects_per_cell " + objects_per_cell);
        TestRun test_run = startedRun(config, objects_per_cell, boxes.size());
        ASSERT_EQ(sorted(test_run.step(boxes)), right);
        ASSERT_EQ(test_run.broadPhase().validate(), "");
        const Counters counters = countersOf(test_run.broadPhase());
        ASSERT_LE(counters.at("copies"), 8 * boxes.size());
        ASSERT_LE(counters.at("cells"), std::max<std::size_t>(boxes.size() * 5 / 2, 1));
      }
    }
  }
};

TEST_P(Grids, ReportPairsThatShareSeveralCellsOnce) {
  const std::vector<Aabb> boxes = large(600, 0, 1);
  ASSERT_GT(gridOver(boxes, 600).size(), 30U);
  check(boxes);
}

TEST_P(Grids, TestOneHugeBoxAmongManySmall) {
  std::vector<Aabb> boxes = inputs::uniform(1500, 0, 1);
  boxes[700] = inputs::boxAt({-1e6F, 3, -1e6F}, {2e6F, 17, 2e6F});  // a floor
  check(boxes);

  TestRun test_run = startedRun({bestIsa(), 1}, "10", boxes.size());
  test_run.step(boxes);
  EXPECT_EQ(countersOf(test_run.broadPhase()).at("large bodies"), 1U);
  EXPECT_GT(countersOf(test_run.broadPhase()).at("cells"), 100U);
}

// Bars along each axis: the mean box is long, yet all touch many cells.
TEST_P(Grids, KeepManyLongBoxesFewCopies) {
  check(inputs::generate(400, 0, 1, [](inputs::Random& random, std::size_t i) {
    inputs::Vec3 edges = {0.1F, 0.1F, 0.1F};
    edges[i % 3] = random.uniform(10, 50);
    return inputs::boxAt(random.inCube(60), edges);
  }));
}

TEST_P(Grids, CopeWithBoxesOfAllSizes) {
  check(inputs::generate(500, 0, 1, [](inputs::Random& random, std::size_t i) {
    const float edge = std::pow(2.0F, static_cast<float>(i % 16) - 8);
    return inputs::boxAt(random.inCube(64), {edge, edge, edge});
  }));
}

TEST_P(Grids, CopeWithTheEndsOfTheRangeOfFloats) {
  check(inputs::limits(300, 0, 1));
  check({inputs::boxAt({0, 0, 0}, {1, 1, 1})});
  check({});
}

TEST_P(Grids, CopeWithABodyFarOff) {
  std::vector<Aabb> boxes = inputs::uniform(1000, 0, 1);
  boxes[500] = inputs::boxAt({0, -1e20F, 3e38F}, {1, 1, 1});
  boxes[501] = boxes[500];
  check(boxes);
}

// The original missed pairs if the number of bodies was not divisible by the number of threads, and
// had a data race if a cell had more than a thread's share.
TEST_P(Grids, LoseNothingWhateverTheTeam) {
  if (!GetParam().traits.parallel) GTEST_SKIP() << "uses one thread";
  for (const std::size_t n : {5U, 1009U}) {
    for (const inputs::Generator boxes : {inputs::uniform, inputs::clustered, inputs::identical}) {
      const std::vector<Aabb> frame = boxes(n, 1, 3);
      const std::vector<Pair> right = bruteForcePairs(frame);
      for (const int threads : {1, 2, 3, 4, 5, 6, 7, 8, 13}) {
        TestRun test_run = startedRun({bestIsa(), threads}, "20", n);
        EXPECT_EQ(sorted(test_run.step(frame)), right) << threads << " threads, n = " << n;
      }
    }
  }
}

TEST_P(Grids, FindAllPairsOfALargerFrame) {
  constexpr std::size_t kCount = 20'000;
  for (const inputs::Generator boxes : {inputs::assorted, inputs::clustered}) {
    TestRun test_run(GetParam(), {bestIsa(), 3});
    test_run.start(boxes(kCount, 0, 1));
    const std::vector<Aabb> frame = boxes(kCount, 1, 1);
    EXPECT_EQ(sorted(test_run.step(frame)), sweptPairs(frame));
    EXPECT_GE(countersOf(test_run.broadPhase()).at("cells"), 12U);
  }
}

TEST_P(Grids, DrawCellsThatHoldSomething) {
  TestRun test_run = startedRun({bestIsa(), 1}, "1", 20'000);
  test_run.step(inputs::uniform(20'000, 0, 1));
  const std::size_t many = drawingOf(test_run.broadPhase()).boxes().size();
  EXPECT_GT(many, 500U);
  EXPECT_LE(many, std::min<std::size_t>(countersOf(test_run.broadPhase()).at("cells"), 10'000));

  // Two distant corners: two occupied cells.
  std::vector<Aabb> corners(8, inputs::boxAt({0, 0, 0}, {1, 1, 1}));
  std::fill_n(corners.begin(), 4, inputs::boxAt({90, 90, 90}, {1, 1, 1}));
  test_run.start(corners).step(corners);
  const RecordedDrawing two = drawingOf(test_run.broadPhase());
  ASSERT_EQ(two.boxes().size(), 2U);
  for (const RecordedDrawing::Box& drawn : two.boxes()) {
    EXPECT_EQ(merged(drawn.box, boundsOf(corners)), boundsOf(corners));
    EXPECT_NE(overlaps(drawn.box, corners.front()), overlaps(drawn.box, corners.back()));
    EXPECT_EQ(drawn.population, 4U);
  }
}

std::vector<Algorithm> grids() {
  std::vector<Algorithm> all = pairFinders();
  std::erase_if(all, [](const Algorithm& algorithm) {
    return algorithm.family != "Grid BF" && algorithm.family != "Grid SAP";
  });
  return all;
}

INSTANTIATE_TEST_SUITE_P(Algorithms, Grids, testing::ValuesIn(grids()),
                         [](const auto& tested) { return testName(tested.param); });

}  // namespace
}  // namespace broadmark::tests
