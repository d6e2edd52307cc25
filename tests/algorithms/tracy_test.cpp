// Tracy's parts by themselves, and what is particular to it: that it is incremental, and right
// where bodies change cells, leave the world or touch very many cells.

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tracy/pair_set.h"
#include "tracy/segmented_list.h"
#include "algorithms/runs.h"

namespace broadmark::tests {
namespace {

using tracy::Endpoint;
using tracy::PairSet;
using tracy::SegmentedList;

TEST(Endpoint, StartsComeBeforeEndsAtTheSameValue) {
  const Endpoint ascending[] = {
      Endpoint::start(-1, 9),  Endpoint::end(-1, 3),      Endpoint::start(-0.0F, 4),
      Endpoint::start(0, 5),   Endpoint::start(-0.0F, 6), Endpoint::end(0, 1),
      Endpoint::end(-0.0F, 2), Endpoint::start(1, 0),
  };
  for (std::size_t i = 1; i < std::size(ascending); ++i) {
    EXPECT_LT(ascending[i - 1], ascending[i]) << i;
  }
  EXPECT_TRUE(Endpoint::end(1, 7).isEnd());
  EXPECT_FALSE(Endpoint::start(1, 7).isEnd());
  EXPECT_EQ(Endpoint::end(1, 0x7FFF'FFFF).slot(), 0x7FFF'FFFFU);
}

/// A segmented list beside the plainest thing that does the same.
class ListAndModel {
 public:
  ListAndModel(std::uint32_t capacity, int values, std::uint64_t seed)
      : capacity_(capacity), values_(values), random_(seed, 0) {
    list_.build({}, capacity);
  }

  /// Does something at random; `fullness` is the share of intervals it tends to.
  void step(double fullness) {
    const auto slot =
        static_cast<std::uint32_t>(random_.integer(0, static_cast<int>(capacity_) - 1));
    const auto found = intervals_.find(slot);
    if (found == intervals_.end()) {
      if (random_.uniform(0, 1) < fullness) insert(slot);
    } else if (random_.uniform(0, 1) > fullness) {
      remove(slot);
    } else {
      moveTo(slot, random_.integer(0, 3) == 0 ? anywhere() : nearby(found->second));
    }
  }

  void insert(std::uint32_t slot) {
    const Interval interval = intervals_[slot] = anywhere();
    list_.insert(Endpoint::start(interval.low, slot), Endpoint::end(interval.high, slot));
  }
  void remove(std::uint32_t slot) {
    const Interval interval = intervals_.at(slot);
    list_.remove(Endpoint::start(interval.low, slot), Endpoint::end(interval.high, slot));
    intervals_.erase(slot);
  }

  void check() const {
    ASSERT_EQ(list_.validate(), "");
    ASSERT_TRUE(std::ranges::equal(list_.endpoints(), model()));
  }

  /// What is said to meet an interval must be what does, and what ends before it at the most.
  void checkMeeting() const {
    for (const auto& [slot, interval] : intervals_) {
      std::map<std::uint32_t, int> visits;
      list_.forEachMeeting(slot, [&](std::uint32_t other) { ++visits[other]; });
      EXPECT_EQ(visits.count(slot), 0U);
      for (const auto& [other, theirs] : intervals_) {
        if (other == slot) continue;
        const bool meets = interval.low <= theirs.high && theirs.low <= interval.high;
        const int count = visits[other];
        if (meets) {
          ASSERT_EQ(count, 1) << slot << " meets " << other;
        }
        ASSERT_TRUE(count == 0 || (count == 1 && theirs.low <= interval.high)) << slot << other;
      }
    }
  }

  [[nodiscard]] std::size_t size() const { return intervals_.size(); }
  [[nodiscard]] int chunks() const {
    int count = 0;
    list_.forEachChunk([&](auto) { ++count; });
    return count;
  }
  [[nodiscard]] std::uint32_t capacity() const { return capacity_; }
  SegmentedList& list() { return list_; }

 private:
  struct Interval {
    float low;
    float high;
  };

  float value() { return static_cast<float>(random_.integer(-values_, values_)); }
  Interval anywhere() {
    const float low = value();
    // Mostly short, so that open sets are neither empty nor full.
    const int longest = random_.integer(0, 9) == 0 ? values_ : values_ / 20;
    return {low, low + static_cast<float>(random_.integer(0, longest))};
  }
  Interval nearby(const Interval& from) {
    const auto some = [&] { return static_cast<float>(random_.integer(-2, 2)); };
    const float low = from.low + some();
    return {low, std::max(low, from.high + some())};
  }

  void moveTo(std::uint32_t slot, const Interval& to) {
    const Interval from = std::exchange(intervals_[slot], to);
    const auto moveStart = [&] {
      move(Endpoint::start(from.low, slot), Endpoint::start(to.low, slot));
    };
    const auto moveEnd = [&] {
      move(Endpoint::end(from.high, slot), Endpoint::end(to.high, slot));
    };
    if (from.high < to.high) {
      moveEnd();
      moveStart();
    } else {
      moveStart();
      moveEnd();
    }
  }

  void move(Endpoint from, Endpoint to) {
    if (from == to) return;
    std::vector<Endpoint> expected;
    for (const Endpoint other : list_.endpoints()) {
      if (std::min(from, to) < other && other < std::max(from, to)) expected.push_back(other);
    }
    if (to < from) std::ranges::reverse(expected);
    std::vector<Endpoint> passed;
    list_.move(from, to, [&](Endpoint endpoint) { passed.push_back(endpoint); });
    EXPECT_TRUE(std::ranges::equal(passed, expected));
  }

  [[nodiscard]] std::vector<Endpoint> model() const {
    std::vector<Endpoint> all;
    for (const auto& [slot, interval] : intervals_) {
      all.push_back(Endpoint::start(interval.low, slot));
      all.push_back(Endpoint::end(interval.high, slot));
    }
    std::ranges::sort(all);
    return all;
  }

  std::uint32_t capacity_;
  int values_;
  inputs::Random random_;
  SegmentedList list_{true};
  std::map<std::uint32_t, Interval> intervals_;
};

// Few values make many ties. The list fills up and empties again, so that chunks split and merge.
TEST(SegmentedList, DoesAsANaiveListDoes) {
  for (const int values : {3, 50, 5000}) {
    SCOPED_TRACE(values);
    ListAndModel both(512, values, 7);
    int most_chunks = 0;
    for (int round = 0; round < 12; ++round) {
      for (int i = 0; i < 800; ++i) {
        both.step(round % 4 < 2 ? 0.9 : 0.1);
        if (i % 8 == 0) both.check();
        if (HasFailure()) return;
      }
      most_chunks = std::max(most_chunks, both.chunks());
      both.checkMeeting();
      if (HasFailure()) return;
    }
    EXPECT_GE(most_chunks, 12);
  }
}

// A chunk of a very long list holds more, lest the open sets need more than linear memory.
TEST(SegmentedList, KeepsTheNumberOfChunksBounded) {
  for (const std::uint32_t capacity : {64U, 1024U, 16384U}) {
    ListAndModel both(capacity, 100'000, 3);
    for (std::uint32_t slot = 0; slot < capacity; ++slot) both.insert(slot);
    both.check();
    EXPECT_LE(both.chunks(), 200) << capacity;
    EXPECT_GE(both.chunks(), 2) << capacity;
    for (std::uint32_t slot = 1; slot < capacity; ++slot) both.remove(slot);
    both.check();
    EXPECT_EQ(both.chunks(), 1) << capacity;
    both.remove(0);
    both.check();
  }
}

TEST(SegmentedList, BuildsAsItInserts) {
  ListAndModel both(256, 1000, 11);
  for (std::uint32_t slot = 0; slot < 256; slot += 2) both.insert(slot);
  for (const std::uint32_t capacity : {256U, 512U, 4096U}) {
    both.list().build(both.list().endpoints(), capacity);
    both.check();
    both.checkMeeting();
  }
}

TEST(SegmentedList, TellsWhatIsNear) {
  SegmentedList list(false);
  std::vector<Endpoint> sorted;
  for (std::uint32_t slot = 0; slot < 500; ++slot) {
    sorted.push_back(Endpoint::start(static_cast<float>(slot), slot));
    sorted.push_back(Endpoint::end(static_cast<float>(slot) + 0.5F, slot));
  }
  list.build(sorted, 512);
  const auto nearFrom250 = [&](float value) {
    return list.isNear(Endpoint::start(250, 250), Endpoint::start(value, 250));
  };
  EXPECT_TRUE(nearFrom250(250));
  EXPECT_TRUE(nearFrom250(260));
  EXPECT_TRUE(nearFrom250(240));
  EXPECT_FALSE(nearFrom250(400));
  EXPECT_FALSE(nearFrom250(100));
}

TEST(PairSet, DoesAsASetDoes) {
  PairSet pairs;
  std::set<Pair> expected;
  inputs::Random random(3, 0);
  for (int round = 0; round < 2; ++round) {
    for (int i = 0; i < 20'000; ++i) {
      const auto a = static_cast<std::uint32_t>(random.integer(0, 60));
      const Pair pair{a, a + static_cast<std::uint32_t>(random.integer(1, 60))};
      if (expected.erase(pair) != 0) {
        pairs.erase(pair);
      } else {
        pairs.insert(pair);
        expected.insert(pair);
      }
      if (i % 100 != 0) continue;
      const PairRun run = pairs.run();
      ASSERT_EQ(sorted({&run, 1}), std::vector<Pair>(expected.begin(), expected.end()));
    }
    EXPECT_THROW(pairs.insert(pairs.run().front()), std::logic_error);
    EXPECT_THROW(pairs.erase({100, 200}), std::logic_error);
    pairs.clear();
    EXPECT_THROW(pairs.erase({0, 1}), std::logic_error);
    expected.clear();
    EXPECT_TRUE(pairs.run().empty());
  }
}

using Counters = std::map<std::string, std::uint64_t, std::less<>>;

/// An instance of Tracy that checks itself and its answers.
class Checked {
 public:
  Checked(const std::string& id, int threads, int objects_per_cell, const Aabb& world,
          const std::vector<Aabb>& first)
      : execution_(threads, Isa::scalar) {
    const std::vector<Algorithm> all = builtinAlgorithms();
    tracy_ = std::ranges::find(all, id, &Algorithm::id)->create();
    setParameters(*tracy_, {{"objects_per_cell", std::to_string(objects_per_cell)}});
    SceneInfo scene;
    scene.objects = static_cast<std::uint32_t>(first.size());
    scene.world = world;
    tracy_->initialize(scene, {0, first}, execution_);
  }

  void step(const std::vector<Aabb>& boxes) {
    tracy_->updateObjects({++index_, boxes});
    tracy_->cleanCache();
    tracy_->updateStructures();
    tracy_->searchOverlaps();
    EXPECT_EQ(sorted(tracy_->overlaps()), sweptPairs(boxes)) << "in frame " << index_;
    EXPECT_EQ(tracy_->validate(), "") << "in frame " << index_;
  }

  [[nodiscard]] Counters counters() const {
    Counters counters;
    tracy_->visitCounters(
        [&](std::string_view name, std::uint64_t count) { counters.emplace(name, count); });
    return counters;
  }
  [[nodiscard]] const BroadPhase& broadPhase() const { return *tracy_; }

 private:
  Execution execution_;
  std::unique_ptr<BroadPhase> tracy_;
  std::uint32_t index_ = 0;
};

Aabb cube(float low, float high) { return {{low, low, low, 0}, {high, high, high, 0}}; }

void moveBy(Aabb& box, const inputs::Vec3& way) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.min[axis] += way[axis];
    box.max[axis] += way[axis];
  }
}

inputs::Vec3 anyWay(inputs::Random& random, float most) {
  return {random.uniform(-most, most), random.uniform(-most, most), random.uniform(-most, most)};
}

TEST(Tracy, DoesNothingWhenNothingMoves) {
  const std::vector<Aabb> boxes = inputs::assorted(2000, 0, 5);
  Checked run("tracy", 1, 20, cube(0, 30), boxes);
  run.step(boxes);
  for (const auto& [name, count] : run.counters()) EXPECT_EQ(count, 0U) << name;

  std::vector<Aabb> one_moved = boxes;
  moveBy(one_moved[77], {0.1F, 0, 0});
  run.step(one_moved);
  EXPECT_GE(run.counters()["moves"], 1U);
  EXPECT_LE(run.counters()["moves"], 8U);
  EXPECT_GT(run.counters()["swaps"], 0U);
  EXPECT_LT(run.counters()["swaps"], 200U);
}

TEST(Tracy, HoldsOverAThousandFramesOfSmallMoves) {
  for (const char* id : {"tracy", "tracy-mt"}) {
    std::vector<Aabb> boxes = inputs::clustered(400, 0, 9);
    Checked run(id, id == std::string("tracy") ? 1 : 3, 25, cube(-6, 6), boxes);
    Counters sum;
    for (std::uint32_t frame = 1; frame <= 1000; ++frame) {
      inputs::Random random(4, frame);
      for (std::size_t i = frame % 3; i < boxes.size(); i += 3) {
        // On a coarse lattice, so that many bounds are equal.
        inputs::Vec3 way = anyWay(random, 0.3F);
        for (float& x : way) x = std::round(x * 8) / 8;
        moveBy(boxes[i], way);
      }
      run.step(boxes);
      if (HasFailure()) return;
      for (const auto& [name, count] : run.counters()) sum[name] += count;
    }
    for (const char* name : {"moves", "swaps", "cell changes", "pairs begun", "pairs ended"}) {
      EXPECT_GT(sum[name], 1000U) << name;
    }
    EXPECT_EQ(sum["grid rebuilds"], 0U);
  }
}

TEST(Tracy, HoldsForManyBodies) {
  constexpr std::size_t kCount = 20'000;
  std::vector<Aabb> boxes = inputs::assorted(kCount, 0, 2);
  Checked one("tracy", 1, 200, cube(0, 58.5F), boxes);
  Checked several("tracy-mt", 4, 200, cube(0, 58.5F), boxes);
  for (std::uint32_t frame = 1; frame <= 5; ++frame) {
    inputs::Random random(8, frame);
    for (Aabb& box : boxes) moveBy(box, anyWay(random, 0.4F));
    for (std::size_t i = 0; i < 100; ++i) moveBy(boxes[i * 191], anyWay(random, 60));
    one.step(boxes);
    several.step(boxes);
  }
}

// The listed algorithm is tested with its usual cells; here everything happens at their borders.
TEST(Tracy, HoldsWithCellsOfAFewBodies) {
  constexpr std::size_t kCount = 257;
  constexpr std::uint32_t kFrames = 4;
  for (const int objects_per_cell : {1, 4}) {
    std::vector<std::vector<Aabb>> unrelated;
    for (const inputs::Input& input : inputs::kAll) {
      SCOPED_TRACE(input.name);
      const auto frames = framesOf(input, kCount, kFrames);
      Checked run("tracy-mt", 2, objects_per_cell, sceneOf(frames).world, frames[0]);
      for (std::uint32_t i = 1; i < kFrames; ++i) run.step(frames[i]);
      unrelated.push_back(frames[1]);
      if (HasFailure()) return;
    }
    Checked run("tracy", 1, objects_per_cell, cube(-10, 20), unrelated[0]);
    for (const std::vector<Aabb>& boxes : unrelated) run.step(boxes);
  }
}

// The intersection moves from cell to cell, but the pair neither begins nor ends.
TEST(Tracy, KeepsPairsThatChangeCells) {
  std::vector<Aabb> boxes(8, cube(0, 0.4F));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) moveBy(boxes[i], {static_cast<float>(i) * 0.02F, 0, 0});
  }
  Checked run("tracy", 1, 1, cube(0, 4), boxes);
  std::uint64_t cell_changes = 0;
  for (int frame = 0; frame < 100; ++frame) {
    const float way = frame < 50 ? 0.09F : -0.09F;
    for (Aabb& box : boxes) moveBy(box, {way, way / 2, -way / 3});
    run.step(boxes);
    const Counters counters = run.counters();
    cell_changes += counters.at("cell changes");
    EXPECT_EQ(counters.at("pairs begun") + counters.at("pairs ended"), 0U);
  }
  EXPECT_GT(cell_changes, 16U);
}

