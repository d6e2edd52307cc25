// Hits are of copies whose keys overlap. What else a pair needs is looked up here: that the copies
// overlap on the sweep axis, too, that it is the column in which the pair is reported, and where
// bounds share a step, that the boxes overlap.
//
// Boxes are likely not in the caches, as they lie in the order of the bodies. So several of them
// are sent for before any is compared.

#include "columns/hits.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "prefetch.h"

namespace broadmark::columns {

void HitSink::flush() {
  takeAll();
  decide();
}

void HitSink::takeAll() {
  // One bit of all hits after the other, so that nothing depends on how many each of them has.
  while (size_ > 0) takeOneEach();
}

/// Takes the lowest bit of all hits, and keeps those that have more. Conditions are numbers here,
/// as nobody can tell how they turn out.
void HitSink::takeOneEach() {
  const Copy* const copies = sorted_.copies.data();
  if (doubts_ + size_ > kMostDoubts) decide();
  Pair* room = pairs_.room(size_);
  Pair* doubtful = doubtful_ + doubts_;
  const Pair* const begin = room;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < size_; ++k) {
    const std::uint32_t row = hits_[k].row;
    const std::uint32_t column = hits_[k].column;
    const std::uint64_t bits = hits_[k].bits;
    const std::uint64_t more = bits & (bits - 1);
    hits_[kept].row = row;
    hits_[kept].column = column;
    hits_[kept].bits = more;
    kept += std::size_t{more != 0};

    const int bit = std::countr_zero(bits);
    const std::size_t i = row + kernels_.row_of[bit];
    const std::size_t j = column + kernels_.lane_of[bit];
    const Copy& a = copies[i];
    const Copy& b = copies[j];
    const unsigned hit = unsigned{j > i} & unsigned{a.first <= b.last} &
                         unsigned{b.first <= a.last} & unsigned{reportedHere(a.body, b.body)};
    const unsigned shared = unsigned{a.first == b.last} | unsigned{b.first == a.last} |
                            unsigned{sharesStep(b.key, limitsOf(a.key))};
    const Pair pair = orderedPair(bodyNumber(a.body), bodyNumber(b.body));
    *room = pair;
    room += hit & ~shared;
    *doubtful = pair;
    doubtful += hit & shared;
  }
  pairs_.advance(static_cast<std::size_t>(room - begin));
  doubts_ = static_cast<std::size_t>(doubtful - doubtful_);
  size_ = kept;
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
