// The bodies of a changing world that an algorithm without presence or filters gets: the minimum.

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "adapters/occupancy_bitmap.h"
#include "broadmark/adapters.h"
#include "broadmark/harness/oracle.h"
#include "support/changing_worlds.h"

namespace broadmark::tests {
namespace {

using Boxes = std::vector<Aabb>;

/// Reports all pairs, and stores its boxes.
class Witness final : public BoxBroadPhase {
 public:
  using BoxBroadPhase::boxes;
  [[nodiscard]] std::size_t pairsFormed() const { return formed_; }

 private:
  void findPairs() override {
    formed_ = 0;
    for (const Pair pair : bruteForcePairs(boxes())) {
      pairs().add(pair.a, pair.b);
      ++formed_;
    }
  }

  std::size_t formed_ = 0;
};

/// A witness behind the adapter.
class AdaptedWorld {
 public:
  AdaptedWorld(const CollisionFilter& filter, const Boxes& first, const Aabb& bounds)
      : boxes_(first), filter_(filter) {
    auto witness = std::make_unique<Witness>();
    witness_ = witness.get();
    world_ = compacted(std::move(witness));
    SceneInfo scene;
    scene.objects = static_cast<std::uint32_t>(first.size());
    scene.world = bounds;
    scene.all_present = false;
    scene.filter = filter;
    world_->initialize(scene, {0, boxes_, std::span<const std::uint32_t>()}, execution_);
  }

  /// Processes a frame and checks the answer.
  void step(const Boxes& boxes) {
    std::vector<std::uint32_t> changed;
    for (std::uint32_t body = 0; body < boxes.size(); ++body) {
      if (boxes[body] != boxes_[body]) changed.push_back(body);
    }
    boxes_ = boxes;
    world_->updateObjects({++index_, boxes_, changed});
    world_->cleanCache();
    world_->updateStructures();
    world_->searchOverlaps();
    std::vector<Pair> answer;
    for (const PairRun pair_run : world_->overlaps()) {
      answer.insert(answer.end(), pair_run.begin(), pair_run.end());
    }
    std::ranges::sort(answer);
    EXPECT_EQ(answer, bruteForcePairs(boxes_, filter_)) << "in frame " << index_;
    EXPECT_EQ(world_->validate(), "");
  }

  [[nodiscard]] const Boxes& shown() const { return witness_->boxes(); }
  [[nodiscard]] std::size_t pairsFormed() const { return witness_->pairsFormed(); }

