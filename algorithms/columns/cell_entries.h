// A box in a column: its quantised bounds, on the two cut axes as a key of four bytes, and its
// body.
//
// The key holds the lower bounds and the complemented upper bounds, 255 - max. Two boxes overlap on
// both cut axes if no byte of the one's key exceeds the other's limits, which are its upper bounds
// and complemented lower bounds: one saturating subtraction of bytes makes four comparisons for
// each lane of a vector. The upper bound on the sweep axis is complemented as well, so that the
// kernels compare all fields of an entry in the same way.
//
// Quantised boxes that overlap without equal bounds overlap exactly. Where bounds are equal, the
// result is ambiguous, and the boxes themselves are tested (hit_buffer.h).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "broadmark/large_array.h"
#include "cell_body.h"

namespace broadmark::columns {

/// A box in one of the columns that it overlaps.
struct alignas(16) CellEntry {
  std::uint32_t sweep_min;
  std::uint32_t sweep_max_complement;  ///< ~sweep_max
  std::uint32_t key;
  CellBody body;

  [[nodiscard]] constexpr std::uint32_t sweepMax() const { return ~sweep_max_complement; }
};

/// The key of bounds on the cut axes a and b, from 0 to 255.
constexpr std::uint32_t keyOf(std::uint32_t cut_min_a, std::uint32_t cut_min_b,
                              std::uint32_t cut_max_a, std::uint32_t cut_max_b) {
  return cut_min_a | cut_min_b << 8 | (255 - cut_max_a) << 16 | (255 - cut_max_b) << 24;
}
/// The largest bytes of other keys that overlap this one.
constexpr std::uint32_t limitsOf(std::uint32_t key) { return ~(key << 16 | key >> 16); }

/// Whether two entries of a column overlap, by their quantised bounds.
constexpr bool overlapQuantized(const CellEntry& a, const CellEntry& b) {
  const std::uint32_t limits = limitsOf(a.key);
  for (int shift = 0; shift < 32; shift += 8) {
    if ((b.key >> shift & 255) > (limits >> shift & 255)) return false;
  }
  return a.sweep_min <= b.sweepMax() && b.sweep_min <= a.sweepMax();
}

/// The entries of a column in the order of the buckets of their lower bounds, with padding for
/// whole vectors.
struct SortedColumn {
  static constexpr std::size_t kPadding = 64;

  LargeArray<CellEntry> entries;
  LargeArray<std::uint32_t> keys;  ///< of the entries, contiguous for the sweep
  LargeArray<std::uint32_t> ends;  ///< the window of entry i is (i, ends[i])
  std::size_t size = 0;
  std::uint64_t tests = 0;  ///< total length of all [i, ends[i])

  /// Leaves the entries uninitialised.
  void resize(std::size_t count) {
    size = count;
    entries.resize(count);
    const auto resize_padded = [&](auto& array) {
      array.resize(count + kPadding);
      std::fill_n(array.data() + count, kPadding, 0);
    };
    resize_padded(keys);
    resize_padded(ends);
  }
};

}  // namespace broadmark::columns
