// A set of pairs that lies ready as one contiguous run: pairs come and go in O(1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "broadmark/large_array.h"
#include "broadmark/pair.h"

namespace broadmark {

/// The pairs themselves lie in an array without gaps; a hash table with linear probing (of at
/// most half its places taken) holds their positions. Keeps its memory when cleared.
class PairSet {
 public:
  [[nodiscard]] PairRun run() const { return pairs_; }

  [[nodiscard]] bool contains(Pair pair) const {
    return table_[placeFor(pair, hashOf(pair))].position != kEmpty;
  }

  void clear() {
    pairs_.clear();
    table_.assign(table_.size(), Slot{});
  }

  /// Adds pairs. Throws std::logic_error if one is in it already.
  void insert(PairRun pairs) {
    while (2 * (pairs_.size() + pairs.size()) > table_.size()) grow();
    inTurn(pairs, [this](Pair pair) { insert(pair); });
  }

  /// Removes pairs; the last ones take their places in the run. Throws std::logic_error if one is
  /// not in it.
  void erase(PairRun pairs) {
    inTurn(pairs, [this](Pair pair) { erase(pair); });
  }

 private:
  /// So many ahead pairs are sent for, and places in the table.
  static constexpr std::size_t kPairsAhead = 8;
  static constexpr std::size_t kPlacesAhead = 2 * kPairsAhead;

  /// Calls visit(pair) for each; what that reads is sent for before, as most of it is in no cache:
  /// first places in the table, then the pairs whose positions these hold.
  template <class Visit>
  void inTurn(PairRun pairs, Visit visit) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (i + kPlacesAhead < pairs.size()) __builtin_prefetch(homeOf(pairs[i + kPlacesAhead]));
      if (i + kPairsAhead < pairs.size()) {
        const std::uint32_t position = homeOf(pairs[i + kPairsAhead])->position;
        if (position != kEmpty) __builtin_prefetch(&pairs_[position]);
      }
      visit(pairs[i]);
    }
  }

  void insert(Pair pair) {
    const std::uint32_t hash = hashOf(pair);
    Slot& slot = table_[placeFor(pair, hash)];
    if (slot.position != kEmpty) throw std::logic_error("a pair began that was there already");
    slot = {static_cast<std::uint32_t>(pairs_.size()), hash};
    pairs_.push_back(pair);
  }

  void erase(Pair pair) {
    const std::size_t place = placeFor(pair, hashOf(pair));
    const std::uint32_t gap = table_[place].position;
    if (gap == kEmpty) throw std::logic_error("a pair ended that was not there");
    const Pair last = pairs_.back();
    table_[placeFor(last, hashOf(last))].position = gap;
    pairs_[gap] = last;
    vacate(place);
    pairs_.pop_back();
    if (pairs_.size() > kPlacesAhead) {
      __builtin_prefetch(homeOf(pairs_[pairs_.size() - kPlacesAhead]));
    }
  }

  /// Of the table.
  struct Slot {
    std::uint32_t position = kEmpty;  ///< of a pair in pairs_
    std::uint32_t hash = 0;           ///< of that pair
  };
  static constexpr std::uint32_t kEmpty = 0xFFFF'FFFF;
  static constexpr int kHashBits = 32;
  static constexpr int kSmallestBits = 10;

  /// The upper bits of a product, which depend on all others.
  static std::uint32_t hashOf(Pair pair) {
    const std::uint64_t key = std::uint64_t{pair.a} << 32 | pair.b;
    return static_cast<std::uint32_t>((key ^ key >> 29) * 0x9E37'79B9'7F4A'7C15 >> 32);
  }
  /// Where the search for a pair begins.
  [[nodiscard]] std::size_t homeOf(std::uint32_t hash) const { return hash >> shift_; }
  [[nodiscard]] const Slot* homeOf(Pair pair) const { return &table_[homeOf(hashOf(pair))]; }
  [[nodiscard]] std::size_t following(std::size_t place) const {
    return (place + 1) & (table_.size() - 1);
  }

  /// Where the pair is, or else the free place where it belongs.
  [[nodiscard]] std::size_t placeFor(Pair pair, std::uint32_t hash) const {
    std::size_t place = homeOf(hash);
    while (table_[place].position != kEmpty &&
           (table_[place].hash != hash || pairs_[table_[place].position] != pair)) {
      place = following(place);
    }
    return place;
  }

  /// Frees a place and closes ranks: what follows moves up unless that is before its home.
  void vacate(std::size_t hole) {
    const std::size_t mask = table_.size() - 1;
    for (std::size_t next = following(hole); table_[next].position != kEmpty;
         next = following(next)) {
      const std::size_t wanted = homeOf(table_[next].hash);
      if (((next - wanted) & mask) < ((next - hole) & mask)) continue;
      table_[hole] = table_[next];
      hole = next;
    }
    table_[hole] = {};
  }

  void grow() {
    if (shift_ == 0) throw std::length_error("more pairs than a set can hold");
    table_.assign(2 * table_.size(), Slot{});
    --shift_;
    for (std::uint32_t i = 0; i < pairs_.size(); ++i) {
      const std::uint32_t hash = hashOf(pairs_[i]);
      table_[placeFor(pairs_[i], hash)] = {i, hash};
    }
  }

  LargeVector<Pair> pairs_;
  LargeVector<Slot> table_ = LargeVector<Slot>(std::size_t{1} << kSmallestBits);
  int shift_ = kHashBits - kSmallestBits;
};

}  // namespace broadmark
