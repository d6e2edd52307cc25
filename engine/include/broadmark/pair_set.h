// A set of pairs that lies ready as one contiguous run: pairs come and go in O(1).
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "broadmark/pair.h"

namespace broadmark {

/// The pairs themselves lie in an array without gaps; a hash table with linear probing (of at
/// most half its places taken) holds their positions. Keeps its memory when cleared.
class PairSet {
 public:
  [[nodiscard]] PairRun run() const { return pairs_; }

  [[nodiscard]] bool contains(Pair pair) const {
    return !pairs_.empty() && table_[placeFor(pair)] != kEmpty;
  }

  void clear() {
    pairs_.clear();
    table_.assign(table_.size(), kEmpty);
  }

  /// Adds a pair. Throws std::logic_error if it is in it already.
  void insert(Pair pair) {
    if (2 * (pairs_.size() + 1) > table_.size()) grow();
    const std::size_t place = placeFor(pair);
    if (table_[place] != kEmpty) throw std::logic_error("a pair began that was there already");
    table_[place] = static_cast<std::uint32_t>(pairs_.size());
    pairs_.push_back(pair);
  }

  /// Removes a pair; the last one takes its place in the run. Throws std::logic_error if it is not
  /// in it.
  void erase(Pair pair) {
    const std::size_t place = pairs_.empty() ? 0 : placeFor(pair);
    if (pairs_.empty() || table_[place] == kEmpty) {
      throw std::logic_error("a pair ended that was not there");
    }
    const std::uint32_t gap = table_[place];
    table_[placeFor(pairs_.back())] = gap;
    pairs_[gap] = pairs_.back();
    vacate(place);
    pairs_.pop_back();
  }

 private:
  static constexpr std::uint32_t kEmpty = 0xFFFF'FFFF;
  static constexpr std::size_t kSmallest = 1024;

  /// Where the search for a pair begins: the upper bits of a product, which depend on all others.
  [[nodiscard]] std::size_t home(Pair pair) const {
    const std::uint64_t key = std::uint64_t{pair.a} << 32 | pair.b;
    return (key ^ key >> 29) * 0x9E37'79B9'7F4A'7C15 >> shift_;
  }
  [[nodiscard]] std::size_t following(std::size_t place) const {
    return (place + 1) & (table_.size() - 1);
  }

  /// Where the pair is, or else the free place where it belongs.
  [[nodiscard]] std::size_t placeFor(Pair pair) const {
    std::size_t place = home(pair);
    while (table_[place] != kEmpty && pairs_[table_[place]] != pair) place = following(place);
    return place;
  }

  /// Frees a place and closes ranks: what follows moves up unless that is before its home.
  void vacate(std::size_t hole) {
    for (std::size_t next = following(hole); table_[next] != kEmpty; next = following(next)) {
      const std::size_t mask = table_.size() - 1;
      const std::size_t wanted = home(pairs_[table_[next]]);
      if (((next - wanted) & mask) < ((next - hole) & mask)) continue;
      table_[hole] = table_[next];
      hole = next;
    }
    table_[hole] = kEmpty;
  }

  void grow() {
    const std::size_t size = std::max(kSmallest, 2 * table_.size());
    table_.assign(size, kEmpty);
    shift_ = 64 - std::countr_zero(size);
    for (std::uint32_t i = 0; i < pairs_.size(); ++i) table_[placeFor(pairs_[i])] = i;
  }

  std::vector<Pair> pairs_;
  std::vector<std::uint32_t> table_;  ///< positions in pairs_, a power of two of them
  int shift_ = 64;
};

}  // namespace broadmark
