// Binning: boxes are appended to the columns that they overlap, in one pass. Each column is a list
// of small chunks, so that no counting pass is needed.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "broadmark/large_array.h"
#include "columns/cell_entries.h"
#include "columns/kernels.h"
#include "columns/layout.h"
#include "prefetch.h"

namespace broadmark::columns {

/// The chunked lists of one worker, on cache lines of their own. Memory is retained by clear().
class alignas(64) ColumnBins {
 public:
  /// Empties all columns and sets their number.
  void clear(std::size_t columns) {
    bins_.assign(columns, {});
    ends_.assign(columns, nullptr);
    if (slabs_.empty()) slabs_.emplace_back(kMinSlabChunks);
    slab_ = used_in_slab_ = 0;
  }
  void append(std::size_t column, const CellEntry& entry) { append(ends_.data(), column, entry); }
  /// Appends entries[k] to columns[k].
  void append(const std::uint32_t* columns, const CellEntry* entries, std::size_t count) {
    CellEntry** const ends = ends_.data();
    for (std::size_t k = 0; k < count; ++k) append(ends, columns[k], entries[k]);
  }

  [[nodiscard]] std::size_t count(std::size_t column) const {
    const Bin& bin = bins_[column];
    return bin.last == nullptr ? 0 : bin.before_last + usedInLast(column) - firstSlot(column);
  }
  /// Entries in all columns.
  [[nodiscard]] std::size_t count() const {
    std::size_t entries = 0;
    for (std::size_t column = 0; column < bins_.size(); ++column) entries += count(column);
    return entries;
  }

  /// Calls visit(entry) for each entry of a column, in the order of appending.
  template <class Visit>
  void forEach(std::size_t column, Visit visit) const {
    const Chunk* chunk = bins_[column].first;
    std::size_t slot = firstSlot(column);
    for (std::size_t left = bins_[column].before_last; left > 0; left -= kChunkEntries) {
      // The hardware prefetcher does not follow the link to the next chunk.
      prefetchL2(chunk->next, chunk->next + 1);
      for (; slot < kChunkEntries; ++slot) visit(chunk->entries[slot]);
      slot = 0;
      chunk = chunk->next;
    }
    const std::size_t end = usedInLast(column);
    for (; slot < end; ++slot) visit(chunk->entries[slot]);
  }

 private:
  friend class ChunkPrefetcher;

  static constexpr std::size_t kCacheLineEntries = 64 / sizeof(CellEntry);
  static constexpr std::size_t kChunkBytes = 2048;
  static constexpr std::size_t kChunkEntries = kChunkBytes / sizeof(CellEntry) - 1;
  /// Aligned to its size, so that the address of the next slot tells whether the chunk is full.
  struct alignas(kChunkBytes) Chunk {
    Chunk* next;
    std::array<CellEntry, kChunkEntries> entries;
  };
  static_assert(sizeof(Chunk) == kChunkBytes);
  /// Slabs grow by doubling, up to a huge page.
  static constexpr std::size_t kMinSlabChunks = 16;
  static constexpr std::size_t kMaxSlabChunks = (std::size_t{1} << 21) / kChunkBytes;

  struct Bin {
    Chunk* first = nullptr;
    Chunk* last = nullptr;
    std::size_t before_last = 0;  ///< slots in all chunks but the last one
  };

  [[nodiscard]] std::size_t usedInLast(std::size_t column) const {
    const Chunk* const last = bins_[column].last;
    return last == nullptr ? 0 : static_cast<std::size_t>(ends_[column] - last->entries.data());
  }

  /// The slot at which a column's first chunk begins. Staggered, as write positions that are
  /// multiples of 2 KiB apart would evict each other (cache set conflicts).
  static std::size_t firstSlot(std::size_t column) { return column * 29 % kChunkEntries; }

  void append(CellEntry** ends, std::size_t column, const CellEntry& entry) {
    if (reinterpret_cast<std::uintptr_t>(ends[column]) % kChunkBytes == 0) [[unlikely]]
      addChunk(column);
    CellEntry* const end = ends[column]++;
    *end = entry;
    prefetchL2(end + 1 + kCacheLineEntries);  // the cache line of later entries
  }

  // Inlined, it would take the registers that the appending loops need.
  [[gnu::noinline]] void addChunk(std::size_t column) {
    Chunk* const chunk = allocateChunk();
    Bin& bin = bins_[column];
    std::size_t slot = 0;
    if (bin.last == nullptr) {
      bin.first = chunk;
      slot = firstSlot(column);
    } else {
      bin.last->next = chunk;
      bin.before_last += kChunkEntries;
    }
    bin.last = chunk;
    ends_[column] = chunk->entries.data() + slot;
  }

  Chunk* allocateChunk() {
    if (used_in_slab_ == slabs_[slab_].size) {
      used_in_slab_ = 0;
      if (++slab_ == slabs_.size())
        slabs_.emplace_back(std::min(2 * slabs_.back().size, kMaxSlabChunks));
    }
    return slabs_[slab_].chunks.get() + used_in_slab_++;
  }

