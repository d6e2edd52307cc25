// The pairs that follow from events, and impossible events.

#include "broadmark/harness/event_accumulator.h"

#include <gtest/gtest.h>

#include <vector>

namespace broadmark::tests {
namespace {

class Followed : public testing::Test {
 protected:
  static constexpr std::size_t kBodies = 10;

  /// The events of a frame, in two runs each.
  void apply(const std::vector<Pair>& began, const std::vector<Pair>& ended) {
    accumulator_.apply({split(began, began_), split(ended, ended_)}, kBodies);
  }
  [[nodiscard]] std::vector<Pair> pairs() const {
    const PairRun pair_run = accumulator_.pairs().front();
    return {pair_run.begin(), pair_run.end()};
  }
  [[nodiscard]] std::vector<Pair> impossible() const {
    return {accumulator_.impossible().begin(), accumulator_.impossible().end()};
  }

  using Pairs = std::vector<Pair>;
  EventAccumulator accumulator_;

 private:
  static PairRuns split(const std::vector<Pair>& pairs, std::vector<PairRun>& runs) {
    const std::size_t half = pairs.size() / 2;
    runs = {PairRun(pairs).first(half), PairRun(pairs).subspan(half)};
    return runs;
  }

  std::vector<PairRun> began_;
  std::vector<PairRun> ended_;
};

TEST_F(Followed, PairsBeginAndEnd) {
  apply({{2, 3}, {0, 5}, {0, 1}}, {});
  EXPECT_EQ(pairs(), (Pairs{{0, 1}, {0, 5}, {2, 3}}));
  apply({{1, 2}}, {{0, 5}, {2, 3}});
  EXPECT_EQ(pairs(), (Pairs{{0, 1}, {1, 2}}));
  apply({}, {});
  EXPECT_EQ(pairs(), (Pairs{{0, 1}, {1, 2}}));
  apply({}, {{0, 1}, {1, 2}});
  EXPECT_EQ(pairs(), Pairs());
  EXPECT_EQ(impossible(), Pairs());
  apply({{0, 1}}, {});
  accumulator_.clear();
  EXPECT_EQ(pairs(), Pairs());
}

TEST_F(Followed, WhatIsThereCannotBegin) {
  apply({{0, 1}}, {});
  apply({{0, 1}, {0, 2}}, {});
  EXPECT_EQ(impossible(), (Pairs{{0, 1}}));
  EXPECT_EQ(pairs(), (Pairs{{0, 1}, {0, 2}}));
  apply({}, {});
  EXPECT_EQ(impossible(), Pairs()) << "of the last frame only";
}

TEST_F(Followed, WhatIsNotThereCannotEnd) {
  apply({}, {{0, 1}});
  EXPECT_EQ(impossible(), (Pairs{{0, 1}}));
  EXPECT_EQ(pairs(), Pairs());
}

TEST_F(Followed, NothingBeginsOrEndsTwice) {
  apply({{0, 1}, {0, 1}, {0, 2}}, {});
  EXPECT_EQ(impossible(), (Pairs{{0, 1}}));
  EXPECT_EQ(pairs(), (Pairs{{0, 1}, {0, 2}}));
  apply({}, {{0, 1}, {0, 1}});
  EXPECT_EQ(impossible(), (Pairs{{0, 1}}));
  EXPECT_EQ(pairs(), (Pairs{{0, 2}}));
}

TEST_F(Followed, NothingBeginsAndEndsInOneFrame) {
  apply({{0, 1}}, {});
  apply({{0, 1}, {3, 4}}, {{0, 1}, {3, 4}});
  EXPECT_EQ(impossible(), (Pairs{{0, 1}, {3, 4}}));
  EXPECT_EQ(pairs(), (Pairs{{0, 1}})) << "as it was";
}

TEST_F(Followed, WhatIsNoPairIsNotKept) {
  const Pairs none = {{1, 0}, {2, 2}, {3, kBodies}, {0xFFFF'FFFF, 0xFFFF'FFFF}};
  apply(none, {});
  EXPECT_EQ(impossible(), none);
  EXPECT_EQ(pairs(), Pairs());
  apply({}, none);
  EXPECT_EQ(impossible(), none);
}

}  // namespace
}  // namespace broadmark::tests
