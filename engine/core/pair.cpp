// Counting pairs.

#include "broadmark/pair.h"

namespace broadmark {

std::vector<std::uint32_t> overlapCounts(std::size_t bodies, PairRuns pairs) {
  std::vector<std::uint32_t> counts(bodies, 0);
  for (const PairRun run : pairs) {
    for (const Pair pair : run) {
      if (pair.a >= bodies || pair.b >= bodies) continue;
      ++counts[pair.a];
      ++counts[pair.b];
    }
  }
  return counts;
}

}  // namespace broadmark
