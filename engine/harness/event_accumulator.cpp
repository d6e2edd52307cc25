// Sorts events, so that those of one pair are adjacent.

#include "broadmark/harness/event_accumulator.h"

#include <algorithm>
#include <iterator>

namespace broadmark {

void EventAccumulator::clear() {
  pairs_.clear();
  impossible_.clear();
  run_ = {};
}

void EventAccumulator::apply(const PairEvents& events, std::size_t bodies) {
  impossible_.clear();
  if (eventCount(events) == 0) return;
  events_.clear();
  const auto add = [&](PairRuns runs, bool ends) {
    for (const PairRun chunk : runs) {
      for (const Pair pair : chunk) events_.emplace_back(pair, ends);
    }
  };
  add(events.began, false);
  add(events.ended, true);
  std::ranges::sort(events_);
  began_.clear();
  ended_.clear();
  for (auto first = events_.begin(); first != events_.end();) {
    const auto [pair, ends] = *first;
    const auto next = std::find_if(
        first, events_.end(), [&, here = pair](const auto& event) { return event.first != here; });
    const bool is_valid = pair.a < pair.b && pair.b < bodies;
    const bool is_possible = ends == std::ranges::binary_search(pairs_, pair);
    if (!is_valid || !is_possible || next - first > 1) impossible_.push_back(pair);
    const bool is_change = is_possible && std::prev(next)->second == ends;
    if (is_valid && is_change) (ends ? ended_ : began_).push_back(pair);
    first = next;
  }
  next_.clear();
  std::ranges::set_difference(pairs_, ended_, std::back_inserter(next_));
  pairs_.clear();
  std::ranges::merge(next_, began_, std::back_inserter(pairs_));
  run_ = pairs_;
}

}  // namespace broadmark
