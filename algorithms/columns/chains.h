// Copies of boxes, sorted into columns in one pass: each column is a chain of small chunks, so that
// nobody needs to know beforehand how many copies there will be.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "broadmark/large_array.h"
#include "columns/copies.h"
#include "prefetch.h"

namespace broadmark::columns {

/// The chains of one worker, on cache lines of their own. They keep their memory when they are
/// cleared.
class alignas(64) Chains {
 public:
  /// Empties all chains; there are `columns` of them from now on.
  void clear(std::size_t columns) {
    chains_.assign(columns, {});
    ends_.assign(columns, nullptr);
    if (slabs_.empty()) slabs_.emplace_back(kFewestInSlab);
    slab_ = used_in_slab_ = 0;
  }
  void append(std::size_t column, const Copy& copy) { append(ends_.data(), column, copy); }
  /// Appends `count` copies, each to its column.
  void append(const std::uint32_t* columns, const Copy* copies, std::size_t count) {
    Copy** const ends = ends_.data();
    for (std::size_t k = 0; k < count; ++k) append(ends, columns[k], copies[k]);
  }

  [[nodiscard]] std::size_t count(std::size_t column) const {
    const Chain& chain = chains_[column];
    return chain.last == nullptr ? 0 : chain.before + inLastChunk(column) - firstPlace(column);
  }
  /// Copies in all chains.
  [[nodiscard]] std::size_t count() const {
    std::size_t copies = 0;
    for (std::size_t column = 0; column < chains_.size(); ++column) copies += count(column);
    return copies;
  }

  /// Calls visit(copy) for each copy in a column, in the order in which they came.
  template <class Visit>
  void forEach(std::size_t column, Visit visit) const {
    const Chunk* chunk = chains_[column].first;
    std::size_t place = firstPlace(column);
    for (std::size_t left = chains_[column].before; left > 0; left -= kCopies) {
      // Only processors know how far ahead of a loop they look; no further than a chunk, here.
      prefetchFar(chunk->next, chunk->next + 1);
      for (; place < kCopies; ++place) visit(chunk->copies[place]);
      place = 0;
      chunk = chunk->next;
    }
    const std::size_t end = inLastChunk(column);
    for (; place < end; ++place) visit(chunk->copies[place]);
  }

 private:
  friend class ChainsAhead;

  static constexpr std::size_t kCopiesInLine = 64 / sizeof(Copy);  ///< in a cache line
  static constexpr std::size_t kChunkBytes = 2048;
  static constexpr std::size_t kCopies = kChunkBytes / sizeof(Copy) - 1;
  /// Aligned to its size: from the address of a place follows how full the chunk is.
  struct alignas(kChunkBytes) Chunk {
    Chunk* next;
    std::array<Copy, kCopies> copies;
  };
  static_assert(sizeof(Chunk) == kChunkBytes);
  /// Slabs double in size, from this many chunks up to that of a huge page.
  static constexpr std::size_t kFewestInSlab = 16;
  static constexpr std::size_t kMostInSlab = (std::size_t{1} << 21) / kChunkBytes;

  struct Chain {
    Chunk* first = nullptr;
    Chunk* last = nullptr;
    std::size_t before = 0;  ///< places in all chunks but the last one
  };

  [[nodiscard]] std::size_t inLastChunk(std::size_t column) const {
    const Chunk* const last = chains_[column].last;
    return last == nullptr ? 0 : static_cast<std::size_t>(ends_[column] - last->copies.data());
  }

  /// Where a chain begins in its first chunk. Were it the same for all, the places where the next
  /// copies go would lie a multiple of 2 KiB apart, where they push each other out of the caches.
  static std::size_t firstPlace(std::size_t column) { return column * 29 % kCopies; }

  void append(Copy** ends, std::size_t column, const Copy& copy) {
    if (reinterpret_cast<std::uintptr_t>(ends[column]) % kChunkBytes == 0) [[unlikely]]
      lengthen(column);
    Copy* const end = ends[column]++;
    *end = copy;
    prefetchFar(end + 1 + kCopiesInLine);  // by the time that it is written to, it is there
  }

  // Were it part of the loops that append, they would have no registers left.
  [[gnu::noinline]] void lengthen(std::size_t column) {
    Chunk* const chunk = newChunk();
    Chain& chain = chains_[column];
    std::size_t place = 0;
    if (chain.last == nullptr) {
      chain.first = chunk;
      place = firstPlace(column);
    } else {
      chain.last->next = chunk;
      chain.before += kCopies;
    }
    chain.last = chunk;
    ends_[column] = chunk->copies.data() + place;
  }

  Chunk* newChunk() {
    if (used_in_slab_ == slabs_[slab_].size) {
      used_in_slab_ = 0;
      if (++slab_ == slabs_.size())
        slabs_.emplace_back(std::min(2 * slabs_.back().size, kMostInSlab));
    }
    return slabs_[slab_].chunks.get() + used_in_slab_++;
  }

  struct Slab {
    explicit Slab(std::size_t chunks_in_it)
        : size(chunks_in_it),
          chunks(static_cast<Chunk*>(allocateLarge(size * kChunkBytes, kChunkBytes))) {}

    std::size_t size;
    std::unique_ptr<Chunk[], FreeMemory> chunks;
  };

  std::vector<Chain> chains_;
  /// Of each chain: where the next copy goes. At the end of a chunk: into a new one.
  std::vector<Copy*> ends_;
  std::vector<Slab> slabs_;
  std::size_t slab_ = 0;          ///< the one that chunks are taken from
  std::size_t used_in_slab_ = 0;  ///< chunks
};

/// Sends for the copies of a column, a chunk at a time, while something else is computed.
class ChainsAhead {
 public:
  /// Nothing to send for.
  ChainsAhead() = default;
  /// All is borrowed.
  ChainsAhead(std::span<const Chains> chains, std::size_t column)
      : chains_(chains), column_(column) {}

  /// Sends for the next chunk, if there is one left.
  void more() {
    if (chains_.empty()) return;
    const Chains::Chain& chain = chains_.front().chains_[column_];
    // That the chunk before knows the next one is looked at only now, as it had to come, too.
    chunk_ = chunk_ == nullptr ? chain.first : chunk_->next;
    if (chunk_ != nullptr) prefetchFar(chunk_, chunk_ + 1);
    if (chunk_ == chain.last) {
      chunk_ = nullptr;
      chains_ = chains_.subspan(1);
    }
  }

 private:
  std::span<const Chains> chains_;
  std::size_t column_ = 0;
  const Chains::Chunk* chunk_ = nullptr;  ///< the last one that was sent for
};

}  // namespace broadmark::columns
