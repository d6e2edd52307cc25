// Pairs of overlapping bodies, and the buffers for an algorithm's answer.
//
// Example:
//
//   PairBuffer found;
//   found.add(7, 3);                            // stored as (3, 7)
//   Pair* const room = found.room(16);          // uninitialised
//   room[0] = {1, 2};
//   found.advance(1);                           // of 16, one was written
//   const PairRun run = found.run();            // (3, 7), (1, 2)
//   const std::uint64_t count = pairCount({&run, 1});
#pragma once

#include <algorithm>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadmark/large_array.h"

namespace broadmark {

/// Two bodies with overlapping boxes, by index in the frame; a < b.
struct Pair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;

  friend auto operator<=>(const Pair&, const Pair&) = default;
};

/// The pair of two different bodies, given in any order. Branchless: a comparison would compile to
/// a branch, mispredicted half of the time.
constexpr Pair orderedPair(std::uint32_t i, std::uint32_t j) {
  const std::uint32_t smaller = j ^ ((i ^ j) & (0U - std::uint32_t{i < j}));
  return {smaller, i ^ j ^ smaller};
}

/// A contiguous run of pairs, borrowed from its owner.
using PairRun = std::span<const Pair>;
/// A whole answer: one run or several (per-worker runs need no merging). Both the runs and the
/// array of runs are borrowed.
using PairRuns = std::span<const PairRun>;

/// The changes to the pairs since the frame before, borrowed: new pairs (began) and removed pairs
/// (ended). Each pair occurs once, in only one of the two.
struct PairEvents {
  PairRuns began;
  PairRuns ended;
};

/// Number of pairs in all runs, duplicates included.
constexpr std::uint64_t pairCount(PairRuns runs) {
  std::uint64_t count = 0;
  for (const PairRun chunk : runs) count += chunk.size();
  return count;
}
/// Number of events of both kinds.
constexpr std::uint64_t eventCount(const PairEvents& events) {
  return pairCount(events.began) + pairCount(events.ended);
}

/// The number of pairs of each of `bodies` bodies, by body. Ignores pairs of bodies that do not
/// exist. O(bodies + pairs).
inline std::vector<std::uint32_t> overlapCounts(std::size_t bodies, PairRuns pairs) {
  std::vector<std::uint32_t> counts(bodies, 0);
  for (const PairRun chunk : pairs) {
    for (const Pair pair : chunk) {
      if (pair.a >= bodies || pair.b >= bodies) continue;
      ++counts[pair.a];
      ++counts[pair.b];
    }
  }
  return counts;
}

/// Replaces pairs by others, or drops them. Called by several workers at the same time.
class PairMap {
 public:
  virtual ~PairMap() = default;
  /// Writes the remaining pairs to the front, and returns their number.
  [[nodiscard]] virtual std::size_t map(std::span<Pair> pairs) const = 0;
};

/// A growing array of pairs that keeps its capacity when cleared. Unlike std::vector it provides
/// uninitialised space, so that SIMD kernels can write first and count afterwards.
///
/// With a map, pairs are mapped in blocks, soon after they have been added: while they are in the
/// nearest cache, and before they take memory.
///
/// Aligned to a cache line against false sharing: workers fill adjacent buffers.
class alignas(64) PairBuffer {
 public:
  static constexpr std::size_t kBlock = 1024;  ///< pairs mapped at a time

  /// Drops all pairs; retains the memory.
  void clear() {
    size_ = 0;
    mapped_ = 0;
    end_ = map_ == nullptr ? pairs_.size() : 0;
  }
  /// Maps all pairs added from now on; null: none. Borrowed. Drops the pairs in the buffer.
  void setMap(const PairMap* map) {
    map_ = map;
    clear();
  }
  /// Maps those pairs that are not mapped yet. With a map, size() and run() are final only then.
  void flush() {
    if (map_ == nullptr) return;
    size_ = mapped_ + map_->map({pairs_.data() + mapped_, size_ - mapped_});
    mapped_ = size_;
  }
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Valid until the buffer changes.
  [[nodiscard]] PairRun run() const { return {pairs_.data(), size_}; }

  /// Adds the pair of two different bodies, given in any order. Amortised O(1).
  void add(std::uint32_t i, std::uint32_t j) {
    *room(1) = orderedPair(i, j);
    ++size_;
  }

  /// Adds a hit of a query: (query, body).
  void addHit(std::uint32_t query, std::uint32_t body) {
    *room(1) = {query, body};
    ++size_;
  }

  /// Uninitialised space for `count` more pairs behind the present ones; valid until the next call.
  /// Written pairs count only after advance(). May map earlier pairs, or reallocate: throws
  /// std::bad_alloc.
  Pair* room(std::size_t count) {
    if (size_ + count > end_) makeRoom(count);
    return pairs_.data() + size_;
  }
  /// Adds the first `count` pairs of the space that room() returned.
  void advance(std::size_t count) { size_ += count; }

  /// Drops the pairs for which keep(pair) is false; preserves the order. Only without a map.
  template <class Keep>
  void retain(Keep keep) {
    std::size_t count = 0;
    // Branchless: the outcome may be unpredictable.
    for (std::size_t i = 0; i < size_; ++i) {
      const Pair pair = pairs_[i];
      pairs_[count] = pair;
      count += keep(pair) ? 1 : 0;
    }
    size_ = count;
  }

 private:
  [[gnu::noinline]] void makeRoom(std::size_t count) {
    flush();
    const std::size_t capacity = pairs_.size();
    if (size_ + count > capacity) {
      pairs_.resize(std::max({size_ + count, capacity + capacity / 2, kBlock}));
    }
    end_ =
        map_ == nullptr ? pairs_.size() : std::min(pairs_.size(), size_ + std::max(count, kBlock));
  }

  LargeArray<Pair> pairs_;  ///< its size is the capacity
  std::size_t size_ = 0;
  std::size_t end_ = 0;  ///< of the room until makeRoom() is called
  const PairMap* map_ = nullptr;
  std::size_t mapped_ = 0;  ///< the pairs before this one are mapped
};

}  // namespace broadmark