  struct Slab {
    explicit Slab(std::size_t chunk_count)
        : size(chunk_count),
          chunks(static_cast<Chunk*>(allocateLarge(size * kChunkBytes, kChunkBytes))) {}

    std::size_t size;
    std::unique_ptr<Chunk[], FreeMemory> chunks;
  };

  std::vector<Bin> bins_;
  /// Per column: the slot of the next entry; at the end of a chunk, it needs a new one.
  std::vector<CellEntry*> ends_;
  std::vector<Slab> slabs_;
  std::size_t slab_ = 0;          ///< from which chunks are allocated
  std::size_t used_in_slab_ = 0;  ///< chunks taken from it
};

/// Prefetches the entries of a column, chunk by chunk, during the work on another column.
class ChunkPrefetcher {
 public:
  /// Prefetches nothing.
  ChunkPrefetcher() = default;
  /// Borrows the bins.
  ChunkPrefetcher(std::span<const ColumnBins> bins, std::size_t column)
      : bins_(bins), column_(column) {}

  /// Prefetches the next chunk, if any.
  void next() {
    if (bins_.empty()) return;
    const ColumnBins::Bin& bin = bins_.front().bins_[column_];
    // The link is read only now, when the chunk that holds it has arrived.
    chunk_ = chunk_ == nullptr ? bin.first : chunk_->next;
    if (chunk_ != nullptr) prefetchL2(chunk_, chunk_ + 1);
    if (chunk_ == bin.last) {
      chunk_ = nullptr;
      bins_ = bins_.subspan(1);
    }
  }

 private:
  std::span<const ColumnBins> bins_;
  std::size_t column_ = 0;
  const ColumnBins::Chunk* chunk_ = nullptr;  ///< prefetched last
};

/// Calls visit(k) for each box of a set.
template <class Visit>
inline void forEachBox(const BoxBlock::Set& set, Visit visit) {
  std::size_t word = 0;
  for (std::uint64_t bits : set) {
    for (; bits != 0; bits &= bits - 1) {
      visit(64 * word + static_cast<std::size_t>(std::countr_zero(bits)));
    }
    ++word;
  }
}

/// Calls visit(column, entry) for the entries of a block's boxes beyond their home columns. Few
/// boxes have any, and most of those have one.
template <class Visit>
inline void forEachPhantomEntry(const Layout& layout, const BoxBlock& block, Visit visit) {
  constexpr int kBits = Layout::kCoordBits;
  constexpr std::uint32_t kMax = Layout::kMaxCoord;
  // By axis in space, as a split column may be cut on other axes than the grid around it.
  const CellBody phantom_a = phantomBit(layout.quantizers().cut[0].axis);
  const CellBody phantom_b = phantomBit(layout.quantizers().cut[1].axis);
  forEachBox(block.cross_one, [&](std::size_t k) {
    CellEntry entry = block.entries[k];
    entry.key = block.next_keys[k];
    entry.body = block.next_bodies[k];
    visit(block.next_columns[k], entry);
  });
  forEachBox(block.cross_several, [&](std::size_t k) {
    CellEntry entry = block.entries[k];
    const CellBody body = entry.body;
    const std::uint32_t min_a = block.cut_min[0][k];
    const std::uint32_t min_b = block.cut_min[1][k];
    const std::uint32_t max_a = block.cut_max[0][k];
    const std::uint32_t max_b = block.cut_max[1][k];
    for (std::uint32_t b = min_b >> kBits; b <= max_b >> kBits; ++b) {
      const bool later_b = b != min_b >> kBits;
      const std::uint32_t cut_min_b = later_b ? 0 : min_b & kMax;
      const std::uint32_t cut_max_b = b != max_b >> kBits ? kMax : max_b & kMax;
      const std::uint32_t home_a = min_a >> kBits;
      for (std::uint32_t a = home_a + (later_b ? 0 : 1); a <= max_a >> kBits; ++a) {
        const bool later_a = a != home_a;
        const std::uint32_t cut_min_a = later_a ? 0 : min_a & kMax;
        const std::uint32_t cut_max_a = a != max_a >> kBits ? kMax : max_a & kMax;
        entry.key = keyOf(cut_min_a, cut_min_b, cut_max_a, cut_max_b);
        entry.body = body | (later_a ? phantom_a : 0) | (later_b ? phantom_b : 0);
        visit(layout.indexOf(a, b), entry);
      }
    }
  });
}

/// Appends the entries of a block of `count` boxes; returns their number.
inline std::size_t binBlock(const Layout& layout, const BoxBlock& block, std::size_t count,
                            ColumnBins& bins) {
  bins.append(block.columns, block.entries, count);
  forEachPhantomEntry(layout, block, [&](std::size_t column, const CellEntry& entry) {
    bins.append(column, entry);
    ++count;
  });
  return count;
}

}  // namespace broadmark::columns
