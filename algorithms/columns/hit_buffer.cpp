// The sweep has tested keys only. A kernel checks the rest of a pair: that its entries overlap on
// the sweep axis, and that this is its home column. Ambiguous pairs are resolved here, in batches:
// the boxes lie in the order of the bodies and are likely not cached, so a batch is prefetched
// first.

#include "columns/hit_buffer.h"

#include <utility>

#include "prefetch.h"

namespace broadmark::columns {

void HitBuffer::flush() {
  extractPairs();
  resolveAmbiguous();
}

/// Each round takes one bit of every mask, so that no branch depends on the number of bits.
void HitBuffer::extractPairs() {
  while (size_ > 0) {
    if (ambiguous_count_ + size_ > kMaxAmbiguous) resolveAmbiguous();
    Pair* const begin = pairs_.room(size_ + Kernels::kExtractWidth);
    Pair* pairs = begin;
    Pair* ambiguous = ambiguous_ + ambiguous_count_;
    size_ =
        kernels_.extract_pairs(positions_, masks_, size_, sorted_.entries.data(), pairs, ambiguous);
    pairs_.advance(static_cast<std::size_t>(pairs - begin));
    ambiguous_count_ = static_cast<std::size_t>(ambiguous - ambiguous_);
  }
}

void HitBuffer::resolveAmbiguous() {
  for (std::size_t k = 0; k < ambiguous_count_; ++k) {
    prefetchL2(&boxes_[ambiguous_[k].a]);
    prefetchL2(&boxes_[ambiguous_[k].b]);
  }
  Pair* const room = pairs_.room(ambiguous_count_);
  std::size_t count = 0;
  for (std::size_t k = 0; k < ambiguous_count_; ++k) {
    room[count] = ambiguous_[k];
    count += overlaps(boxes_[ambiguous_[k].a], boxes_[ambiguous_[k].b]) ? 1 : 0;
  }
  pairs_.advance(count);
  box_tests_ += std::exchange(ambiguous_count_, 0);
}

}  // namespace broadmark::columns