// One body moves past another of the same size, both in the same direction: their endpoints are
// swapped to and fro within a frame.
TEST(Tracy, TellsNothingOfWhatIsUndoneWithinAFrame) {
  std::vector<Aabb> boxes = {cube(0, 1), cube(1.5F, 2.5F)};
  Checked run("tracy", 1, 200, cube(0, 100), boxes);
  for (int frame = 0; frame < 40; ++frame) {
    for (Aabb& box : boxes) moveBy(box, {2, 2, 2});
    run.step(boxes);
    EXPECT_EQ(run.counters()["pairs begun"], 0U);
  }
}

TEST(Tracy, SetsDownAnewWhatGoesFarWithinACell) {
  std::vector<Aabb> boxes = inputs::uniform(600, 0, 6);
  Checked run("tracy", 1, 1'000'000, cube(0, 18), boxes);
  const std::vector<Aabb> elsewhere = inputs::uniform(600, 1, 6);
  std::copy_n(elsewhere.begin(), 300, boxes.begin());
  run.step(boxes);
  EXPECT_GT(run.counters()["jumps"], 200U);
  run.step(inputs::teleporting(600, 1, 1));
  run.step(inputs::identical(600, 2, 1));
  run.step(boxes);
}

TEST(Tracy, HoldsOutsideOfTheWorld) {
  std::vector<Aabb> boxes = inputs::clustered(500, 0, 3);
  Checked run("tracy-mt", 2, 20, cube(-4, 4), boxes);
  for (std::uint32_t frame = 1; frame <= 60; ++frame) {
    inputs::Random random(5, frame);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      // A wind blows most of them out of the world, in a stream dense enough to collide.
      moveBy(boxes[i], anyWay(random, 0.2F));
      if (i % 3 != 0) moveBy(boxes[i], {0.5F, -0.5F, i % 2 == 0 ? 0.5F : 0.0F});
    }
    run.step(boxes);
  }
  run.step(inputs::scaled(boxes, 1e30F));
  run.step(boxes);
}