 private:
  Boxes boxes_;
  CollisionFilter filter_;
  ExecutionContext execution_{1, Isa::scalar};
  Witness* witness_ = nullptr;
  std::unique_ptr<BroadPhase> world_;
  std::uint32_t index_ = 0;
};

constexpr Aabb kBounds = {{0, 0, 0, 0}, {100, 100, 100, 0}};

Aabb unitAt(float x, float y = 0, float z = 0) { return inputs::boxAt({x, y, z}, {1, 1, 1}); }

CollisionFilter layers(const std::vector<std::uint8_t>& body_layers, const LayerMatrix& matrix) {
  std::vector<BodyGroups> groups;
  for (const std::uint8_t layer : body_layers) groups.push_back({.layer = layer});
  return {groups, matrix};
}

TEST(CompactingAdapter, ShowsNobodyWhoCanMeetNobody) {
  // Layer 2 collides with layer 1, layer 0 with itself only.
  const CollisionFilter filter = layers({0, 0, 1, 2, 2}, LayerMatrix().set(0, 0).set(1, 2));
  Boxes boxes(5, unitAt(0));
  boxes[2] = kEmptyBox;
  AdaptedWorld adapted(filter, boxes, kBounds);
  adapted.step(boxes);
  EXPECT_EQ(adapted.shown().size(), 2U);
  boxes[2] = unitAt(0.5F);
  adapted.step(boxes);
  EXPECT_EQ(adapted.shown().size(), 5U);
  boxes[3] = boxes[4] = kEmptyBox;
  adapted.step(boxes);
  EXPECT_EQ(adapted.shown().size(), 2U);
  boxes[0] = kEmptyBox;
  adapted.step(boxes);
  EXPECT_EQ(adapted.shown().size(), 1U);
}

TEST(CompactingAdapter, ShowsOfALevelOnlyWhatIsNearSomebody) {
  constexpr std::size_t kLevel = 1000;
  std::vector<std::uint8_t> body_layers(kLevel + 1, 0);
  body_layers.back() = 1;
  Boxes boxes;
  for (std::size_t i = 0; i < kLevel; ++i) {
    boxes.push_back(unitAt(static_cast<float>(i % 10) * 10, static_cast<float>(i / 10 % 10) * 10,
                           static_cast<float>(i / 100) * 10));
  }
  boxes.push_back(unitAt(0.5F, 0.5F, 0.5F));
  AdaptedWorld adapted(layers(body_layers, LayerMatrix().set(0, 1)), boxes, kBounds);
  for (int step = 0; step < 20; ++step) {
    boxes.back() = unitAt(static_cast<float>(step) * 10 + 0.5F, 50, 90.5F);
    adapted.step(boxes);
    EXPECT_LE(adapted.shown().size(), 3U);
  }
  // Outside of the world.
  boxes.back() = boxes.front() = unitAt(-1e6F, 1e9F, 500);
  adapted.step(boxes);
  EXPECT_EQ(adapted.pairsFormed(), 1U);
  boxes.back() = kEmptyBox;
  adapted.step(boxes);
  EXPECT_TRUE(adapted.shown().empty());
}

TEST(CompactingAdapter, MapsPairsOfBodiesInAnyOrder) {
  constexpr std::size_t kBodies = 5;  // all of them overlap
  std::vector<BodyGroups> groups(kBodies);
  groups[1].tags = groups[3].tags = {7, BodyGroups::kNoTag, BodyGroups::kNoTag};
  const Boxes all(kBodies, unitAt(0));
  AdaptedWorld adapted(CollisionFilter(groups, LayerMatrix::all()), all, kBounds);
  std::mt19937 random(1);
  for (int step = 0; step < 200; ++step) {
    Boxes boxes = all;
    if (step % 3 != 0) {
      for (Aabb& box : boxes) {
        if (random() % 2 == 0) box = kEmptyBox;
      }
    }
    adapted.step(boxes);
  }
}

TEST(CompactingAdapter, FormsNoPairsOfTwoWorlds) {
  constexpr std::uint32_t kEach = 4;
  constexpr std::uint32_t kAll = 600;
  const CollisionFilter filter = filterOf(
      kAll, LayerMatrix().set(0, 0),
      [](inputs::Random&, std::uint32_t body) { return BodyGroups{.world = 1000 - body / kEach}; });
  const auto boxes = [](std::uint32_t frame) {
    return inputs::generate(kAll, frame, 5, [](inputs::Random& random, std::size_t) {
      return inputs::boxAt(random.inCube(2), {1, 1, 1});
    });
  };
  AdaptedWorld adapted(filter, boxes(0), {{0, 0, 0, 0}, {3, 3, 3, 0}});
  for (std::uint32_t frame = 1; frame < 5; ++frame) {
    adapted.step(boxes(frame));
    EXPECT_EQ(adapted.shown().size(), kAll);
    EXPECT_LE(adapted.pairsFormed(), kAll * (kEach - 1) / 2);
  }
}

// An offset could round, and make separate boxes touch.
TEST(CompactingAdapter, JudgesBoxesWhereTheyAre) {
  const CollisionFilter filter(
      {{BodyGroups{}, BodyGroups{}, BodyGroups{.world = 1}, BodyGroups{.world = 1}}},
      LayerMatrix().set(0, 0));
  const float gap = 1 + 0x1p-23F;  // the next number
  const Boxes boxes = {unitAt(0), inputs::boxAt({gap, 0, 0}, {1, 1, 1}), unitAt(0),
                       inputs::boxAt({gap, 0, 0}, {1, 1, 1})};
  AdaptedWorld adapted(filter, boxes, {{0, 0, 0, 0}, {1e6F, 1e6F, 1e6F, 0}});
  adapted.step(boxes);
  EXPECT_EQ(adapted.pairsFormed(), 1U);
}

// The worlds span the range of floats: they get no offsets.
TEST(CompactingAdapter, LeavesHugeWorldsAtTheirPlace) {
  constexpr std::uint32_t kAll = 60;
  const CollisionFilter filter =
      filterOf(kAll, LayerMatrix().set(0, 0),
               [](inputs::Random&, std::uint32_t body) { return BodyGroups{.world = body % 3}; });
  const Boxes boxes = inputs::limits(kAll, 0, 1);
  Aabb bounds = boxes[0];
  for (const Aabb& box : boxes) bounds = merged(bounds, box);
  AdaptedWorld adapted(filter, boxes, bounds);
  adapted.step(inputs::limits(kAll, 1, 1));
  EXPECT_EQ(adapted.shown(), inputs::limits(kAll, 1, 1));
}

// Boxes of all inputs in worlds of all kinds, including too small and degenerate worlds.
TEST(OccupancyBitmap, KnowsEveryOverlap) {
  for (const inputs::Input& input : inputs::kAll) {
    SCOPED_TRACE(input.name);
    const Boxes boxes = input.boxes(80, 1, 3);
    Aabb bounds = boxes[0];
    for (const Aabb& box : boxes) bounds = merged(bounds, box);
    for (const Aabb& world : {bounds, kBounds, boxes[0], kEmptyBox, Aabb{}}) {
      for (const std::size_t bodies : {0UL, 1UL, 300UL, 100'000UL}) {
        OccupancyBitmap grid(world, bodies);
        for (const Aabb& marked : boxes) {
          grid.clear();
          grid.mark(marked);
          for (const Aabb& box : boxes) {
            EXPECT_TRUE(grid.isNear(box) || !overlaps(marked, box));
          }
        }
      }
    }
  }
}

TEST(OccupancyBitmap, TellsApartWhatIsFar) {
  OccupancyBitmap grid(kBounds, 100'000);
  grid.mark(unitAt(50, 50, 50));
  EXPECT_TRUE(grid.isNear(unitAt(50, 50, 51)));
  EXPECT_FALSE(grid.isNear(unitAt(50, 50, 60)));
  EXPECT_FALSE(grid.isNear(unitAt(50, 60, 50)));
  EXPECT_FALSE(grid.isNear(unitAt(60, 50, 50)));
  EXPECT_FALSE(grid.isNear(unitAt(0, 0, 0)));
  grid.clear();
  EXPECT_FALSE(grid.isNear(unitAt(50, 50, 50)));
}

}  // namespace
}  // namespace broadmark::tests
