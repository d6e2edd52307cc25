#include "columns/column_traversal.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "sample.h"

namespace broadmark::columns {
namespace {

/// Buckets per column: its number of entries rounded up to a power of two, up to this many.
constexpr std::size_t kMaxBuckets = std::size_t{1} << 20;
/// The fixed cost of an entry, mostly sorting, in pair tests.
constexpr double kWorkPerEntry = 40;

}  // namespace

void ColumnTraversal::traverse(const Input& input, const ColumnGrid& grid, const WorkRange& range,
                               ColumnVisitor& visitor) {
  input_ = input;
  visitor_ = &visitor;
  depth_ = 0;
  traverseRange(grid, range);
}

double ColumnTraversal::estimateWork(const Layout& layout, std::size_t entries) const {
  const auto count = static_cast<double>(entries);
  return count * (kWorkPerEntry + std::min(count * layout.overlapFraction(),
                                           static_cast<double>(input_.split_threshold)));
}

void ColumnTraversal::traverseRange(const ColumnGrid& grid, const WorkRange& range) {
  const std::size_t columns = grid.layout.size();
  double total = 0;
  for (std::size_t column = 0; column < columns; ++column) {
    total += estimateWork(grid.layout, grid.count(column));
  }
  const double begin = range.begin * total;
  const double end = range.end * total;
  double before = 0;
  for (std::size_t column = 0; column < columns && before < end; ++column) {
    const std::size_t count = grid.count(column);
    const double work = estimateWork(grid.layout, count);
    if (count > 0 && before + work > begin) {
      sortColumn(grid, column, count);
      prefetcher_ =
          column + 1 < columns ? ChunkPrefetcher(grid.bins, column + 1) : ChunkPrefetcher();
      path_[static_cast<std::size_t>(depth_)] = {&grid.layout, column};
      const WorkRange in_column = {std::max(0.0, (begin - before) / work),
                                   std::min(1.0, (end - before) / work)};
      if (!trySplit(in_column)) visitor_->visitColumn(*this, in_column);
    }
    before += work;
  }
}

/// Counting sort by the buckets of the lower bounds. The window of an entry ends with the bucket of
/// its upper bound, so no search is needed; with a bucket per entry, that is hardly longer than
/// exact windows. The entries are read from the bins for the last time.
void ColumnTraversal::sortColumn(const ColumnGrid& grid, std::size_t column, std::size_t count) {
  const auto bucket_bits = static_cast<int>(std::bit_width(std::min(count, kMaxBuckets) - 1));
  const auto bucket_of = [&](std::uint32_t coord) {
    return coord >> (Layout::kSweepBits - bucket_bits);
  };
  bucket_ends_.assign(std::size_t{1} << bucket_bits, 0);
  grid.forEachEntry(column,
                    [&](const CellEntry& entry) { ++bucket_ends_[bucket_of(entry.sweep_min)]; });
  std::uint32_t begin = 0;
  for (std::uint32_t& bucket : bucket_ends_) begin += std::exchange(bucket, begin);
  sorted_.resize(count);
  // Scattering advances each bucket from its begin to its end.
  grid.forEachEntry(column, [&](const CellEntry& entry) {
    sorted_.entries[bucket_ends_[bucket_of(entry.sweep_min)]++] = entry;
  });
  sorted_.tests = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const CellEntry& entry = sorted_.entries[i];
    const std::uint32_t end = bucket_ends_[bucket_of(entry.sweepMax())];
    sorted_.keys[i] = entry.key;
    sorted_.ends[i] = end;
    sorted_.tests += end - i;
  }
}

/// Splits the current column, and traverses its own columns, if it is crowded and that should at
/// least halve the cost.
bool ColumnTraversal::trySplit(const WorkRange& range) {
  const std::size_t count = sorted_.size;
  if (!isCrowded() || depth_ + 1 == kMaxDepth) return false;
  takeSample(
      count,
      [&](std::size_t i) -> const Aabb& { return input_.boxes[bodyId(sorted_.entries[i].body)]; },
      sample_);
  const Layout layout(sample_, count, input_.copy_cost);
  const double cost = layout.costPerBox() * static_cast<double>(count);
  if (layout.size() == 1 || cost >= static_cast<double>(sorted_.tests) / 2) return false;
  ColumnBins& bins = bins_of_splits_[static_cast<std::size_t>(depth_)];
  if (!binEntries(layout, bins)) return false;
  const ColumnGrid inner = {layout, {&bins, 1}};
  visitor_->visitSplit(*this, inner, range);
  ++depth_;
  traverseRange(inner, range);
  --depth_;
  return true;
}

/// Bins the current column. False if that needs too many entries, as the sample was misleading.
bool ColumnTraversal::binEntries(const Layout& layout, ColumnBins& bins) {
  constexpr std::size_t kBlock = BoxBlock::kBoxes;
  const std::size_t limit = kMaxEntriesPerBox * sorted_.size;
  std::size_t entries = 0;
  BoxBlock block;
  std::array<Aabb, kBlock> boxes;
  std::array<CellBody, kBlock> bodies;
  bins.clear(layout.size());
  for (std::size_t row = 0; row < sorted_.size && entries <= limit; row += kBlock) {
    const std::size_t count = std::min(kBlock, sorted_.size - row);
    for (std::size_t i = 0; i < count; ++i) {
      bodies[i] = sorted_.entries[row + i].body;
      boxes[i] = input_.boxes[bodyId(bodies[i])];
    }
    input_.kernels->quantize_boxes(boxes.data(), bodies.data(), count, layout.quantizers(), block);
    entries += binBlock(layout, block, count, bins);
  }
  return entries <= limit;
}

Aabb ColumnTraversal::columnBox(const Aabb& bounds) const {
  Aabb box = bounds;
  for (int depth = 0; depth <= depth_; ++depth) {
    const ColumnRef& ref = path_[static_cast<std::size_t>(depth)];
    box = ref.layout->columnBox(ref.column, box);
  }
  return box;
}

}  // namespace broadmark::columns