// All numbers in the header are zero, or the world is no larger than a point.
TEST(Tracy, HoldsInAWorldOfNoSize) {
  for (const Aabb& world : {cube(0, 0), cube(3, 3), Aabb{{0, 0, 0, 0}, {10, 10, 0, 0}}}) {
    Checked run("tracy", 1, 5, world, inputs::uniform(300, 0, 1));
    for (std::uint32_t frame = 1; frame < 4; ++frame) run.step(inputs::uniform(300, frame, 1));
  }
}

// Values that no recording holds: differences overflow in floats.
TEST(Tracy, SurvivesTheLimitsOfFloats) {
  const std::vector<Aabb> first = inputs::limits(300, 0, 1);
  for (const Aabb& world :
       {cube(-1, 1), cube(-std::numeric_limits<float>::max(), std::numeric_limits<float>::max())}) {
    Checked run("tracy", 1, 5, world, first);
    for (std::uint32_t frame = 1; frame < 5; ++frame) run.step(inputs::limits(300, frame, 1));
  }
}

// Were each body to stand in all cells that it touches, these would need a thousand places each.
TEST(Tracy, CoarsensTheGridForBodiesThatTouchManyCells) {
  const std::vector<Aabb> small = inputs::uniform(1000, 0, 4);
  std::vector<Aabb> large = small;
  for (std::size_t i = 0; i < large.size(); ++i) {
    large[i].min[i % 3] = -1;
    large[i].max[i % 3] = 30;
    large[i].min[(i + 1) % 3] = -1;
    large[i].max[(i + 1) % 3] = 30;
  }
  for (const char* id : {"tracy", "tracy-mt"}) {
    Checked run(id, id == std::string("tracy") ? 1 : 3, 1, cube(0, 21.5F), small);
    run.step(large);
    EXPECT_EQ(run.counters()["grid rebuilds"], 1U);
    run.step(large);
    EXPECT_EQ(run.counters()["grid rebuilds"], 0U);
    // A step finer at a time, until the grid is what it was.
    std::uint64_t rebuilds = 0;
    std::vector<Aabb> boxes = small;
    for (int frame = 0; frame < 12; ++frame) {
      moveBy(boxes[0], {0.01F, 0, 0});
      run.step(boxes);
      rebuilds += run.counters()["grid rebuilds"];
    }
    EXPECT_GE(rebuilds, 2U);
    EXPECT_EQ(run.counters()["grid rebuilds"], 0U);
    Checked fresh(id, 1, 1, cube(0, 21.5F), small);
    fresh.step(boxes);
    run.step(boxes);
  }
}

