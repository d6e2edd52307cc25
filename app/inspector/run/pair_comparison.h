// Which pairs two answers share, and which only one of them has.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "broadmark/pair.h"

namespace broadmark {

struct PairComparison {
  std::vector<Pair> first_only;   ///< ascending
  std::vector<Pair> second_only;  ///< likewise
  std::uint64_t both = 0;
};

/// Of pairs in any order; what an answer holds twice counts once. O(n log n).
PairComparison comparePairs(std::span<const Pair> first, std::span<const Pair> second);

}  // namespace broadmark
