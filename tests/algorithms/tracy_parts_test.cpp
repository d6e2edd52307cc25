// The components of Tracy: endpoints, the segmented list, the pair set.

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <vector>

#include "algorithms/runs.h"
#include "broadmark/pair_set.h"
#include "tracy/segmented_list.h"

namespace broadmark::tests {
namespace {

using tracy::Endpoint;
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

/// A segmented list and a naive model of it.
class ListAndModel {
 public:
  ListAndModel(std::uint32_t capacity, int values, std::uint64_t seed)
      : capacity_(capacity), values_(values), random_(seed, 0) {
    list_.build({}, capacity);
  }

  /// A random operation; `fullness` is the expected share of occupied slots.
  void step(double fullness) {
    const auto slot =
        static_cast<std::uint32_t>(random_.integer(0, static_cast<int>(capacity_) - 1));
    const auto found = intervals_.find(slot);
    if (found == intervals_.end()) {
      if (random_.uniform(0, 1) < fullness) insert(slot);
    } else if (random_.uniform(0, 1) > fullness) {
      remove(slot);
    } else {
      moveTo(slot, random_.integer(0, 3) == 0 ? randomInterval() : nearby(found->second));
    }
  }

  void insert(std::uint32_t slot) {
    const Interval interval = intervals_[slot] = randomInterval();
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

  /// Every overlapping interval is visited once; others are visited only if they begin before the
  /// end.
  void checkOverlapping() const {
    for (const auto& [slot, interval] : intervals_) {
      std::map<std::uint32_t, int> visits;
      list_.forEachOverlapping(slot, [&](std::uint32_t other) { ++visits[other]; });
      EXPECT_EQ(visits.count(slot), 0U);
      for (const auto& [other, other_interval] : intervals_) {
        if (other == slot) continue;
        const bool overlaps =
            interval.low <= other_interval.high && other_interval.low <= interval.high;
        const int count = visits[other];
        if (overlaps) {
          ASSERT_EQ(count, 1) << slot << " overlaps " << other;
        }
        ASSERT_TRUE(count == 0 || (count == 1 && other_interval.low <= interval.high))
            << slot << other;
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
  Interval randomInterval() {
    const float low = value();
    // Mostly short, so that open sets are neither empty nor full.
    const int longest = random_.integer(0, 9) == 0 ? values_ : values_ / 20;
    return {low, low + static_cast<float>(random_.integer(0, longest))};
  }
  Interval nearby(const Interval& from) {
    const auto offset = [&] { return static_cast<float>(random_.integer(-2, 2)); };
    const float low = from.low + offset();
    return {low, std::max(low, from.high + offset())};
  }

  void moveTo(std::uint32_t slot, const Interval& to) {
    const Interval from = std::exchange(intervals_[slot], to);
    const auto move_start = [&] {
      move(Endpoint::start(from.low, slot), Endpoint::start(to.low, slot));
    };
    const auto move_end = [&] {
      move(Endpoint::end(from.high, slot), Endpoint::end(to.high, slot));
    };
    if (from.high < to.high) {
      move_end();
      move_start();
    } else {
      move_start();
      move_end();
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
    std::vector<Endpoint> endpoints;
    for (const auto& [slot, interval] : intervals_) {
      endpoints.push_back(Endpoint::start(interval.low, slot));
      endpoints.push_back(Endpoint::end(interval.high, slot));
    }
    std::ranges::sort(endpoints);
    return endpoints;
  }

  std::uint32_t capacity_;
  int values_;
  inputs::Random random_;
  SegmentedList list_{true};
  std::map<std::uint32_t, Interval> intervals_;
};

// Few values make many ties. The list fills and empties, so that chunks split and merge.
TEST(SegmentedList, BehavesLikeANaiveList) {
  for (const int values : {3, 50, 5000}) {
    SCOPED_TRACE(values);
    ListAndModel both(512, values, 7);
    int max_chunks = 0;
    for (int round = 0; round < 12; ++round) {
      for (int i = 0; i < 800; ++i) {
        both.step(round % 4 < 2 ? 0.9 : 0.1);
        if (i % 8 == 0) both.check();
        if (HasFailure()) return;
      }
      max_chunks = std::max(max_chunks, both.chunks());
      both.checkOverlapping();
      if (HasFailure()) return;
    }
    EXPECT_GE(max_chunks, 12);
  }
}

// Very long lists have larger chunks, or the open sets would need superlinear memory.
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

TEST(SegmentedList, BuildsTheSameListAsInsertions) {
  ListAndModel both(256, 1000, 11);
  for (std::uint32_t slot = 0; slot < 256; slot += 2) both.insert(slot);
  for (const std::uint32_t capacity : {256U, 512U, 4096U}) {
    both.list().build(both.list().endpoints(), capacity);
    both.check();
    both.checkOverlapping();
  }
}

TEST(SegmentedList, DetectsNearMoves) {
  SegmentedList list(false);
  std::vector<Endpoint> sorted;
  for (std::uint32_t slot = 0; slot < 500; ++slot) {
    sorted.push_back(Endpoint::start(static_cast<float>(slot), slot));
    sorted.push_back(Endpoint::end(static_cast<float>(slot) + 0.5F, slot));
  }
  list.build(sorted, 512);
  const auto is_near_250 = [&](float value) {
    return list.isNear(Endpoint::start(250, 250), Endpoint::start(value, 250));
  };
  EXPECT_TRUE(is_near_250(250));
  EXPECT_TRUE(is_near_250(260));
  EXPECT_TRUE(is_near_250(240));
  EXPECT_FALSE(is_near_250(400));
  EXPECT_FALSE(is_near_250(100));
}

TEST(PairSet, BehavesLikeStdSet) {
  PairSet pairs;
  std::set<Pair> expected;
  inputs::Random random(3, 0);
  for (int round = 0; round < 2; ++round) {
    for (int change = 0; change < 400; ++change) {
      std::set<Pair> inserted;
      std::set<Pair> erased;
      for (int i = random.integer(0, 100); i > 0; --i) {
        const auto a = static_cast<std::uint32_t>(random.integer(0, 60));
        const Pair pair{a, a + static_cast<std::uint32_t>(random.integer(1, 60))};
        (expected.contains(pair) ? erased : inserted).insert(pair);
      }
      for (const Pair pair : erased) expected.erase(pair);
      expected.insert(inserted.begin(), inserted.end());
      pairs.erase(std::vector<Pair>(erased.begin(), erased.end()));
      pairs.insert(std::vector<Pair>(inserted.begin(), inserted.end()));
      const PairRun contents = pairs.run();
      ASSERT_EQ(sorted({&contents, 1}), std::vector<Pair>(expected.begin(), expected.end()));
      for (const Pair pair : inserted) ASSERT_TRUE(pairs.contains(pair));
      for (const Pair pair : erased) ASSERT_FALSE(pairs.contains(pair));
    }
    const Pair present = pairs.run().front();
    const Pair absent = {100, 200};
    EXPECT_THROW(pairs.insert({&present, 1}), std::logic_error);
    EXPECT_THROW(pairs.erase({&absent, 1}), std::logic_error);
    pairs.clear();
    EXPECT_THROW(pairs.erase({&present, 1}), std::logic_error);
    expected.clear();
    EXPECT_TRUE(pairs.run().empty());
  }
}

}  // namespace
}  // namespace broadmark::tests
