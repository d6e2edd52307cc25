// A segmented interval list: the endpoints of intervals on an axis, sorted, in linked chunks.
//
// Insertion sort moves endpoints past their neighbours. Insertions and removals shift the endpoints
// of one chunk only. Chunks may store the set of intervals that are open at their start: then a new
// interval is not compared with all intervals that begin before it.
//
// Paper: D. J. Tracy, S. R. Buss, B. M. Woods, "Efficient Large-Scale Sweep and Prune Methods with
// AABB Insertion and Removal", IEEE VR 2009, section 4.
#pragma once

#include <bit>
#include <compare>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "radix_sort.h"

namespace broadmark::tracy {

/// An endpoint of the interval with index `slot` (< 2^31). Ordered by value; then starts come
/// before ends, so that closed intervals that touch overlap; then by slot, so that all endpoints
/// differ.
class Endpoint {
 public:
  Endpoint() = default;
  static Endpoint start(float value, std::uint32_t slot) { return {value, 0, slot}; }
  static Endpoint end(float value, std::uint32_t slot) { return {value, 1, slot}; }

  [[nodiscard]] bool isEnd() const { return (bits_ >> kSlotBits & 1) != 0; }
  [[nodiscard]] std::uint32_t slot() const { return static_cast<std::uint32_t>(bits_) & kSlots; }

  friend auto operator<=>(Endpoint, Endpoint) = default;

 private:
  static constexpr int kSlotBits = 31;
  static constexpr std::uint32_t kSlots = (1U << kSlotBits) - 1;

  // Adding +0 turns -0 into +0, which has to compare equal.
  Endpoint(float value, std::uint32_t is_end, std::uint32_t slot)
      : bits_(std::uint64_t{sortKey(value + 0.0F)} << 32 | is_end << kSlotBits | slot) {}

  std::uint64_t bits_ = 0;
};

class SegmentedList {
 public:
  /// The capacity of a chunk. Very long lists have larger chunks: a bounded number of chunks keeps
  /// the memory of the open sets linear.
  static constexpr std::uint32_t kChunkSize = 64;

  /// `tracks_open`: chunks store their open sets, as forEachOverlapping() requires.
  explicit SegmentedList(bool tracks_open) : tracks_open_(tracks_open) {}

  /// Replaces the contents, and reserves memory for the slots [0, capacity), a power of two of at
  /// least 64. Later insertions do not allocate.
  void build(std::span<const Endpoint> sorted, std::uint32_t capacity);

  /// Linear in the number of chunks.
  void insert(Endpoint start, Endpoint end);
  void remove(Endpoint start, Endpoint end);

  /// Changes the value of an endpoint, and calls passed(endpoint) for each endpoint that it passes,
  /// in order. A start must not pass the end of its own interval.
  template <class Passed>
  void move(Endpoint from, Endpoint to, Passed passed) {
    if (from < to) {
      shift<+1>(from, to, passed);
    } else {
      shift<-1>(from, to, passed);
    }
  }

  /// Whether move() would end in the same chunk or an adjacent one.
  [[nodiscard]] bool isNear(Endpoint from, Endpoint to) const;

  /// Calls visit(slot) once for each interval that overlaps the interval `slot`, and for some that
  /// end shortly before it begins.
  template <class Visit>
  void forEachOverlapping(std::uint32_t slot, Visit visit) const;

  /// Calls visit(endpoints of the chunk) in order.
  template <class Visit>
  void forEachChunk(Visit visit) const {
    for (ChunkId id = first_; id != kNone; id = chunks_[id].next) visit(contents(id));
  }

  [[nodiscard]] std::vector<Endpoint> endpoints() const;

  /// "" or the broken invariant.
  [[nodiscard]] std::string validate() const;

 private:
  using ChunkId = std::uint16_t;
  static constexpr ChunkId kNone = std::numeric_limits<ChunkId>::max();
  using Word = std::uint64_t;
  static constexpr std::uint32_t kWordBits = 64;

  struct Chunk {
    ChunkId previous = kNone;
    ChunkId next = kNone;
    std::uint32_t count = 0;
  };

  Endpoint* begin(ChunkId id) { return &endpoints_[std::size_t{id} * chunk_size_]; }
  Endpoint* end(ChunkId id) { return begin(id) + chunks_[id].count; }
  /// Branchless, since the comparisons are unpredictable.
  Endpoint* lowerBound(ChunkId id, Endpoint endpoint) {
    Endpoint* first = begin(id);
    for (std::size_t count = chunks_[id].count; count > 0;) {
      const std::size_t half = (count + 1) / 2;
      first += half * static_cast<std::size_t>(first[half - 1] < endpoint);
      count -= half;
    }
    return first;
  }
  [[nodiscard]] std::span<const Endpoint> contents(ChunkId id) const {
    return {&endpoints_[std::size_t{id} * chunk_size_], chunks_[id].count};
  }
  [[nodiscard]] Endpoint front(ChunkId id) const { return contents(id).front(); }

