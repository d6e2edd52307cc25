// Collision filters.

#include "broadmark/collision_filter.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace broadmark {
namespace {

constexpr std::uint32_t kNoTag = BodyGroups::kNoTag;

TEST(LayerMatrix, IsSymmetric) {
  LayerMatrix matrix;
  matrix.set(0, 31).set(5, 5);
  EXPECT_TRUE(matrix.collide(0, 31) && matrix.collide(31, 0) && matrix.collide(5, 5));
  EXPECT_FALSE(matrix.collide(0, 0) || matrix.collide(5, 6));
  EXPECT_FALSE(LayerMatrix::all().set(3, 4, false).collide(4, 3));
  EXPECT_TRUE(LayerMatrix::all().collide(31, 31));
}

TEST(CollisionFilter, WantsAllUnlessToldOtherwise) {
  EXPECT_TRUE(CollisionFilter().wantsAll());
  EXPECT_TRUE(CollisionFilter().wanted(3, 400));
  const std::vector<BodyGroups> usual(2);
  EXPECT_TRUE(CollisionFilter(usual, LayerMatrix::all()).wantsAll());
  EXPECT_EQ(CollisionFilter(usual, LayerMatrix::all()), CollisionFilter());
  EXPECT_FALSE(CollisionFilter(usual, LayerMatrix()).wanted(0, 1));
}

TEST(CollisionFilter, GoesByLayersWorldsAndTags) {
  const std::vector<BodyGroups> bodies = {
      {.layer = 0},
      {.layer = 1},
      {.layer = 1, .world = 7},
      {.layer = 1, .world = 7, .tags = {4, kNoTag, 9}},
      {.layer = 1, .world = 7, .tags = {kNoTag, 9, kNoTag}},
  };
  const CollisionFilter filter(bodies, LayerMatrix().set(0, 1).set(1, 1));
  EXPECT_TRUE(filter.wanted(0, 1));
  EXPECT_FALSE(filter.wanted(1, 2)) << "another world";
  EXPECT_TRUE(filter.wanted(2, 3));
  EXPECT_FALSE(filter.wanted(3, 4)) << "a tag in common";
  EXPECT_TRUE(filter.wanted(2, 4)) << "to have no tag is not to share one";
  for (std::uint32_t body = 0; body < 5; ++body) EXPECT_EQ(filter.groupsOf(body), bodies[body]);
}

TEST(CollisionFilter, RetainsWantedPairsByEveryCombinationOfCriteria) {
  std::vector<Pair> all = {{9, 9}, {70, 3}, {3, 60}};  // invalid: they stay
  for (std::uint32_t a = 0; a < 60; ++a) {
    for (std::uint32_t b = a + 1; b < 60; ++b) all.push_back({a, b});
  }
  for (unsigned criteria = 0; criteria < 8; ++criteria) {
    SCOPED_TRACE(criteria);
    std::vector<BodyGroups> bodies(60);
    for (std::uint32_t body = 0; body < bodies.size(); ++body) {
      BodyGroups& own = bodies[body];
      if ((criteria & 1) != 0) own.layer = static_cast<std::uint8_t>(body % 3);
      if ((criteria & 2) != 0) own.world = body % 2;
      if ((criteria & 4) == 0) continue;
      // Equal tags at each combination of places, missing ones anywhere.
      own.tags[body % 3] = body / 7;
      if (body % 5 == 0) own.tags[(body + 1) % 3] = body % 4;
    }
    for (const LayerMatrix& matrix : {LayerMatrix().set(0, 0).set(1, 2), LayerMatrix().set(1, 1)}) {
      const CollisionFilter filter(bodies, matrix);
      std::vector<Pair> wanted = all;
      std::erase_if(wanted, [&](Pair pair) {
        return pair.a < pair.b && pair.b < bodies.size() && !filter.wanted(pair.a, pair.b);
      });
      std::vector<Pair> retained = all;
      retained.resize(filter.retainWanted(retained));
      EXPECT_EQ(retained, wanted);
    }
  }
}

TEST(CollisionFilter, OfSomeBodiesIsAsThatOfAll) {
  const std::vector<BodyGroups> bodies = {{.layer = 2}, {.world = 3}, {.layer = 2, .world = 3}, {}};
  const CollisionFilter all(bodies, LayerMatrix().set(0, 2));
  const std::vector<std::uint32_t> some = {1, 2};
  EXPECT_EQ(all.of(some).wanted(0, 1), all.wanted(1, 2));
  EXPECT_EQ(all.of(some), CollisionFilter(std::vector{bodies[1], bodies[2]}, all.matrix()));
  EXPECT_FALSE(all.of(some) == all);
}

TEST(CollisionFilter, WithOtherGroupsOfSomeBodies) {
  const std::vector<BodyGroups> bodies = {{.world = 3}, {.layer = 1}, {}};
  const CollisionFilter first(bodies, LayerMatrix().set(0, 1));
  const std::vector<std::uint32_t> changed = {0, 2};
  const std::vector<BodyGroups> groups = {{.layer = 1, .world = 9}, {.tags = {1, 2, 3}}};
  const CollisionFilter next = first.with(changed, groups, 3);
  EXPECT_EQ(next.groupsOf(0), (BodyGroups{.layer = 1, .world = 3})) << "worlds do not change";
  EXPECT_EQ(next.groupsOf(1), bodies[1]);
  EXPECT_EQ(next.groupsOf(2), groups[1]);
  EXPECT_EQ(next.matrix(), first.matrix());
  EXPECT_EQ(next.with(changed, first, 3), first);
  EXPECT_NE(next, first);
}

TEST(CollisionFilter, OfChangingLayersKeepsAllOfTheMatrix) {
  const LayerMatrix matrix = LayerMatrix().set(0, 0).set(1, 2);
  const std::vector<BodyGroups> usual(3);
  EXPECT_TRUE(CollisionFilter(usual, matrix).wantsAll());
  const CollisionFilter changing(usual, matrix, true);
  EXPECT_EQ(changing.matrix(), matrix);
  const std::vector<std::uint32_t> bodies = {0, 2};
  const std::vector<BodyGroups> groups = {{.layer = 1}, {.layer = 2}};
  EXPECT_FALSE(changing.with(bodies, groups, 3).wanted(0, 1));
  EXPECT_TRUE(changing.with(bodies, groups, 3).wanted(0, 2));
  EXPECT_EQ(changing.of(bodies).matrix(), matrix);
}

TEST(LiveFilter, IsFollowedByItsCopies) {
  LiveFilter live({}, 3);
  const CollisionFilter copy = live.filter();
  EXPECT_FALSE(copy.wantsAll());
  EXPECT_TRUE(copy.wanted(0, 2));
  const std::vector<BodyGroups> groups = {{.tags = {7, 8, 9}}, {}, {.tags = {1, 2, 7}}};
  const CollisionFilter tagged(groups, LayerMatrix().set(0, 0));
  live.update(0, tagged);
  EXPECT_TRUE(copy.wanted(0, 2));
  live.update(2, tagged);
  EXPECT_FALSE(copy.wanted(0, 2));
  EXPECT_TRUE(copy.wanted(0, 1));
}

TEST(CollisionFilter, RefusesLayersBeyondTheLast) {
  const std::vector<BodyGroups> bodies = {{.layer = 32}};
  EXPECT_THROW(CollisionFilter(bodies, LayerMatrix::all()), std::invalid_argument);
}

}  // namespace
}  // namespace broadmark
