// What is kept of a box in a column, in steps: on the sweep axis its bounds, on the axes that are
// cut its key, 32 bits; and whose it is.
//
// The key is four bytes: the first step on both axes, and the last step on both, counted down from
// 255. A copy's limits are the bytes that another copy's key may have at most: its own last steps,
// and its first steps counted down. So two copies overlap on both axes, in steps, if no byte of
// one's key is above the other's limits: one comparison of vectors of bytes tests a vector of
// copies on four sides. The last step on the sweep axis is counted down, too, so that a copy's
// numbers are compared in the same way.
//
// That is exact but where bounds share a step. Only then are the boxes themselves looked at.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "broadmark/large_array.h"
#include "marked_body.h"

namespace broadmark::columns {

/// First and last steps on two axes, from 0 to 255.
constexpr std::uint32_t keyOf(std::uint32_t first_a, std::uint32_t first_b, std::uint32_t last_a,
                              std::uint32_t last_b) {
  return first_a | first_b << 8 | (255 - last_a) << 16 | (255 - last_b) << 24;
}
/// The limits for other copies' keys that follow from a key.
constexpr std::uint32_t limitsOf(std::uint32_t key) { return ~(key << 16 | key >> 16); }

/// A box in one of the columns that it touches.
struct alignas(16) Copy {
  std::uint32_t first;      ///< step on the sweep axis
  std::uint32_t last_down;  ///< its last step there, counted down: all bits are the opposite ones
  std::uint32_t key;
  MarkedBody body;

  [[nodiscard]] constexpr std::uint32_t last() const { return ~last_down; }
};

/// Whether two copies in a column overlap in steps.
constexpr bool overlapInSteps(const Copy& a, const Copy& b) {
  const std::uint32_t limits = limitsOf(a.key);
  for (int shift = 0; shift < 32; shift += 8) {
    if ((b.key >> shift & 255) > (limits >> shift & 255)) return false;
  }
  return a.first <= b.last() && b.first <= a.last();
}

/// The copies of a column in the order of their lower bounds, roughly. Behind the last one there is
/// padding for whole vectors.
struct Sorted {
  static constexpr std::size_t kPadding = 64;

  LargeArray<Copy> copies;
  LargeArray<std::uint32_t> keys;  ///< of the copies, for the sweep
  LargeArray<std::uint32_t> ends;  ///< copy i is to be tested against those in (i, ends[i])
  std::size_t size = 0;
  std::uint64_t tests = 0;  ///< the lengths of all [i, ends[i])

  /// The copies have no values yet.
  void resize(std::size_t count) {
    size = count;
    copies.resize(count);
    const auto resize_padded = [&](auto& array) {
      array.resize(count + kPadding);
      std::fill_n(array.data() + count, kPadding, 0);
    };
    resize_padded(keys);
    resize_padded(ends);
  }
};

}  // namespace broadmark::columns
