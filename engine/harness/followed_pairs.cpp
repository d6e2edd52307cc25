// Three sorted lists, merged: the pairs so far, those that began, those that ended.

#include "broadmark/harness/followed_pairs.h"

#include <algorithm>

namespace broadmark {
namespace {

void assignSorted(std::vector<Pair>& pairs, PairRuns runs) {
  pairs.clear();
  for (const PairRun run : runs) pairs.insert(pairs.end(), run.begin(), run.end());
  std::ranges::sort(pairs);
}

/// Goes through a sorted list.
class Walk {
 public:
  explicit Walk(const std::vector<Pair>& pairs) : next_(pairs.begin()), end_(pairs.end()) {}

  [[nodiscard]] bool done() const { return next_ == end_; }
  [[nodiscard]] Pair front() const { return *next_; }
  /// Passes over this pair, which is the next one or comes before it. Returns how often it is
  /// there.
  std::size_t pass(Pair pair) {
    std::size_t count = 0;
    for (; !done() && front() == pair; ++next_) ++count;
    return count;
  }

 private:
  std::vector<Pair>::const_iterator next_;
  std::vector<Pair>::const_iterator end_;
};

}  // namespace

void FollowedPairs::clear() {
  pairs_.clear();
  impossible_.clear();
  run_ = {};
}

void FollowedPairs::apply(const PairEvents& events, std::size_t bodies) {
  impossible_.clear();
  if (eventCount(events) == 0) return;
  assignSorted(began_, events.began);
  assignSorted(ended_, events.ended);
  next_.clear();
  Walk before(pairs_);
  Walk began(began_);
  Walk ended(ended_);
  while (!before.done() || !began.done() || !ended.done()) {
    Pair pair = {0xFFFF'FFFF, 0xFFFF'FFFF};
    for (const Walk& walk : {before, began, ended}) {
      if (!walk.done()) pair = std::min(pair, walk.front());
    }
    const bool was_there = before.pass(pair) > 0;
    const std::size_t beginnings = began.pass(pair);
    const std::size_t ends = ended.pass(pair);
    const bool is_event = beginnings + ends > 0;
    const bool is_pair = pair.a < pair.b && pair.b < bodies;
    const bool is_due = beginnings + ends == 1 && (ends == 1) == was_there;
    if (is_event && !(is_pair && is_due)) impossible_.push_back(pair);
    const bool changes = (beginnings > 0) != (ends > 0);
    if (is_pair && (changes ? beginnings > 0 : was_there)) next_.push_back(pair);
  }
  pairs_.swap(next_);
  run_ = pairs_;
}

}  // namespace broadmark
