// Queries of the broad-phase library against brute force: on all torture inputs, in worlds that
// change, with any options; and their misuse.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "broadphase/query_oracle.h"

namespace broadmark::tests {
namespace {

using inputs::Input;
using inputs::Random;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kMax = std::numeric_limits<float>::max();

/// Queries at the corners and faces of bodies, between them and far away; casts along axes, into
/// corners and without direction.
QueryBatches queriesAbout(const BoxList& boxes, std::size_t count, std::uint64_t seed) {
  Random random(seed, 77);
  const auto any_box = [&]() -> const Aabb& {
    static const Aabb none{};
    return boxes.empty() ? none : random.anyOf(boxes);
  };
  const auto coordinate = [&](std::size_t axis) {
    const Aabb& box = any_box();
    if (isEmpty(box) || random.onceIn(20)) return random.anyOf(std::array{0.0F, -kMax, kMax, 1.0F});
    const float min = box.min[axis];
    const float max = box.max[axis];
    return random.anyOf(
        std::array{min, max, min * 0.5F + max * 0.5F,
                   std::clamp(random.uniform(0, 1) * min + random.uniform(0, 1) * max, -kMax, kMax),
                   std::nextafter(min, -kMax), std::nextafter(max, kMax)});
  };
  const auto layers = [&] {
    return random.anyOf(std::array{bp::kAllLayers, bp::kAllLayers, bp::kAllLayers, 1U, 6U, 0U});
  };
  const auto set_box = [&](bp::Box& box, bool is_point) {
    const Aabb& body = any_box();
    const bool is_body = !isEmpty(body) && !is_point && random.onceIn(3);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float a = coordinate(axis);
      const float b = is_point ? a : coordinate(axis);
      box.min[axis] = is_body ? body.min[axis] : std::min(a, b);
      box.max[axis] = is_body ? body.max[axis] : std::max(a, b);
    }
  };
  QueryBatches batches;
  for (std::size_t i = 0; i < count; ++i) {
    bp::BoxQuery query;
    set_box(query.box, random.onceIn(4));
    query.layers = layers();
    batches.boxes.push_back(query);

    bp::Cast cast;
    set_box(cast.box, random.onceIn(2));
    const bool is_parallel = random.onceIn(3);
    const std::size_t kept_axis = i % 3;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float to = coordinate(axis) - cast.box.min[axis];
      cast.direction[axis] = std::isfinite(to) ? to : kMax;
      if (is_parallel && axis != kept_axis) cast.direction[axis] = i % 2 == 0 ? 0.0F : -0.0F;
      if (random.onceIn(30)) cast.direction[axis] = 0;
      if (random.onceIn(60)) cast.direction[axis] = std::numeric_limits<float>::denorm_min();
    }
    cast.max_fraction = random.anyOf(std::array{1.0F, 1.0F, 0.5F, 0.0F, 100.0F, kInfinity});
    cast.layers = layers();
    batches.casts.push_back(cast);

