#include "inspector/run/pair_comparison.h"

#include <algorithm>
#include <iterator>

namespace broadmark {
namespace {

std::vector<Pair> sorted(std::span<const Pair> pairs) {
  std::vector<Pair> copy(pairs.begin(), pairs.end());
  std::ranges::sort(copy);
  const auto twice = std::ranges::unique(copy);
  copy.erase(twice.begin(), twice.end());
  return copy;
}

}  // namespace

PairComparison comparePairs(std::span<const Pair> first, std::span<const Pair> second) {
  const std::vector<Pair> a = sorted(first);
  const std::vector<Pair> b = sorted(second);
  PairComparison comparison;
  std::ranges::set_difference(a, b, std::back_inserter(comparison.first_only));
  std::ranges::set_difference(b, a, std::back_inserter(comparison.second_only));
  comparison.both = a.size() - comparison.first_only.size();
  return comparison;
}

}  // namespace broadmark
