// A set of pairs in one contiguous array, with O(1) insertion and removal.
//
// Example:
//
//   const std::vector<Pair> began = {{0, 1}, {1, 2}};
//   PairSet touching;
//   touching.insert(began);
//   touching.erase(PairRun(began).first(1));
//   for (const Pair pair : touching.run()) {
//     const bool found = touching.contains(pair);  // (1, 2)
//   }
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "broadmark/large_array.h"
#include "broadmark/pair.h"

namespace broadmark {

/// A hash table with linear probing (load factor up to 1/2) maps pairs to positions in the array:
/// 24 to 48 bytes a pair. Retains its memory when cleared. One moved from may only be destroyed or
/// assigned to.
class PairSet {
 public:
  /// All pairs, in no particular order; valid until the set changes.
  [[nodiscard]] PairRun run() const { return pairs_; }

  /// O(1) on average.
  [[nodiscard]] bool contains(Pair pair) const {
    return table_[findSlot(pair, hashOf(pair))].position != kEmpty;
  }

  /// O(size of the table): it does not shrink.
  void clear() {
    pairs_.clear();
    table_.assign(table_.size(), Slot{});
  }

  /// Amortised O(1) per pair. Throws std::logic_error if a pair is already in the set, after
  /// inserting those before it, and std::length_error for more than 2^31 pairs in all.
  void insert(PairRun pairs) {
    while (2 * (pairs_.size() + pairs.size()) > table_.size()) grow();
    forEachPrefetched(pairs, [this](Pair pair) { insert(pair); });
  }

  /// Moves the last pairs into the gaps. O(1) on average per pair. Throws std::logic_error if a
  /// pair is not in the set, after erasing those before it.
  void erase(PairRun pairs) {
    forEachPrefetched(pairs, [this](Pair pair) { erase(pair); });
  }

 private:
  // Prefetch distances.
  static constexpr std::size_t kPairsAhead = 8;
  static constexpr std::size_t kSlotsAhead = 2 * kPairsAhead;

  /// Calls visit(pair) for each pair. Prefetches in two steps: the slot in the table, then the pair
  /// that it points to.
  template <class Visit>
  void forEachPrefetched(PairRun pairs, Visit visit) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (i + kSlotsAhead < pairs.size()) __builtin_prefetch(homeOf(pairs[i + kSlotsAhead]));
      if (i + kPairsAhead < pairs.size()) {
        const std::uint32_t position = homeOf(pairs[i + kPairsAhead])->position;
        if (position != kEmpty) __builtin_prefetch(&pairs_[position]);
      }
      visit(pairs[i]);
    }
  }

  void insert(Pair pair) {
    const std::uint32_t hash = hashOf(pair);
    Slot& slot = table_[findSlot(pair, hash)];
    if (slot.position != kEmpty) throw std::logic_error("inserted pair is already in the set");
    slot = {static_cast<std::uint32_t>(pairs_.size()), hash};
    pairs_.push_back(pair);
  }

  void erase(Pair pair) {
    const std::size_t slot = findSlot(pair, hashOf(pair));
    const std::uint32_t gap = table_[slot].position;
    if (gap == kEmpty) throw std::logic_error("erased pair is not in the set");
    const Pair last = pairs_.back();
    table_[findSlot(last, hashOf(last))].position = gap;
    pairs_[gap] = last;
    eraseSlot(slot);
    pairs_.pop_back();
    if (pairs_.size() > kSlotsAhead) {
      __builtin_prefetch(homeOf(pairs_[pairs_.size() - kSlotsAhead]));
    }
  }

  struct Slot {
    std::uint32_t position = kEmpty;  ///< in pairs_
    std::uint32_t hash = 0;
  };
  static constexpr std::uint32_t kEmpty = 0xFFFF'FFFF;
  static constexpr int kHashBits = 32;
  static constexpr int kMinBits = 10;

  /// Multiplicative hashing: the upper bits of the product depend on all bits of the pair.
  static std::uint32_t hashOf(Pair pair) {
    const std::uint64_t key = std::uint64_t{pair.a} << 32 | pair.b;
    return static_cast<std::uint32_t>((key ^ key >> 29) * 0x9E37'79B9'7F4A'7C15 >> 32);
  }
  /// The first slot of the probe sequence.
  [[nodiscard]] std::size_t homeOf(std::uint32_t hash) const { return hash >> shift_; }
  [[nodiscard]] const Slot* homeOf(Pair pair) const { return &table_[homeOf(hashOf(pair))]; }
  [[nodiscard]] std::size_t following(std::size_t slot) const {
    return (slot + 1) & (table_.size() - 1);
  }

  /// The slot of the pair, or else the empty slot to insert it in.
  [[nodiscard]] std::size_t findSlot(Pair pair, std::uint32_t hash) const {
    std::size_t slot = homeOf(hash);
    while (table_[slot].position != kEmpty &&
           (table_[slot].hash != hash || pairs_[table_[slot].position] != pair)) {
      slot = following(slot);
    }
    return slot;
  }

  /// Deletion with backward shift, which needs no tombstones.
  void eraseSlot(std::size_t hole) {
    const std::size_t mask = table_.size() - 1;
    for (std::size_t next = following(hole); table_[next].position != kEmpty;
         next = following(next)) {
      const std::size_t home = homeOf(table_[next].hash);
      if (((next - home) & mask) < ((next - hole) & mask)) continue;
      table_[hole] = table_[next];
      hole = next;
    }
    table_[hole] = {};
  }

  void grow() {
    if (shift_ == 0) throw std::length_error("too many pairs for a PairSet");
    table_.assign(2 * table_.size(), Slot{});
    --shift_;
    for (std::uint32_t i = 0; i < pairs_.size(); ++i) {
      const std::uint32_t hash = hashOf(pairs_[i]);
      table_[findSlot(pairs_[i], hash)] = {i, hash};
    }
  }

  LargeVector<Pair> pairs_;
  LargeVector<Slot> table_ = LargeVector<Slot>(std::size_t{1} << kMinBits);
  int shift_ = kHashBits - kMinBits;
};

}  // namespace broadmark
