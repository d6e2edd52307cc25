// Maps the answer of an algorithm, with numbers of its own for the bodies, back to bodies.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "adapters/workers_for_pairs.h"
#include "broadmark/execution.h"
#include "broadmark/pair.h"

namespace broadmark {

class MappedPairs {
 public:
  /// The number of no body: pairs with it are invalid.
  static constexpr std::uint32_t kNoBody = std::numeric_limits<std::uint32_t>::max();

  /// Maps an answer, divided among the team. `bodies`: by number. Pairs are dropped unless
  /// is_wanted(numbers, bodies); invalid ones stay invalid.
  template <class IsWanted>
  void map(ThreadTeam& team, PairRuns found, std::span<const std::uint32_t> bodies,
           const IsWanted& is_wanted) {
    if (pairs_.size() < found.size()) pairs_.resize(found.size());
    constexpr double kPairNs = 5;
    const int workers = workersForPairs(found, kPairNs, team);
    team.runOn(workers, [&](int worker) {
      const Range runs = share(found.size(), workers, worker);
      for (std::size_t i = runs.begin; i < runs.end; ++i) {
        mapRun(found[i], bodies, is_wanted, pairs_[i]);
      }
    });
    runs_.clear();
    for (std::size_t i = 0; i < found.size(); ++i) runs_.push_back(pairs_[i].run());
  }
  void clear() {
    for (PairBuffer& pairs : pairs_) pairs.clear();
    runs_.clear();
  }
  [[nodiscard]] PairRuns runs() const { return runs_; }

 private:
  template <class IsWanted>
  static void mapRun(PairRun found, std::span<const std::uint32_t> bodies,
                     const IsWanted& is_wanted, PairBuffer& result) {
    result.clear();
    Pair* const room = result.room(found.size());
    std::size_t count = 0;
    for (const Pair pair : found) {
      if (pair.a >= pair.b || pair.b >= bodies.size()) [[unlikely]] {
        room[count++] = {kNoBody, kNoBody};
        continue;
      }
      const Pair mapped = orderedPair(bodies[pair.a], bodies[pair.b]);
      room[count] = mapped;
      count += is_wanted(pair, mapped) ? 1 : 0;
    }
    result.advance(count);
  }

  std::vector<PairBuffer> pairs_;  ///< one buffer per run of the algorithm's answer
  std::vector<PairRun> runs_;
};

}  // namespace broadmark
