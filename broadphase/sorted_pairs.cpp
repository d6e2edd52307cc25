#include "sorted_pairs.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

namespace broadmark {

void PairArray::append(PairRun pairs) {
  if (pairs.empty()) return;
  const std::size_t size = pairs_.size();
  pairs_.resize(size + pairs.size());
  std::memcpy(pairs_.data() + size, pairs.data(), pairs.size_bytes());
}

void PairArray::assign(PairRuns runs) {
  clear();
  for (const PairRun run : runs) append(run);
}

/// A counting sort by the lower body, which leaves few pairs to sort for each. For few pairs the
/// counters of all bodies would cost more than a comparison sort.
void PairArray::assignSorted(PairRuns runs, std::size_t bodies) {
  constexpr std::size_t kMinPairsForCounting = 256;
  const std::size_t count = pairCount(runs);
  if (count < std::max(kMinPairsForCounting, bodies / 16) ||
      count > std::numeric_limits<std::uint32_t>::max()) {
    assign(runs);
    if (!std::is_sorted(pairs_.begin(), pairs_.end())) std::sort(pairs_.begin(), pairs_.end());
    return;
  }
  begins_.resize(bodies);
  std::fill(begins_.begin(), begins_.end(), 0U);
  for (const PairRun run : runs) {
    for (const Pair pair : run) ++begins_[pair.a];
  }
  std::uint32_t begin = 0;
  for (std::uint32_t& of_body : begins_) begin += std::exchange(of_body, begin);
  pairs_.resize(count);
  for (const PairRun run : runs) {
    for (const Pair pair : run) pairs_[begins_[pair.a]++] = pair;
  }
  constexpr std::size_t kMaxForInsertion = 24;
  std::size_t first = 0;
  for (const std::uint32_t end : begins_) {  // each has advanced to the end of its body's pairs
    Pair* const own = pairs_.data() + first;
    const std::size_t size = end - first;
    first = end;
    if (size > kMaxForInsertion) {
      std::sort(own, own + size);
      continue;
    }
    for (std::size_t i = 1; i < size; ++i) {
      const Pair pair = own[i];
      std::size_t gap = i;
      for (; gap > 0 && pair.b < own[gap - 1].b; --gap) own[gap] = own[gap - 1];
      own[gap] = pair;
    }
  }
}

namespace {

/// The first pair of an ascending range that is not less than `pair`. The steps double: fast if it
/// is near the beginning.
const Pair* firstNotLess(const Pair* begin, const Pair* end, Pair pair) {
  std::ptrdiff_t step = 1;
  const Pair* low = begin;
  while (end - low > step && low[step] < pair) {
    low += step;
    step *= 2;
  }
  return std::lower_bound(low, end - low > step ? low + step + 1 : end, pair);
}

}  // namespace

void PairArray::apply(PairRun began, PairRun ended) {
  if (began.empty() && ended.empty()) return;
  std::swap(pairs_, spare_);
  pairs_.resize(spare_.size() + began.size());
  Pair* out = pairs_.data();
  const Pair* in = spare_.data();
  const Pair* const in_end = in + spare_.size();
  const auto copy_until = [&](const Pair* end) {
    if (end != in) std::memcpy(out, in, static_cast<std::size_t>(end - in) * sizeof(Pair));
    out += end - in;
    in = end;
  };
  auto begins = began.begin();
  auto ends = ended.begin();
  while (begins != began.end() || ends != ended.end()) {
    const bool is_end = begins == began.end() || (ends != ended.end() && *ends < *begins);
    const Pair event = is_end ? *ends : *begins;
    copy_until(firstNotLess(in, in_end, event));
    if (is_end != (in != in_end && *in == event)) {
      throw std::logic_error("an event contradicts the pairs before it");
    }
    if (is_end) {
      ++ends;
      ++in;
    } else {
      *out++ = *begins++;
    }
  }
  copy_until(in_end);
  pairs_.resize(static_cast<std::size_t>(out - pairs_.data()));
}

void PairArray::assignDifference(PairRun from, PairRun without) {
  pairs_.resize(from.size());
  const Pair* const end =
      std::set_difference(from.begin(), from.end(), without.begin(), without.end(), pairs_.begin());
  pairs_.resize(static_cast<std::size_t>(end - pairs_.begin()));
}

}  // namespace broadmark
