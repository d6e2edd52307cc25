// A segmented interval list: the ends of many intervals on one axis, kept sorted in linked chunks.
//
// An endpoint that moves a little is put in order by insertion sort, from neighbour to neighbour.
// One that comes or goes shifts its own chunk only. Every chunk may keep the set of intervals that
// are open at its start: then a new interval is not compared with all that begin before it.
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

/// One end of the interval with the number `slot` (< 2^31). Ordered by value; where values are
/// equal starts come before ends, so that closed intervals that touch overlap; then by slot, so
/// that no two are equal.
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

  // -0 + 0 is +0: the two are one value.
  Endpoint(float value, std::uint32_t is_end, std::uint32_t slot)
      : bits_(std::uint64_t{sortKey(value + 0.0F)} << 32 | is_end << kSlotBits | slot) {}

  std::uint64_t bits_ = 0;
};

class SegmentedList {
 public:
  /// Endpoints of a chunk in all but very long lists. There a chunk holds more, for the sake of the
  /// open sets: a bounded number of chunks keeps their memory linear.
  static constexpr std::uint32_t kChunkSize = 64;

  /// With `keeps_open` every chunk keeps its open set, and forEachMeeting() may be called.
  explicit SegmentedList(bool keeps_open) : keeps_open_(keeps_open) {}

  /// Becomes the list of these endpoints, ascending, with room for intervals of the slots
  /// [0, capacity): a power of two, at least 64. Until the next build nothing is allocated.
  void build(std::span<const Endpoint> sorted, std::uint32_t capacity);

  /// Adds an interval; finding its place is linear in the number of chunks.
  void insert(Endpoint start, Endpoint end);
  /// Removes an interval.
  void remove(Endpoint start, Endpoint end);

  /// Moves an endpoint of the list past its neighbours until the order is right again, and calls
  /// passed(endpoint) for each of them, in order. An interval's start must not be moved past its
  /// own end.
  template <class Passed>
  void move(Endpoint from, Endpoint to, Passed passed) {
    if (from < to) {
      shift<+1>(from, to, passed);
    } else {
      shift<-1>(from, to, passed);
    }
  }

  /// Whether move() would end in the same chunk or the one beside it.
  [[nodiscard]] bool isNear(Endpoint from, Endpoint to) const;

  /// Calls visit(slot) once for each other interval that meets the one in `slot`, and for some that
  /// end just before it begins.
  template <class Visit>
  void forEachMeeting(std::uint32_t slot, Visit visit) const;

  /// Calls visit(first endpoint, endpoints of the chunk) from chunk to chunk.
  template <class Visit>
  void forEachChunk(Visit visit) const {
    for (ChunkId id = first_; id != kNone; id = chunks_[id].next) visit(contents(id));
  }

  /// The endpoints in order.
  [[nodiscard]] std::vector<Endpoint> endpoints() const;

  /// "" or what is wrong with order, links, sizes, places or open sets.
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
  /// The first in the chunk that is not less. Without branches, which no predictor would foresee.
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
  void putInto(ChunkId id, Endpoint endpoint) { chunkOf(endpoint) = id; }

  template <int kStep, class Passed>
  void shift(Endpoint from, Endpoint to, Passed& passed);

  bool keeps_open_;
  std::uint32_t capacity_ = 0;    ///< slots
  std::uint32_t chunk_size_ = 0;  ///< endpoints that a chunk has room for
  std::uint32_t open_words_ = 0;  ///< of one open set
  ChunkId first_ = kNone;
  std::vector<Chunk> chunks_;
  std::vector<ChunkId> unused_;
  std::unique_ptr<Endpoint[]> endpoints_;  ///< chunk_size_ for each chunk
  std::vector<ChunkId> chunk_of_;          ///< of each slot's start and end
  std::vector<Word> open_;                 ///< open_words_ for each chunk
};

template <class Visit>
void SegmentedList::forEachMeeting(std::uint32_t slot, Visit visit) const {
  ChunkId id = chunk_of_[2 * std::size_t{slot}];
  const Word* const words = open(id);
  for (std::uint32_t i = 0; i < open_words_; ++i) {
    for (Word word = words[i]; word != 0; word &= word - 1) {
      visit(i * kWordBits + static_cast<std::uint32_t>(std::countr_zero(word)));
    }
  }
  for (; id != kNone; id = chunks_[id].next) {
    for (const Endpoint endpoint : contents(id)) {
      const bool own = endpoint.slot() == slot;
      if (endpoint.isEnd()) {
        if (own) return;
      } else if (!own) {
        visit(endpoint.slot());
      }
    }
  }
}

/// Insertion sort upwards (+1) or downwards (-1). Within a chunk neighbours are shifted; at the
/// border of two chunks the endpoint changes places with its neighbour, so that neither grows.
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
    putInto(id, *entrance);
    if (keeps_open_) {
      // The start of the later chunk now lies on the other side of both.
      const ChunkId later = kUp ? beside : id;
      setOpen(later, entrance->slot(), entrance->isEnd() != kUp);
      setOpen(later, to.slot(), to.isEnd() == kUp);
    }
    id = beside;
    at = entrance;
  }
  *at = to;
  putInto(id, to);
}

}  // namespace broadmark::tracy
