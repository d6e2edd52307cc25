// Sorting bodies by a float: parallel, stable, least significant digit first. O(n) per digit.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadmark/execution.h"

namespace broadmark {

/// A body with an integer that sorts like its float.
struct SortEntry {
  std::uint32_t key = 0;
  std::uint32_t body = 0;
};

/// Maps a < b to key(a) < key(b) for all floats but NaN; -0 comes before +0.
constexpr std::uint32_t sortKey(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  constexpr std::uint32_t kSign = 0x8000'0000;
  return (bits & kSign) != 0 ? ~bits : bits | kSign;
}

/// Retains its memory.
class RadixSorter {
 public:
  /// Room for `count` entries and a team of `workers`; allocates only to grow.
  void resize(std::size_t count, int workers);

  /// The entries, to be filled before sort().
  std::span<SortEntry> entries() { return entries_; }
  /// Sorts the entries by key, ascending and stable. `team` has the size given to resize().
  void sort(ThreadTeam& team);

 private:
  static constexpr int kDigitBits = 11;
  static constexpr std::size_t kBuckets = std::size_t{1} << kDigitBits;
  static std::size_t digit(std::uint32_t key, int shift) { return (key >> shift) & (kBuckets - 1); }
  /// Per bucket: a worker's number of entries, then the index of its next one.
  using Buckets = std::array<std::uint32_t, kBuckets>;

  void count(int worker, int shift);
  bool placeBuckets();
  void scatter(int worker, int shift);

  std::vector<SortEntry> entries_;
  std::vector<SortEntry> scattered_;
  std::vector<Buckets> buckets_;  ///< one set per worker
};

}  // namespace broadmark