// A floor and four walls among small bodies are no reason to give up the grid.
TEST(Tracy, KeepsTheGridForAFewLargeBodies) {
  std::vector<Aabb> boxes = inputs::uniform(2000, 0, 4);
  for (std::size_t i = 0; i < 5; ++i) boxes[i] = cube(-1, 30);
  Checked run("tracy", 1, 10, cube(0, 28), boxes);
  for (Aabb& box : boxes) moveBy(box, {0.1F, 0.2F, 0});
  run.step(boxes);
  EXPECT_EQ(run.counters()["grid rebuilds"], 0U);
}

/// Remembers what was drawn.
class DrawnBoxes final : public DebugDraw {
 public:
  void box(const Aabb& box, Rgb, int level) override { levels[level].push_back(box); }
  void line(const std::array<float, 3>&, const std::array<float, 3>&, Rgb) override {}
  std::map<int, std::vector<Aabb>> levels;
};

TEST(Tracy, DrawsOccupiedCellsAndTheirSegments) {
  std::vector<Aabb> boxes(100, cube(0.1F, 0.2F));
  for (std::size_t i = 0; i < 50; ++i) boxes[i] = cube(3.5F, 3.6F);
  Checked run("tracy", 1, 1, cube(0, 4), boxes);
  DrawnBoxes drawn;
  run.broadPhase().drawStructure(drawn);
  ASSERT_EQ(drawn.levels[0].size(), 2U);
  EXPECT_EQ(drawn.levels[0][0].min, cube(0, 0).min);
  EXPECT_EQ(drawn.levels[0][1].max, cube(4, 4).max);
  // 100 endpoints in each of the cells: three chunks, the first from the first endpoint on.
  for (const Aabb& cell : drawn.levels[0]) {
    float covered = 0;
    for (const Aabb& segment : drawn.levels[1]) {
      if (overlaps(cell, segment)) covered += segment.max[0] - segment.min[0];
    }
    EXPECT_NEAR(covered, cell.max[0] - cell.min[0], 1e-5F);
  }
  EXPECT_GT(drawn.levels[1].size(), 4U);
}

}  // namespace
}  // namespace broadmark::tests
