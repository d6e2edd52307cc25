// Maps the answer of an algorithm, with numbers of its own for the bodies, back to bodies.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "adapters/workers_for_pairs.h"
#include "broadmark/broad_phase.h"
#include "broadmark/execution.h"
#include "broadmark/pair.h"

namespace broadmark {

/// The number of no body: pairs with it are invalid.
inline constexpr std::uint32_t kNoBody = std::numeric_limits<std::uint32_t>::max();

/// Maps numbers to `bodies`, in place; drops the pairs for which remains(numbers) is false. Pairs
/// of numbers without a body become invalid, and remain. Returns how many remain.
template <class Remains>
std::size_t mapInPlace(std::span<Pair> pairs, std::span<const std::uint32_t> bodies,
                       const Remains& remains) {
  std::size_t count = 0;
  for (const Pair pair : pairs) {
    const bool exist = pair.a < pair.b && pair.b < bodies.size();
    const Pair mapped = exist ? orderedPair(bodies[pair.a], bodies[pair.b]) : Pair{};
    if (!exist || mapped.b == kNoBody) [[unlikely]] {
      pairs[count++] = {kNoBody, kNoBody};
      continue;
    }
    pairs[count] = mapped;
    count += remains(pair) ? 1 : 0;
  }
  return count;
}

/// The answer of an algorithm, mapped: by the algorithm as it finds pairs, if it can, otherwise
/// after its search.
class MappedPairs {
 public:
  /// Before the algorithm's initialize(). Borrows both.
  void attach(BroadPhase& algorithm, const PairMap& map) {
    algorithm_ = &algorithm;
    map_ = &map;
    algorithm_maps_ = algorithm.mapPairs(map);
  }

  /// After the algorithm's search. Divided among the team.
  void collect(ThreadTeam& team) {
    if (algorithm_maps_) return;
    const PairRuns found = algorithm_->overlaps();
    if (pairs_.size() < found.size()) pairs_.resize(found.size());
    constexpr double kPairNs = 5;
    const int workers = workersForPairs(found, kPairNs, team);
    team.runOn(workers, [&](int worker) {
      const Range runs = share(found.size(), workers, worker);
      for (std::size_t i = runs.begin; i < runs.end; ++i) mapRun(found[i], pairs_[i]);
    });
    runs_.clear();
    for (std::size_t i = 0; i < found.size(); ++i) runs_.push_back(pairs_[i].run());
  }
  void clear() {
    for (PairBuffer& pairs : pairs_) pairs.clear();
    runs_.clear();
  }
  [[nodiscard]] PairRuns runs() const {
    return algorithm_maps_ ? algorithm_->overlaps() : PairRuns(runs_);
  }

 private:
  void mapRun(PairRun found, PairBuffer& result) const {
    result.setMap(map_);
    while (!found.empty()) {
      const PairRun block = found.first(std::min(PairBuffer::kBlock, found.size()));
      std::ranges::copy(block, result.room(block.size()));
      result.advance(block.size());
      found = found.subspan(block.size());
    }
    result.flush();
  }

  BroadPhase* algorithm_ = nullptr;
  const PairMap* map_ = nullptr;
  bool algorithm_maps_ = false;
  std::vector<PairBuffer> pairs_;  ///< one buffer per run of the algorithm's answer
  std::vector<PairRun> runs_;
};

}  // namespace broadmark
