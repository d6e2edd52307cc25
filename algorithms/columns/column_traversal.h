// Traversal of the columns: each is sorted into memory that stays in the caches, and visited at
// once. Crowded columns are split: cut into a column grid of their own, which is traversed instead.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadmark/aabb.h"
#include "columns/cell_entries.h"
#include "columns/column_bins.h"
#include "columns/kernels.h"
#include "columns/layout.h"

namespace broadmark::columns {

/// A range of the work of a column grid or a column, in fractions from 0 to 1.
struct WorkRange {
  double begin = 0;
  double end = 1;
};

/// The columns of a world or of a split column. Each worker has binned a contiguous range
/// of the bodies.
struct ColumnGrid {
  Layout layout;
  std::span<const ColumnBins> bins;

  /// Entries in a column.
  [[nodiscard]] std::size_t count(std::size_t column) const {
    std::size_t entries = 0;
    for (const ColumnBins& worker_bins : bins) entries += worker_bins.count(column);
    return entries;
  }
  /// Calls visit(entry) for each entry of a column.
  template <class Visit>
  void forEachEntry(std::size_t column, Visit visit) const {
    for (const ColumnBins& worker_bins : bins) worker_bins.forEach(column, visit);
  }
};

class ColumnTraversal;

/// Visitor for ColumnTraversal. In both functions, traversal.sorted() is the whole column.
class ColumnVisitor {
 public:
  virtual ~ColumnVisitor() = default;
  virtual void visitColumn(ColumnTraversal& traversal, const WorkRange& range) = 0;
  /// The column is split; the columns of `inner` are visited next.
  virtual void visitSplit(const ColumnTraversal& /*traversal*/, const ColumnGrid& /*inner*/,
                          const WorkRange& /*range*/) {}
};

/// Retains its memory between traversals; each worker has its own.
class ColumnTraversal {
 public:
  /// Nested column grids, the world's included.
  static constexpr int kMaxDepth = 8;
  /// A column grid has up to this many entries per box on average.
  static constexpr std::size_t kMaxEntriesPerBox = 4;

  /// Everything is borrowed.
  struct Input {
    const Kernels* kernels = nullptr;
    std::span<const Aabb> boxes;
    double copy_cost = 0;               ///< in pair tests
    std::uint64_t split_threshold = 0;  ///< in tests per entry
  };

  /// Visits the columns of a range of the work. Ranges that partition [0, 1] cover all work; a
  /// column that lies in two ranges is sorted in both traversals.
  void traverse(const Input& input, const ColumnGrid& grid, const WorkRange& range,
                ColumnVisitor& visitor);

  /// The current column.
  [[nodiscard]] const SortedColumn& sorted() const { return sorted_; }
  /// Whether the tests per entry of the current column exceed the split threshold.
  [[nodiscard]] bool isCrowded() const {
    return sorted_.tests > input_.split_threshold * sorted_.size;
  }
  /// Prefetches a chunk of the next column; to be interleaved with work on the current one.
  void prefetchNext() { prefetcher_.next(); }
  /// The number of split columns that contain the current one.
  [[nodiscard]] int depth() const { return depth_; }
  /// The box of the current column, within the world's bounds.
  [[nodiscard]] Aabb columnBox(const Aabb& bounds) const;

 private:
  void traverseRange(const ColumnGrid& grid, const WorkRange& range);
  void sortColumn(const ColumnGrid& grid, std::size_t column, std::size_t count);
  bool trySplit(const WorkRange& range);
  bool binEntries(const Layout& layout, ColumnBins& bins);
  /// Estimated work of a column with `entries` entries, in pair tests.
  [[nodiscard]] double estimateWork(const Layout& layout, std::size_t entries) const;

  struct ColumnRef {
    const Layout* layout;
    std::size_t column;
  };

  Input input_;
  ColumnVisitor* visitor_ = nullptr;
  SortedColumn sorted_;
  ChunkPrefetcher prefetcher_;              ///< of the next column
  std::vector<std::uint32_t> bucket_ends_;  ///< of the current column
  std::vector<Aabb> sample_;
  int depth_ = 0;
  std::array<ColumnRef, kMaxDepth> path_{};           ///< by depth, down to the current column
  std::array<ColumnBins, kMaxDepth> bins_of_splits_;  ///< by depth
};

}  // namespace broadmark::columns
