// Sorting by counting, and comparing.

#include "events_from_pairs.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace broadmark {
namespace {

/// Adds the pairs of `body` with what is in `some` and not in `others`; both ascend. What is there
/// more often counts, too.
void addDifference(std::span<const std::uint32_t> some, std::span<const std::uint32_t> others,
                   std::uint32_t body, PairBuffer& pairs) {
  auto other = others.begin();
  for (const std::uint32_t one : some) {
    while (other != others.end() && *other < one) ++other;
    if (other != others.end() && *other == one) {
      ++other;
    } else {
      pairs.add(body, one);
    }
  }
}

void addAsItIs(Pair pair, PairBuffer& pairs) {
  *pairs.room(1) = pair;
  pairs.advance(1);
}

}  // namespace

EventsFromPairs::EventsFromPairs(std::unique_ptr<BroadPhase> algorithm)
    : algorithm_(std::move(algorithm)) {}

void EventsFromPairs::visitParameters(const ParameterVisitor& visit) {
  algorithm_->visitParameters(visit);
}

void EventsFromPairs::initialize(const SceneInfo& scene, const Frame& first, Execution& execution) {
  team_ = &execution.team();
  bodies_ = first.boxes.size();
  parts_ = std::vector<Part>(static_cast<std::size_t>(team_->size()));
  for (std::size_t worker = 0; worker < parts_.size(); ++worker) {
    parts_[worker].found = std::vector<PairBuffer>(parts_.size());
    const std::size_t groups = (bodies_ + parts_.size() - 1 - worker) / parts_.size();
    for (Groups& each : parts_[worker].groups) each.begins.assign(groups + 1, 0);
  }
  began_.resize(parts_.size());
  ended_.resize(parts_.size());
  algorithm_->initialize(scene, first, execution);
  updateObjects(first);
  cleanCache();
  updateStructures();
  searchOverlaps();
}

void EventsFromPairs::searchOverlaps() {
  algorithm_->searchOverlaps();
  const PairRuns answer = algorithm_->overlaps();
  now_ ^= 1;
  team_->run([&](int worker) { shareOut(answer, static_cast<std::size_t>(worker)); });
  team_->run([&](int worker) {
    group(static_cast<std::size_t>(worker));
    compare(static_cast<std::size_t>(worker));
  });
  for (std::size_t worker = 0; worker < parts_.size(); ++worker) {
    began_[worker] = parts_[worker].began.run();
    ended_[worker] = parts_[worker].ended.run();
  }
}

void EventsFromPairs::shareOut(PairRuns answer, std::size_t worker) {
  Part& part = parts_[worker];
  for (PairBuffer& found : part.found) found.clear();
  part.began.clear();
  part.ended.clear();
  auto [begin, end] =
      share(pairCount(answer), static_cast<int>(parts_.size()), static_cast<int>(worker));
  for (const PairRun run : answer) {
    const std::size_t from = std::min(begin, run.size());
    const std::size_t to = std::min(end, run.size());
    for (const Pair pair : run.subspan(from, to - from)) {
      const bool is_pair = pair.a < pair.b && pair.b < bodies_;
      addAsItIs(pair, is_pair ? part.found[pair.a % parts_.size()] : part.began);
    }
    begin -= from;
    end -= to;
  }
}

void EventsFromPairs::group(std::size_t worker) {
  const auto workers = static_cast<std::uint32_t>(parts_.size());
  Groups& groups = parts_[worker].groups[now_];
  std::ranges::fill(groups.begins, 0);
  for (const Part& part : parts_) {
    for (const Pair pair : part.found[worker].run()) ++groups.begins[pair.a / workers];
  }
  std::inclusive_scan(groups.begins.begin(), groups.begins.end(), groups.begins.begin());
  groups.others.resize(groups.begins.back());
  for (const Part& part : parts_) {
    for (const Pair pair : part.found[worker].run()) {
      groups.others[--groups.begins[pair.a / workers]] = pair.b;
    }
  }
}

void EventsFromPairs::compare(std::size_t worker) {
  Part& part = parts_[worker];
  Groups& groups = part.groups[now_];
  const Groups& groups_before = part.groups[now_ ^ 1];
  for (std::size_t i = 0; i + 1 < groups.begins.size(); ++i) {
    std::sort(groups.others.begin() + static_cast<std::ptrdiff_t>(groups.begins[i]),
              groups.others.begin() + static_cast<std::ptrdiff_t>(groups.begins[i + 1]));
    const std::span<const std::uint32_t> now = groups.of(i);
    const std::span<const std::uint32_t> before = groups_before.of(i);
    if (std::ranges::equal(now, before)) continue;
    const auto body = static_cast<std::uint32_t>(i * parts_.size() + worker);
    addDifference(now, before, body, part.began);
    addDifference(before, now, body, part.ended);
  }
}

void EventsFromPairs::visitCounters(const CounterVisitor& visit) const {
  visit("pairs begun", pairCount(began_));
  visit("pairs ended", pairCount(ended_));
  algorithm_->visitCounters(visit);
}

}  // namespace broadmark