    bp::NearestQuery point;
    for (std::size_t axis = 0; axis < 3; ++axis) point.point[axis] = coordinate(axis);
    point.count = random.anyOf(std::array{1U, 1U, 4U, 20U, 0U, 0xFFFF'FFFFU});
    point.max_distance = random.anyOf(std::array{kInfinity, kInfinity, 1.0F, 0.0F, kMax});
    point.layers = layers();
    batches.points.push_back(point);
  }
  return batches;
}

TEST(BroadphaseQueries, AreRightOnEveryTortureInput) {
  for (const Input& input : allInputs()) {
    for (const std::size_t n : {std::size_t{1}, std::size_t{9}, std::size_t{400}}) {
      for (const bp::InstructionSet set : instructionSets()) {
        bp::Options options;
        options.instruction_set = set;
        options.method = n == 9 ? bp::Method::columns : bp::Method::tide;
        bp::BroadPhase object(options);
        for (std::uint32_t frame = 0; frame < 8; ++frame) {
          const QueryOracle oracle{input.boxes(n, frame, 1 + n)};
          object.update(publicBoxes(oracle.boxes));
          if (frame == 3) continue;  // the changes of two updates
          QueryBatches batches = queriesAbout(oracle.boxes, 40, frame);
          batches.run(object);
          ASSERT_EQ(batches.fault(oracle), "")
              << input.name << ", " << n << " bodies, frame " << frame << ", " << describe(options);
        }
      }
    }
  }
}

TEST(BroadphaseQueries, AreRightOnAnyThreads) {
  constexpr std::size_t kBodies = 5000;
  for (const Input& input : allInputs()) {
    if (input.all_overlap || input.name == "limits") continue;  // too many pairs
    std::vector<bp::BroadPhase> objects;
    for (const int threads : {1, 2, 3}) {
      bp::Options options;
      options.threads = threads;
      options.parallel_for = threads == 3 ? runBackwards : bp::ParallelFor();
      objects.emplace_back(options);
    }
    for (std::uint32_t frame = 0; frame < 3; ++frame) {
      const QueryOracle oracle{input.boxes(kBodies, frame, 1)};
      const QueryBatches batches = queriesAbout(oracle.boxes, 1000, frame);
      QueryBatches first;
      for (std::size_t i = 0; i < objects.size(); ++i) {
        QueryBatches found = batches;
        objects[i].update(publicBoxes(oracle.boxes));
        found.run(objects[i]);
        if (i == 0) {
          first = found;
          ASSERT_EQ(first.fault(oracle), "") << input.name;
        }
        ASSERT_TRUE(found.hasAnswersOf(first)) << input.name << ", " << i + 1 << " threads";
      }
    }
  }
}

// Bodies appear, vanish and teleport, few and many of them; layers change, states are restored.
TEST(BroadphaseQueries, FollowAChangingWorld) {
  for (bp::Options options : allOptions()) {
    for (const int rate : {1, 2, 40, 400}) {  // one in `rate` bodies changes
      bp::BroadPhase object(options);
      QueryOracle oracle;
      Random random(3, static_cast<std::uint32_t>(rate));
      std::vector<std::byte> state;
      QueryOracle saved;
      for (std::uint32_t frame = 0; frame < 60; ++frame) {
        if (frame % 16 == 5)
          oracle.boxes.resize(static_cast<std::size_t>(random.integer(0, 900)), kEmptyBox);
        for (Aabb& box : oracle.boxes) {
          if (!random.onceIn(rate)) continue;
          box = random.onceIn(4) ? kEmptyBox : inputs::boxAt(random.inCube(30), {1, 2, 1});
        }
        if (frame % 7 == 6) {
          const int body = random.integer(0, 900);
          oracle.layers.resize(901);
          oracle.layers[static_cast<std::size_t>(body)] = static_cast<std::uint8_t>(frame % 3);
          object.setFilter(static_cast<std::uint32_t>(body), {.layer = frame % 3});
        }
        object.update(publicBoxes(oracle.boxes));
        if (frame % 20 == 10) {
          object.save(state);
          saved = oracle;
        } else if (frame % 20 == 17) {
          object.restore(state);
          oracle = saved;
        }
        if (random.onceIn(3)) continue;
        QueryBatches batches = queriesAbout(oracle.boxes, 20, frame);
        batches.run(object);
        ASSERT_EQ(batches.fault(oracle), "")
            << "one in " << rate << ", frame " << frame << ", " << describe(options);
      }
    }
  }
}

// Small steps, after which many bodies are elsewhere; then the tree is built again.
TEST(BroadphaseQueries, FollowBodiesThatMix) {
  bp::BroadPhase object;
  QueryOracle oracle{inputs::uniform(2000, 0, 1)};
  std::vector<float> speeds;
  Random random(4, 0);
  for (std::size_t i = 0; i < oracle.boxes.size(); ++i) speeds.push_back(random.uniform(-1, 1));
  for (std::uint32_t frame = 0; frame < 60; ++frame) {
    for (std::size_t i = 0; i < oracle.boxes.size(); ++i) {
      oracle.boxes[i].min[i % 3] += speeds[i];
      oracle.boxes[i].max[i % 3] += speeds[i];
    }
    object.update(publicBoxes(oracle.boxes));
    QueryBatches batches = queriesAbout(oracle.boxes, 20, frame);
    batches.run(object);
    ASSERT_EQ(batches.fault(oracle), "") << "frame " << frame;
  }
}

TEST(BroadphaseQueries, AreAboutEnlargedBoxes) {
  bp::Options options;
  options.margin = 0.5F;
  bp::BroadPhase object(options);
  object.update(std::vector<bp::Box>{{{0, 0, 0}, {1, 1, 1}}});
  QueryBatches batches;
  batches.boxes = {{{{1.5F, 0, 0}, {2, 2, 2}}}, {{{1.75F, 0, 0}, {2, 2, 2}}}};
  batches.casts = {{{{-2, 0, 0}, {-2, 0, 0}}, {1, 0, 0}, 2}};
  batches.points = {{{4.5F, 0, 0}}};
  batches.run(object);
  EXPECT_THAT(batches.bodies[0], ElementsAre(0));
  EXPECT_THAT(batches.bodies[1], IsEmpty());
  EXPECT_THAT(batches.hits[0][0], ElementsAre(bp::CastHit{1.5, 0}));
  EXPECT_THAT(batches.neighbours[0], ElementsAre(bp::Neighbour{3, 0}));
}

TEST(BroadphaseQueries, AnswerSimpleQuestions) {
  bp::BroadPhase object;
  object.setFilter(2, {.layer = 7});
  object.update(std::vector<bp::Box>{{{0, 0, 0}, {1, 1, 1}},
                                     {{2, 0, 0}, {3, 1, 1}},
                                     {{2, 0, 0}, {3, 1, 1}},
                                     bp::kNoBox,
                                     {{9, 9, 9}, {10, 10, 10}}});
  const auto cast = [&](const bp::Cast& query, bp::Hits hits) {
    bp::QueryResults<bp::CastHit> found;
    object.cast(std::span(&query, 1), hits, found);
    return found.items;
  };
  const bp::Cast ray = {{{-1, 1, 0.5F}, {-1, 1, 0.5F}}, {4, 0, 0}};  // along an edge
  EXPECT_THAT(cast(ray, bp::Hits::all),
              ElementsAre(bp::CastHit{0.25, 0}, bp::CastHit{0.75, 1}, bp::CastHit{0.75, 2}));
  EXPECT_THAT(cast(ray, bp::Hits::closest), ElementsAre(bp::CastHit{0.25, 0}));
  EXPECT_THAT(cast({{{2, 0, 0}, {2, 0, 0}}, {1, 0, 0}}, bp::Hits::closest),
              ElementsAre(bp::CastHit{0, 1}));
  EXPECT_THAT(cast({{{-1, 0, 0}, {-1, 0, 0}}, {-1, 0, 0}}, bp::Hits::all), IsEmpty());
  EXPECT_THAT(cast({{{-1, 1, 1}, {-1, 1, 1}}, {4, 0, 0}, 1, 1U << 7}, bp::Hits::all),
              ElementsAre(bp::CastHit{0.75, 2}));
  EXPECT_THAT(cast({{{-3, 1, 1}, {-2, 2, 2}}, {4, 0, 0}}, bp::Hits::all),  // a box
              ElementsAre(bp::CastHit{0.5, 0}, bp::CastHit{1, 1}, bp::CastHit{1, 2}));

  bp::QueryResults<bp::Neighbour> neighbours;
  const bp::NearestQuery nearest[] = {{{1.5F, 0, 0}, 2}, {{8, 8, 9}, 9, 2}};
  object.nearest(nearest, neighbours);
  EXPECT_THAT(neighbours[0], ElementsAre(bp::Neighbour{0.5, 0}, bp::Neighbour{0.5, 1}));
  EXPECT_THAT(neighbours[1], ElementsAre(bp::Neighbour{std::sqrt(2.0), 4}));
}

// Hits that rounding could miss: the far end of a cast, and edges on its way.
TEST(BroadphaseQueries, MissNoHitByRounding) {
  Random random(9, 0);
  for (int i = 0; i < 2000; ++i) {
    const inputs::Vec3 from = random.inCube(10);
    const inputs::Vec3 to = random.inCube(10);
    bp::Cast cast;
    std::vector<bp::Box> boxes(2);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float step = std::ldexp(std::round((to[axis] - from[axis]) * 64), -6);
      const float start = std::ldexp(std::round(from[axis] * 64), -6);
      cast.box.min[axis] = cast.box.max[axis] = start;
      cast.direction[axis] = 3 * step;  // exact, but a third of it is no float
      boxes[0].min[axis] = boxes[0].max[axis] = start + step;
      boxes[1].min[axis] = boxes[1].max[axis] = start + 3 * step;
    }
    bp::BroadPhase object;
    object.update(boxes);
    bp::QueryResults<bp::CastHit> hits;
    object.cast(std::span(&cast, 1), bp::Hits::all, hits);
    ASSERT_EQ(hits.items.size(), 2U);
    ASSERT_NEAR(hits.items[0].fraction, 1.0 / 3, 1e-15);
    ASSERT_NEAR(hits.items[1].fraction, 1, 1e-15);
    ASSERT_LE(hits.items[1].fraction, 1);
  }
}

TEST(BroadphaseQueries, FindNothingBeforeTheFirstUpdate) {
  const auto expect_nothing = [](bp::BroadPhase& object) {
    QueryBatches batches = queriesAbout({}, 3, 1);
    batches.run(object);
    EXPECT_EQ(batches.bodies.size(), 3U);
    EXPECT_EQ(batches.fault({}), "");
  };
  bp::BroadPhase object;
  expect_nothing(object);
  object.update({});
  expect_nothing(object);
  object.update(std::vector<bp::Box>(3, bp::kNoBox));
  expect_nothing(object);
  EXPECT_EQ(bp::QueryResults<std::uint32_t>().size(), 0U);
}

TEST(BroadphaseQueries, RefuseMisuse) {
  bp::BroadPhase object;
  object.update(std::vector<bp::Box>(3, {{0, 0, 0}, {1, 1, 1}}));
  const auto overlapping = [&](const bp::Box& box) {
    bp::QueryResults<std::uint32_t> bodies;
    const bp::BoxQuery queries[] = {{}, {box}};
    return invalidArgument([&] { object.overlapping(queries, bodies); });
  };
  EXPECT_EQ(overlapping({{0, 0, 0}, {1, NAN, 1}}), "query 1: y is NaN");
  EXPECT_EQ(overlapping({{0, 0, 2}, {1, 1, 1}}), "query 1: min > max");
  EXPECT_EQ(overlapping(bp::kNoBox), "query 1: min > max");
  EXPECT_THAT(overlapping({{0, 0, 0}, {kInfinity, 1, 1}}), HasSubstr("query 1: x is infinite"));

  const auto cast = [&](const bp::Cast& query, bp::Hits wanted = bp::Hits::all) {
    bp::QueryResults<bp::CastHit> hits;
    return invalidArgument([&] { object.cast(std::span(&query, 1), wanted, hits); });
  };
  EXPECT_EQ(cast({{{0, 0, 0}, {-1, 0, 0}}, {1, 0, 0}}), "query 0: min > max");
  EXPECT_EQ(cast({{}, {NAN, 0, 0}}), "query 0: direction is not finite");
  EXPECT_EQ(cast({{}, {0, 0, kInfinity}}), "query 0: direction is not finite");
  EXPECT_EQ(cast({{}, {1, 0, 0}, NAN}), "query 0: max_fraction is negative or NaN");
  EXPECT_EQ(cast({{}, {1, 0, 0}, -1}), "query 0: max_fraction is negative or NaN");
  EXPECT_EQ(cast({{}, {1, 0, 0}}, static_cast<bp::Hits>(2)), "hits: invalid value 2");

  const auto nearest = [&](const bp::NearestQuery& query) {
    bp::QueryResults<bp::Neighbour> neighbours;
    return invalidArgument([&] { object.nearest(std::span(&query, 1), neighbours); });
  };
  EXPECT_EQ(nearest({{0, NAN, 0}}), "query 0: point is not finite");
  EXPECT_EQ(nearest({{0, 0, 0}, 1, -1}), "query 0: max_distance is negative or NaN");

  const bp::BroadPhase other = std::move(object);
  bp::QueryResults<std::uint32_t> bodies;
  EXPECT_THAT(messageOf<std::logic_error>([&] { object.overlapping({}, bodies); }),
              HasSubstr("moved"));
}

// A job system that fails fails a query alone; after a failed update there are no queries.
TEST(BroadphaseQueries, SurviveAFailingJobSystem) {
  bool fails = false;
  bp::Options options;
  options.threads = 2;
  options.parallel_for = [&](int jobs, const std::function<void(int)>& job) {
    if (fails) throw std::runtime_error("no jobs");
    runBackwards(jobs, job);
  };
  bp::BroadPhase object(options);
  QueryOracle oracle{inputs::uniform(20000, 0, 1)};
  object.update(publicBoxes(oracle.boxes));
  std::vector<std::byte> state;
  object.save(state);
  QueryBatches batches = queriesAbout(oracle.boxes, 700, 1);
  const auto expect_failure = [&] {
    fails = true;
    EXPECT_EQ(messageOf<std::runtime_error>([&] { batches.run(object); }), "no jobs");
    fails = false;
  };
  expect_failure();  // building the tree
  batches.run(object);
  EXPECT_EQ(batches.fault(oracle), "");
  expect_failure();  // answering
  oracle.boxes = inputs::uniform(20000, 1, 1);
  object.update(publicBoxes(oracle.boxes));
  expect_failure();  // refitting
  batches.run(object);
  EXPECT_EQ(batches.fault(oracle), "");

  fails = true;
  EXPECT_THROW(object.update(publicBoxes(inputs::uniform(20000, 2, 1))), std::runtime_error);
  fails = false;
  EXPECT_THAT(messageOf<std::logic_error>([&] { batches.run(object); }), HasSubstr("restore"));
  object.restore(state);
  oracle.boxes = inputs::uniform(20000, 0, 1);
  batches.run(object);
  EXPECT_EQ(batches.fault(oracle), "");
}

}  // namespace
}  // namespace broadmark::tests