  ChunkId& chunkOf(Endpoint endpoint) {
    return chunk_of_[2 * std::size_t{endpoint.slot()} + (endpoint.isEnd() ? 1 : 0)];
  }
  [[nodiscard]] ChunkId chunkOf(Endpoint endpoint) const {
    return const_cast<SegmentedList*>(this)->chunkOf(endpoint);
  }

  Word* open(ChunkId id) { return &open_[std::size_t{id} * open_words_]; }
  [[nodiscard]] const Word* open(ChunkId id) const { return &open_[std::size_t{id} * open_words_]; }
  void setOpen(ChunkId id, std::uint32_t slot, bool is_open) {
    Word& word = open(id)[slot / kWordBits];
    const Word bit = Word{1} << slot % kWordBits;
    word = is_open ? word | bit : word & ~bit;
  }
  void setOpenBetween(Endpoint start, Endpoint end, bool is_open);
  void advanceOpen(ChunkId from, ChunkId to);

  void clear(std::uint32_t capacity);
  ChunkId addChunkAfter(ChunkId previous);
  void insert(Endpoint endpoint, ChunkId near);
  void remove(Endpoint endpoint);
  void split(ChunkId left);
  void mergeIfSmall(ChunkId left, ChunkId right);
  void setChunk(ChunkId id, Endpoint endpoint) { chunkOf(endpoint) = id; }

  template <int kStep, class Passed>
  void shift(Endpoint from, Endpoint to, Passed& passed);

  bool tracks_open_;
  std::uint32_t capacity_ = 0;    ///< slots
  std::uint32_t chunk_size_ = 0;  ///< capacity, in endpoints
  std::uint32_t open_words_ = 0;  ///< words per open set
  ChunkId first_ = kNone;
  std::vector<Chunk> chunks_;
  std::vector<ChunkId> unused_;
  std::unique_ptr<Endpoint[]> endpoints_;  ///< chunk_size_ for each chunk
  std::vector<ChunkId> chunk_of_;          ///< by slot: of its start and end
  std::vector<Word> open_;                 ///< open_words_ for each chunk
};

template <class Visit>
void SegmentedList::forEachOverlapping(std::uint32_t slot, Visit visit) const {
  ChunkId id = chunk_of_[2 * std::size_t{slot}];
  const Word* const words = open(id);
  for (std::uint32_t i = 0; i < open_words_; ++i) {
    for (Word word = words[i]; word != 0; word &= word - 1) {
      visit(i * kWordBits + static_cast<std::uint32_t>(std::countr_zero(word)));
    }
  }
  for (; id != kNone; id = chunks_[id].next) {
    for (const Endpoint endpoint : contents(id)) {
      const bool is_own = endpoint.slot() == slot;
      if (endpoint.isEnd()) {
        if (is_own) return;
      } else if (!is_own) {
        visit(endpoint.slot());
      }
    }
  }
}

/// Insertion sort upwards (+1) or downwards (-1). Within a chunk neighbours are shifted; across a
/// boundary the endpoint is swapped with its neighbour, so that chunk sizes do not change.
template <int kStep, class Passed>
void SegmentedList::shift(Endpoint from, Endpoint to, Passed& passed) {
  constexpr bool kUp = kStep > 0;
  const auto ahead = [&](Endpoint other) { return kUp ? other < to : other > to; };
  ChunkId id = chunkOf(from);
  Endpoint* at = lowerBound(id, from);
  for (;;) {
    const Endpoint* const last = kUp ? end(id) - 1 : begin(id);
    for (; at != last && ahead(at[kStep]); at += kStep) {
      passed(at[kStep]);
      *at = at[kStep];
    }
    if (at != last) break;
    const ChunkId beside = kUp ? chunks_[id].next : chunks_[id].previous;
    if (beside == kNone) break;
    Endpoint* const entrance = kUp ? begin(beside) : end(beside) - 1;
    if (!ahead(*entrance)) break;
    passed(*entrance);
    *at = *entrance;
    setChunk(id, *entrance);
    if (tracks_open_) {
      // The start of the later chunk is now on the other side of both.
      const ChunkId later = kUp ? beside : id;
      setOpen(later, entrance->slot(), entrance->isEnd() != kUp);
      setOpen(later, to.slot(), to.isEnd() == kUp);
    }
    id = beside;
    at = entrance;
  }
  *at = to;
  setChunk(id, to);
}

}  // namespace broadmark::tracy
