// Hits are of copies whose keys overlap. What else a pair needs is looked up by a kernel: that the
// copies overlap on the sweep axis, too, and that it is the column in which the pair is reported.
// Where bounds share a step, the boxes decide, here.
//
// Boxes are likely not in the caches, as they lie in the order of the bodies. So several of them
// are sent for before any is compared.

#include "columns/hits.h"

#include <utility>

#include "prefetch.h"

namespace broadmark::columns {

void HitSink::flush() {
  takeAll();
  decide();
}

/// One bit of all hits after the other, so that nothing depends on how many each of them has.
void HitSink::takeAll() {
  while (size_ > 0) {
    if (doubts_ + size_ > kMostDoubts) decide();
    Pair* const begin = pairs_.room(size_ + Kernels::kTakenTogether);
    Pair* pairs = begin;
    Pair* doubtful = doubtful_ + doubts_;
    size_ = kernels_.take_pairs(places_, bits_, size_, sorted_.copies.data(), pairs, doubtful);
    pairs_.advance(static_cast<std::size_t>(pairs - begin));
    doubts_ = static_cast<std::size_t>(doubtful - doubtful_);
  }
}

/// Has the boxes decide.
void HitSink::decide() {
  for (std::size_t k = 0; k < doubts_; ++k) {
    prefetchFar(&boxes_[doubtful_[k].a]);
    prefetchFar(&boxes_[doubtful_[k].b]);
  }
  Pair* const room = pairs_.room(doubts_);
  std::size_t count = 0;
  for (std::size_t k = 0; k < doubts_; ++k) {
    room[count] = doubtful_[k];
    count += overlaps(boxes_[doubtful_[k].a], boxes_[doubtful_[k].b]) ? 1 : 0;
  }
  pairs_.advance(count);
  compared_boxes_ += std::exchange(doubts_, 0);
}

}  // namespace broadmark::columns
