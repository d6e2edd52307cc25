// Tide: what it does when few bodies move, when many do, and in between. That it finds the right
// pairs on all inputs, with its grid alone, too, is tested with all others.

#include <gtest/gtest.h>

#include <numeric>

#include "algorithms/runs.h"
#include "tide/cost_model.h"
#include "tide/kernels.h"
#include "tide/loose_grid.h"

namespace broadmark::tests {
namespace {

using tide::LooseGrid;

/// A box of any size from a grain to half the world, somewhere; now and then nowhere.
Aabb anything(inputs::Random& random) {
  if (random.integer(0, 9) == 0) return kEmptyBox;
  const float edge = std::exp2(random.uniform(-6, 5));
  return inputs::boxAt(random.inCube(60), {edge, edge * random.uniform(0.1F, 1), edge});
}

/// A step that seldom leads into another cell, or anywhere.
Aabb moved(const Aabb& box, inputs::Random& random) {
  if (isEmpty(box) || random.integer(0, 7) == 0) return anything(random);
  Aabb to = box;
  for (int axis = 0; axis < 3; ++axis) {
    const float step = random.uniform(-0.4F, 0.4F);
    to.min[axis] += step;
    to.max[axis] += step;
  }
  return to;
}

std::vector<Aabb> anyBoxes(std::size_t n, inputs::Random& random) {
  std::vector<Aabb> boxes(n);
  for (Aabb& box : boxes) box = anything(random);
  return boxes;
}

/// The frame that comes after this one if `movers` bodies move.
std::vector<Aabb> after(std::vector<Aabb> boxes, std::size_t movers, inputs::Random& random) {
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

const ParameterValues kGridOnly = algorithmOf("tide").traits.rare_parameters;

/// Each kind of answer, with the parameters.
std::vector<TestRun> runsOf(const ParameterValues& parameters) {
  std::vector<TestRun> runs;
  for (const AnswerKind answer : {AnswerKind::pairs, AnswerKind::events}) {
    runs.emplace_back(algorithmOf("tide"), Configuration{bestIsa(), 1, answer}, parameters);
  }
  return runs;
}

TEST(Tide, FindsBodiesOfAllSizesThatMoveNearAndFarComeAndGo) {
  constexpr std::size_t kBodies = 400;
  for (TestRun& run : runsOf(kGridOnly)) {
    inputs::Random random(1, 0);
    std::vector<Aabb> boxes = anyBoxes(kBodies, random);
    run.start(sceneFor(kBodies), boxes);
    for (int frame = 0; frame < 200; ++frame) {
      boxes = after(boxes, static_cast<std::size_t>(random.integer(0, frame % 10 == 0 ? 400 : 20)),
                    random);
      ASSERT_EQ(sorted(run.step(boxes)), bruteForcePairs(boxes)) << "frame " << frame;
      ASSERT_EQ(run.broadPhase().validate(), "") << "frame " << frame;
    }
  }
}

bool isInTheGrid(TestRun& run) { return countersOf(run.broadPhase()).contains("looks"); }

// Few, many for some frames, few again: the grid is built again once it would have paid.
TEST(Tide, ChangesOverWhenManyMoveAndBack) {
  constexpr std::size_t kBodies = 500;
  constexpr int kFirstOfMany = 3;
  constexpr int kLastOfMany = 7;
  for (TestRun& run : runsOf({})) {
    inputs::Random random(2, 0);
    std::vector<Aabb> boxes = anyBoxes(kBodies, random);
    run.start(sceneFor(kBodies), boxes);
    std::vector<int> built;
    for (int frame = 0; frame < 80; ++frame) {
      const bool many = frame >= kFirstOfMany && frame <= kLastOfMany;
      boxes = after(boxes, many ? 400 : 5, random);
      ASSERT_EQ(sorted(run.step(boxes)), bruteForcePairs(boxes)) << "frame " << frame;
      ASSERT_EQ(run.broadPhase().validate(), "") << "frame " << frame;
      if (countersOf(run.broadPhase()).at("grids built") > 0) built.push_back(frame);
      const bool is_built = !built.empty() && built[0] < frame;
      EXPECT_EQ(isInTheGrid(run), frame < kFirstOfMany || is_built) << "frame " << frame;
    }
    ASSERT_EQ(built.size(), 1U);
    EXPECT_GT(built[0], kLastOfMany + 1) << "too soon to have paid";
  }
}

// Boxes of several sizes are on several levels, all of which a move looks into: so it is sooner
// quicker to find all pairs anew.
TEST(Tide, ChangesOverWhereThatIsQuicker) {
  constexpr std::size_t kBodies = 4000;
  const auto stays_in_the_grid = [](inputs::Generator input, std::size_t movers) {
    TestRun run(algorithmOf("tide"), Configuration{bestIsa(), 1, AnswerKind::events});
    std::vector<Aabb> boxes = input(kBodies, 0, 1);
    run.start(boxes);
    for (int frame = 0; frame < 3; ++frame) {
      for (std::size_t body = 0; body < movers; ++body) {
        boxes[body].min[0] -= 0.125F;
        boxes[body].max[0] -= 0.125F;
      }
      EXPECT_EQ(sorted(run.step(boxes)), sweptPairs(boxes)) << "frame " << frame;
    }
    return isInTheGrid(run);
  };
  EXPECT_TRUE(stays_in_the_grid(inputs::uniform, kBodies / 20));
  EXPECT_TRUE(stays_in_the_grid(inputs::uniform, kBodies / 6));
  EXPECT_FALSE(stays_in_the_grid(inputs::uniform, kBodies / 2));
  EXPECT_TRUE(stays_in_the_grid(inputs::assorted, kBodies / 20));
  EXPECT_FALSE(stays_in_the_grid(inputs::assorted, kBodies / 6));
}

TEST(Tide, TellsHowManyBodiesItsCellsHold) {
  constexpr std::size_t kBodies = 400;
  for (TestRun& run : runsOf(kGridOnly)) {
    inputs::Random random(3, 0);
    std::vector<Aabb> boxes = anyBoxes(kBodies, random);
    run.start(sceneFor(kBodies), boxes);
    boxes = after(boxes, 20, random);
    run.step(boxes);
    const auto present = kBodies - static_cast<std::size_t>(std::ranges::count_if(boxes, isEmpty));
    EXPECT_EQ(populationOf(drawingOf(run.broadPhase())), present);
  }
}

TEST(Tide, LooksAtNothingWhereNothingMoves) {
  const std::vector<Aabb> boxes = inputs::uniform(1000, 0, 1);
  for (TestRun& run : runsOf({})) {
    run.start(boxes);
    ASSERT_EQ(sorted(run.step(boxes)), sweptPairs(boxes));
    const Counters counters = countersOf(run.broadPhase());
    EXPECT_EQ(counters.at("tests"), 0U);
    EXPECT_EQ(counters.at("looks"), 0U);
  }
}

// A grid for bodies far apart has too few cells once they crowd.
TEST(Tide, BuildsAnotherGridWhereBodiesCrowd) {
  constexpr std::size_t kBodies = 2000;
  const std::vector<Aabb> apart = inputs::uniform(kBodies, 0, 1);
  for (TestRun& run : runsOf(kGridOnly)) {
    run.start(apart);
    std::uint64_t built = 0;
    std::vector<std::uint64_t> tests;
    for (int frame = 1; frame <= 40; ++frame) {
      std::vector<Aabb> boxes = apart;
      const float share = std::max(0.04F, 1 - 0.05F * static_cast<float>(frame));
      for (Aabb& box : boxes) {
        const inputs::Vec3 corner = {box.min[0] * share, box.min[1] * share, box.min[2] * share};
        box = inputs::boxAt(corner, {0.02F, 0.02F, 0.02F});
        box.max[0] += 1e-5F * static_cast<float>(frame);  // all move, to the end
      }
      ASSERT_EQ(sorted(run.step(boxes)), sweptPairs(boxes)) << "frame " << frame;
      const Counters counters = countersOf(run.broadPhase());
      built += counters.at("grids built");
      tests.push_back(counters.at("tests"));
    }
    EXPECT_GE(built, 1U);
    EXPECT_LE(built, 5U);
    EXPECT_LT(tests.back(), 100 * kBodies) << "of a move with twice as many others than expected";
  }
}

// A frame from scratch takes 12 ns a body, one in the grid 71 for each that moves, and a grid 100 a
// body.
constexpr tide::Costs kRoundCosts = {
    .build = 100, .move = 35, .look = 36, .test = 13, .sampled = 0, .body = 12};

/// Of ten moves each; in one there was a giant.
constexpr std::array<tide::Work, tide::CostModel::kTries> kTries = [] {
  std::array<tide::Work, tide::CostModel::kTries> tries{};
  for (tide::Work& work : tries) work.looks = 10;
  tries[0].tests = 1'000'000;
  return tries;
}();

TEST(TideCosts, AGridPaysOnceAsMuchWasWasted) {
  constexpr std::size_t kBodies = 1000;
  constexpr std::size_t kFew = 50;
  tide::CostModel costs(kRoundCosts, 1, kBodies);
  costs.setGrid(kTries, 10);
  EXPECT_FALSE(costs.scratchIsQuicker(kFew));
  EXPECT_TRUE(costs.scratchIsQuicker(4 * kFew));
  for (int frame = 0; frame < 2; ++frame) {
    for (int quiet = 1; quiet <= 11; ++quiet) EXPECT_FALSE(costs.gridPays(kFew)) << quiet;
    EXPECT_TRUE(costs.gridPays(kFew));
    costs.setGrid(kTries, 10);
  }
  for (int quiet = 1; quiet <= 11; ++quiet) costs.gridPays(kFew);
  costs.gridPays(kBodies);
  EXPECT_FALSE(costs.gridPays(kFew)) << "frames in which many move speak against it";
}

TEST(TideCosts, AnotherGridPaysOnceMovesHaveBecomeDear) {
  constexpr std::size_t kBodies = 1000;
  tide::CostModel costs(kRoundCosts, 1, kBodies);
  costs.setGrid(kTries, 10);
  for (int frame = 0; frame < 100; ++frame) {
    EXPECT_FALSE(costs.anotherGridPays({.looks = 100, .tests = 900}, 0, 100)) << "not dear yet";
  }
  EXPECT_TRUE(costs.anotherGridPays({.looks = 1000, .tests = 100'000}, 0, 1000));
}

TEST(TideCosts, LearnFromFramesInWhichManyMove) {
  constexpr std::size_t kBodies = 1000;
  constexpr tide::Work kDear = {.looks = 1000, .tests = 30'000};
  tide::CostModel costs(kRoundCosts, 1, kBodies);
  costs.setGrid(kTries, 10);
  for (int frame = 0; frame < 100; ++frame) costs.anotherGridPays({.tests = 90'000}, 0, 10);
  EXPECT_FALSE(costs.scratchIsQuicker(100)) << "too few moved to tell";
  costs.anotherGridPays(kDear, 0, 1000);
  EXPECT_FALSE(costs.scratchIsQuicker(100)) << "that may be a single giant";
  for (int frame = 0; frame < 10; ++frame) costs.anotherGridPays(kDear, 0, 1000);
  EXPECT_TRUE(costs.scratchIsQuicker(100));

  int frames = 1;
  while (!costs.gridPays(100) && frames < 10'000) ++frames;
  EXPECT_GT(frames, 100) << "a grid is built in vain, and too often";
  EXPECT_LT(frames, 1000) << "what was learnt is never forgotten";
}

/// Drives a grid through frames of its own.
class LooseGridTest : public testing::Test {
 protected:
  /// Checks the events of a frame against both sets of pairs.
  void step(LooseGrid& grid, const std::vector<Aabb>& before, const std::vector<Aabb>& now) {
    std::vector<std::uint32_t> changed;
    for (std::uint32_t body = 0; body < now.size(); ++body) {
      if (!sameBits(before[body], now[body])) changed.push_back(body);
    }
    PairBuffer began;
    PairBuffer ended;
    grid.addMoves(changed, now);
    grid.search({}, began, ended);
    grid.settle();
    ASSERT_EQ(grid.validate(), "");
    EXPECT_EQ(sortedList(began.run()), without(bruteForcePairs(now), bruteForcePairs(before)));
    EXPECT_EQ(sortedList(ended.run()), without(bruteForcePairs(before), bruteForcePairs(now)));
  }

  static std::vector<Pair> sortedList(PairRun run) {
    std::vector<Pair> pairs(run.begin(), run.end());
    std::ranges::sort(pairs);
    return pairs;
  }
  static std::vector<Pair> without(const std::vector<Pair>& pairs,
                                   const std::vector<Pair>& others) {
    std::vector<Pair> rest;
    std::ranges::set_difference(pairs, others, std::back_inserter(rest));
    return rest;
  }
};

TEST_F(LooseGridTest, TellsEachEventOnce) {
  constexpr std::size_t kBodies = 300;
  inputs::Random random(3, 0);
  std::vector<Aabb> boxes = anyBoxes(kBodies, random);
  LooseGrid grid(bestIsa());
  grid.build(boxes);
  for (int frame = 0; frame < 180; ++frame) {
    const std::vector<Aabb> before = boxes;
    boxes = after(boxes, frame % 7 == 0 ? 2 * kBodies : 30, random);
    step(grid, before, boxes);
    if (HasFailure()) return;
  }
}

// Crowded cells have many lines.
TEST_F(LooseGridTest, CopesWithCrowds) {
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

// Bounds of any kind: a byte that is one too large is enough to be missed.
TEST(TideKernels, FindThoseWithinLimits) {
  constexpr std::uint32_t kLooks = 500;
  inputs::Random random(4, 0);
  const auto any_bounds = [&](int least) {
    tide::Bounds bounds = 0;
    for (const int byte : {0, 1, 2, 4, 5, 6}) {
      bounds |= static_cast<tide::Bounds>(random.integer(least, 127)) << 8 * byte;
    }
    return bounds;
  };
  std::vector<tide::Line> lines(std::size_t{tide::Look::kLines} * kLooks);
  for (tide::Line& line : lines) {
    const int bodies = random.integer(0, tide::Line::kPlaces);
    for (int place = 0; place < bodies; ++place) line.bounds[place] = any_bounds(0);
    for (std::uint32_t& body : line.bodies) body = static_cast<std::uint32_t>(random.integer(0, 9));
    if (random.integer(0, 9) == 0) line.next = 7;
  }
  std::vector<tide::Look> looks(kLooks);
  for (std::uint32_t look = 0; look < kLooks; ++look) {
    looks[look].wanted = 0;
    for (std::uint32_t i = 0; i < tide::Look::kLines; ++i) {
      looks[look].lines[i] = &lines[tide::Look::kLines * look + i];
      looks[look].limits[i] = any_bounds(random.integer(0, 127));
      if (random.integer(0, 3) != 0) looks[look].wanted |= tide::Look::kLine << 8 * i;
    }
  }
  constexpr std::uint32_t kFirstLook = 5;
  for (const Isa isa : supportedIsas()) {
    SCOPED_TRACE(isaName(isa));
    std::vector<tide::Hit> hits(kLooks);
    std::vector<tide::Hit> followed(kLooks);
    const tide::Kernels::Found found =
        tide::kernels(isa).look(looks.data(), kLooks, kFirstLook, hits.data(), followed.data());
    std::size_t hit = 0;
    std::size_t next = 0;
    for (std::uint32_t look = 0; look < kLooks; ++look) {
      std::uint64_t places = 0;
      std::uint64_t behind = 0;
      for (std::uint32_t i = 0; i < tide::Look::kLines; ++i) {
        if ((looks[look].wanted >> 8 * i & 0xFF) == 0) continue;
        const tide::Line& line = *looks[look].lines[i];
        for (std::uint32_t place = 0; place < tide::Line::kPlaces; ++place) {
          if (tide::areWithin(line.bounds[place], looks[look].limits[i])) {
            places |= std::uint64_t{1} << (8 * i + place);
          }
        }
        if (line.next != tide::kNowhere)
          behind |= tide::Look::kFollowed & std::uint64_t{0xFF} << 8 * i;
      }
      if (places != 0) {
        ASSERT_LT(hit, found.hits);
        EXPECT_EQ(hits[hit].look, kFirstLook + look);
        EXPECT_EQ(hits[hit++].places, places);
      }
      if (behind != 0) {
        ASSERT_LT(next, found.followed);
        EXPECT_EQ(followed[next].look, kFirstLook + look);
        EXPECT_EQ(followed[next++].places, behind);
      }
    }
    EXPECT_EQ(hit, found.hits);
    EXPECT_EQ(next, found.followed);
    EXPECT_GT(hit, kLooks / 20) << "or too little was tested";
    EXPECT_LT(hit, kLooks);
  }
}

// At the ends of what a float can hold, and where all bodies are one point.
TEST_F(LooseGridTest, NeedsNoBounds) {
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
    const std::vector<Aabb> nobody(n, kEmptyBox);
    const std::vector<Aabb> all(n, inputs::boxAt({5, 5, 5}, {1, 1, 1}));
    LooseGrid grid(bestIsa());
    grid.build(nobody);
    step(grid, nobody, all);
    step(grid, all, nobody);
    step(grid, nobody, nobody);
    std::vector<Aabb> boxes;
    grid.boxes(boxes);
    EXPECT_EQ(boxes, nobody);
  }
}

}  // namespace
}  // namespace broadmark::tests
