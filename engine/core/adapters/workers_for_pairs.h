// How many workers an adapter divides an answer among.
#pragma once

#include <algorithm>

#include "broadmark/execution.h"
#include "broadmark/pair.h"

namespace broadmark {

/// Those that pay for work of `pair_ns` on each pair. If several workers found the pairs, they are
/// still awake, and pay for far less.
inline int workersForPairs(PairRuns pairs, double pair_ns, const ThreadTeam& team) {
  constexpr double kMinAwakeShareNs = kMinShareNs / 10;
  const auto finders = std::ranges::count_if(pairs, [](PairRun found) { return !found.empty(); });
  return workersThatPay(pair_ns * static_cast<double>(pairCount(pairs)), team.size(),
                        finders > 1 ? kMinAwakeShareNs : kMinShareNs);
}

}  // namespace broadmark
