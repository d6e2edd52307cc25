// Searching where the answer is likely to be close to the last one, as for windows in a sorted
// list.
#pragma once

#include <algorithm>
#include <cstddef>

namespace broadmark {

/// The first position in [first, last) at which `inside` is false, else last; it is true before and
/// false from there on. Searches from `hint` outwards: O(log distance).
template <class Inside>
std::size_t boundaryNear(std::size_t hint, std::size_t first, std::size_t last, Inside inside) {
  std::size_t step = 1;
  if (hint < last && inside(hint)) {
    first = hint + 1;
    while (last - first > step && inside(first + step)) {
      first += step + 1;
      step *= 2;
    }
    last = std::min(last, first + step);
  } else {
    last = hint;
    while (last - first > step && !inside(last - step)) {
      last -= step;
      step *= 2;
    }
    if (last - first > step) first = last - step + 1;
  }
  // Without a branch on what is found: it would be a coin toss for the predictor.
  for (std::size_t count = last - first; count > 0;) {
    const std::size_t half = (count + 1) / 2;
    first += inside(first + half - 1) ? half : 0;
    count -= half;
  }
  return first;
}

}  // namespace broadmark
