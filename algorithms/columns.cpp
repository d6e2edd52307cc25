// Columns: finds all pairs from scratch each frame. Space is cut into columns over two axes, and
// boxes are swept along the third in each column. Nothing but buffers is retained between frames.
//
//   boxes --- 1 sample -----> Layout      cut axes, number of columns  columns/layout.h
//     |                         |
//     +----- 2 quantise ---> BoxBlock     128 boxes, as arrays         columns/kernels.h
//                               | bin
//                           ColumnBins    a list of chunks per column  columns/column_bins.h
//                               | 3 counting sort on the sweep axis    columns/column_traversal.h
//                          SortedColumn   one at a time, in cache      columns/cell_entries.h
//                            |     |
//         4 SIMD sweep of keys     5 crowded: split, 1 to 4 on its own boxes
//                            |
//                        HitBuffer        masks of candidate pairs     columns/hit_buffer.h
//                          |    |
//                     certain  ambiguous, as quantised bounds are equal: test the boxes
//                          |    |
//                        PairBuffer
//
// Few boxes are all tested against each other instead, where steps 1 to 3 would take longer. Only
// workers with enough work take part.
//
//   CellEntry, 16 bytes:  | sweep_min | ~sweep_max | key | body id, 29 bits; phantom, 3 |
//   its key, 4 bytes:     | cut_min_a | cut_min_b | 255 - cut_max_a | 255 - cut_max_b |
//
// A pair that shares several columns is reported in its home column only (cell_body.h). Workers
// traverse ranges of equal estimated work; the order of the pairs is the same for any team.
//
// O(n + w), w the pairs that share a column and overlap on the sweep axis, a few dozen per box.
// References: C. Ericson, "Real-Time Collision Detection" (2005), 7.1 (grids) and 7.5 (sort and
// sweep); S. Le Grand, GPU Gems 3 (2007), chapter 32 (home cells).

#include "columns.h"

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include "columns/column_traversal.h"
#include "columns/hit_buffer.h"
#include "prefetch.h"
#include "sample.h"
#include "simd/overlap_kernels.h"
#include "test_counts.h"
#include "variants.h"

namespace broadmark::columns {
namespace {

/// Up to this many boxes, the array of boxes stays in the caches beside the bins and columns.
constexpr std::size_t kMaxCachedBoxes = (std::size_t{1} << 17) - 1;

enum Counter { grid_columns, splits, entries, tests, box_tests };
constexpr std::array<std::string_view, 5> kCounterNames = {"columns", "split columns", "copies",
                                                           "tests", "pairs decided by their boxes"};
using SweepStats = std::array<std::uint64_t, kCounterNames.size()>;

/// A column's boxes, for columns in which many entries overlap: see isDense().
struct DenseColumn {
  BoxArrays boxes;
  LargeArray<CellBody> bodies;
};

class Columns final : public PairBroadPhase {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"copy_cost", "cost of a box in a column, in pair tests: higher values widen columns",
           &copy_cost_, 1, 1'000'000});
    visit({"split_threshold", "pair tests per box above which a column is split", &split_threshold_,
           1, 1'000'000'000});
    visit({"max_brute_force", "number of boxes up to which all pairs are tested, with SIMD",
           &max_brute_force_, 0, 1'000'000});
    visit({"min_share_us",
           "minimum work of a thread, in estimated microseconds: with less, fewer threads are used",
           &min_share_us_, 0, 1'000'000});
  }

  [[gnu::cold]] void initialize(const SceneInfo& scene, const Frame& first,
                                ExecutionContext& execution) override {
    PairBroadPhase::initialize(scene, first, execution);
    kernels_ = &kernels(execution.isa());
    dense_kernels_ = &overlapKernels(execution.isa());
    bins_.resize(static_cast<std::size_t>(team().size()));
    workers_.resize(static_cast<std::size_t>(team().size()));
    updateObjects(first);
  }

  void updateObjects(const Frame& frame) override;

  void drawStructure(DebugDraw& draw) const override;
  void visitCounters(const CounterVisitor& visit) const override;
  [[nodiscard]] std::string validate() const override;

 private:
  /// Aligned against false sharing.
  struct alignas(64) Worker {
    ColumnTraversal traversal;
    DenseColumn dense;
    SweepStats stats{};
  };

  [[nodiscard]] bool exceedsCaches() const { return boxes_.size() > kMaxCachedBoxes; }
  [[nodiscard]] ColumnTraversal::Input input() const {
    return {kernels_,
            {boxes_.data(), boxes_.size()},
            static_cast<double>(copy_cost_),
            static_cast<std::uint64_t>(split_threshold_)};
  }
  [[nodiscard]] ColumnGrid grid() const {
    return {layout_, std::span(bins_).first(static_cast<std::size_t>(used_workers_))};
  }
  /// The workers that pay for tests of pairs.
  [[nodiscard]] int workersFor(double tests) {
    constexpr double kTestNs = 0.1;  // measured, as are the costs in tests
    return workersThatPay(kTestNs * tests, team().size(), 1e3 * static_cast<double>(min_share_us_));
  }
  [[nodiscard]] bool isFewBoxes(std::size_t count) const;

  bool binBoxes(const Frame& frame);
  void findPairs() override;
  void testAllPairs();

  std::int64_t copy_cost_ = 150;
  std::int64_t split_threshold_ = 100;
  std::int64_t max_brute_force_ = static_cast<std::int64_t>(kMaxBruteForce);
  std::int64_t min_share_us_ = static_cast<std::int64_t>(kMinShareNs / 1e3);
  const Kernels* kernels_ = nullptr;
  const OverlapKernels* dense_kernels_ = nullptr;

  bool tests_all_ = false;  ///< all pairs of few_boxes_; boxes_ is empty
  BoxArrays few_boxes_;
  LargeArray<Aabb> boxes_;
  std::vector<Aabb> sample_;
  Layout layout_;
  int used_workers_ = 1;          ///< in this frame
  std::vector<ColumnBins> bins_;  ///< by worker
  std::vector<Worker> workers_;
};

// Steps 1 and 2: sampling, quantisation and binning.

/// Whether testing all pairs is faster. Measured: up to some 100 boxes as scalar code, 180 with
/// four lanes, 230 with eight.
bool Columns::isFewBoxes(std::size_t count) const {
  return count <=
         std::min(static_cast<std::size_t>(max_brute_force_), 72 + 26 * dense_kernels_->lanes);
}

void Columns::updateObjects(const Frame& frame) {
  tests_all_ = isFewBoxes(frame.boxes.size());
  if (tests_all_) {
    boxes_.resize(0);
    few_boxes_.assign(frame.boxes);
    return;
  }
  const double count = static_cast<double>(frame.boxes.size());
  constexpr double kMinTests = 190;            // a box takes as long, binning included
  team().wake(workersFor(kMinTests * count));  // meanwhile, this thread chooses the layout
  boxes_.resize(frame.boxes.size());
  takeSample(boxes_.size(), [&](std::size_t i) -> const Aabb& { return frame.boxes[i]; }, sample_);
  layout_ = Layout(sample_, boxes_.size(), static_cast<double>(copy_cost_));
  used_workers_ = workersFor(std::max(kMinTests, layout_.costPerBox()) * count);
  while (!binBoxes(frame)) layout_.coarsen();
}

/// Bins and copies the boxes. False if that needs too many entries, as the sample was misleading.
bool Columns::binBoxes(const Frame& frame) {
  constexpr std::size_t kBlock = BoxBlock::kBoxes;
  const Layout layout = layout_;
  const std::size_t limit = ColumnTraversal::kMaxEntriesPerBox * boxes_.size() + 4 * layout.size();
  const bool stream = exceedsCaches();  // so as not to evict the bins
  team().runOn(used_workers_, [&](int worker) {
    ColumnBins& bins = bins_[static_cast<std::size_t>(worker)];
    bins.clear(layout.size());
    const std::size_t blocks = (boxes_.size() + kBlock - 1) / kBlock;
    const auto [begin, end] = share(blocks, used_workers_, worker);
    BoxBlock block;
    std::array<CellBody, kBlock> bodies;
    std::size_t entries = 0;
    for (std::size_t k = begin; k < end && entries <= limit; ++k) {
      const std::size_t first = k * kBlock;
      const std::size_t count = std::min(kBlock, boxes_.size() - first);
      const Aabb* const boxes = frame.boxes.data() + first;
      std::iota(bodies.begin(), bodies.end(), static_cast<CellBody>(first));
      kernels_->quantize_boxes(boxes, bodies.data(), count, layout.quantizers(), block);
      // Overlaps with the scattered writes of binning, which miss the caches, too.
      const auto next = frame.boxes.subspan(first + count);
      prefetchL2(next.data(), next.data() + std::min(kBlock, next.size()));
      entries += binBlock(layout, block, count, bins);
      if (stream) {
        kernels_->stream_copy(boxes, count, boxes_.data() + first);
      } else {
        std::copy_n(boxes, count, boxes_.data() + first);
      }
    }
    if (stream) streamFence();
  });
  std::size_t entries = 0;
  for (const ColumnBins& bins : grid().bins) entries += bins.count();
  return entries <= limit || layout.size() == 1;
}

// Steps 3 to 5: ColumnTraversal sorts and splits, SweepVisitor sweeps.

/// Everything is borrowed.
struct SearchContext {
  const Kernels& kernels;
  const OverlapKernels& dense_kernels;
  const Aabb* boxes;
  std::size_t flush_rows;  ///< rows between two flushes of the hits
};

/// The row at a fraction of the column's tests: a multiple of `granularity`, or the size.
std::size_t rowAt(const SortedColumn& sorted, double fraction, std::size_t granularity) {
  if (fraction >= 1) return sorted.size;
  const double target = fraction * static_cast<double>(sorted.tests);
  std::uint64_t tests = 0;
  std::size_t row = 0;
  while (row < sorted.size && static_cast<double>(tests) < target) {
    const std::size_t end = std::min(row + granularity, sorted.size);
    for (; row < end; ++row) tests += sorted.ends[row] - row;
  }
  return row;
}

/// Whether sweeping the boxes is faster than sweeping the keys: a hit is a pair at once and costs
/// less, a miss costs more. Decided by a fixed sample of the tests, so that teams of any size
/// agree.
bool isDense(const SortedColumn& column) {
  constexpr std::size_t kTests = 256;
  constexpr std::size_t kMinHits = kTests / 8;  // measured: where both take equally long
  std::size_t hits = 0;
  for (std::size_t test = 0; test < kTests; ++test) {
    const std::size_t i = test * column.size / kTests;
    const std::size_t window = column.ends[i] - i;
    const std::size_t j = i + test * 97 % window;  // pseudo-random in the window
    hits += std::size_t{j > i && overlapQuantized(column.entries[i], column.entries[j])};
  }
  return hits >= kMinHits;
}

class SweepVisitor final : public ColumnVisitor {
 public:
  SweepVisitor(const SearchContext& context, const SortedColumn& sorted, DenseColumn& dense,
               PairBuffer& pairs)
      : context_(context),
        dense_(dense),
        pairs_(pairs),
        hits_(context.kernels, sorted, context.boxes, pairs) {}

  void visitColumn(ColumnTraversal& traversal, const WorkRange& range) override {
    const SortedColumn& sorted = traversal.sorted();
    const bool dense = traversal.isCrowded() && isDense(sorted);  // splitting has not helped
    const std::size_t granularity = dense ? Kernels::kSweepRows : context_.flush_rows;
    const Range rows = {rowAt(sorted, range.begin, granularity),
                        rowAt(sorted, range.end, granularity)};
    if (dense) {
      sweepBoxes(sorted, rows);
    } else {
      sweepKeys(traversal, rows);
    }
    if (rows.begin > 0) return;  // counted by the worker of the first row
    stats_[entries] += sorted.size;
    stats_[tests] += sorted.tests - sorted.size;
  }

  void visitSplit(const ColumnTraversal&, const ColumnGrid& inner,
                  const WorkRange& range) override {
    if (range.begin > 0) return;  // counted by the worker of the first row
    ++stats_[splits];
    stats_[grid_columns] += inner.layout.size();
  }

  [[nodiscard]] SweepStats stats() const {
    SweepStats stats = stats_;
    stats[box_tests] += hits_.boxTests();
    return stats;
  }

 private:
  void sweepKeys(ColumnTraversal& traversal, Range range) {
    constexpr std::size_t kRows = Kernels::kSweepRows;
    const SortedColumn& sorted = traversal.sorted();
    for (std::size_t row = range.begin; row < range.end; row += kRows) {
      const Range rows = {row, std::min(row + kRows, range.end)};
      traversal.prefetchNext();
      context_.kernels.sweep(sorted.keys.data(), sorted.ends.data(), rows, hits_);
      // At fixed rows, so that the order of the pairs does not depend on the team.
      if (rows.end % context_.flush_rows == 0) hits_.flush();
    }
    hits_.flush();
  }

  void sweepBoxes(const SortedColumn& sorted, Range rows) {
    dense_.boxes.resize(sorted.size);
    dense_.bodies.resize(sorted.size);
    for (std::size_t i = 0; i < sorted.size; ++i) {
      dense_.bodies[i] = sorted.entries[i].body;
      dense_.boxes.set(i, context_.boxes[bodyId(dense_.bodies[i])]);
    }
    context_.dense_kernels.sweep_cells(dense_.boxes, sorted.ends.data(), dense_.bodies.data(), rows,
                                       pairs_);
    for (std::size_t i = rows.begin; i < rows.end; ++i) {
      stats_[box_tests] += sorted.ends[i] - i - 1;
    }
  }

  SearchContext context_;
  DenseColumn& dense_;
  PairBuffer& pairs_;
  HitBuffer hits_;
  SweepStats stats_{};
};

void Columns::testAllPairs() {
  const Range all = {0, few_boxes_.size()};
  dense_kernels_->test_tile(few_boxes_, all, all, pairs());
}

void Columns::findPairs() {
  if (tests_all_) return testAllPairs();
  // Larger batches of ambiguous pairs hide the latency of boxes that are not cached.
  const std::size_t flush_rows = (exceedsCaches() ? 64 : 16) * Kernels::kSweepRows;
  team().runOn(used_workers_, [&](int worker) {
    Worker& mine = workers_[static_cast<std::size_t>(worker)];
    const SearchContext context = {*kernels_, *dense_kernels_, boxes_.data(), flush_rows};
    SweepVisitor sweep(context, mine.traversal.sorted(), mine.dense, pairs(worker));
    const double size = used_workers_;
    mine.traversal.traverse(input(), grid(), {worker / size, (worker + 1) / size}, sweep);
    mine.stats = sweep.stats();
  });
}

class DrawVisitor final : public ColumnVisitor {
 public:
  DrawVisitor(DebugDraw& draw, const Aabb& bounds) : draw_(draw), bounds_(bounds) {}

  void visitColumn(ColumnTraversal& traversal, const WorkRange&) override {
    const SortedColumn& sorted = traversal.sorted();
    draw_.cell(traversal.columnBox(bounds_), traversal.depth(),
               static_cast<std::uint32_t>(sorted.size));
    TestCounts tests(sorted.size);
    tests.addWindows({sorted.ends.data(), sorted.size});
    tests.report(draw_, [&](std::size_t i) { return bodyId(sorted.entries[i].body); });
  }

 private:
  DebugDraw& draw_;
  Aabb bounds_;
};

void Columns::drawStructure(DebugDraw& draw) const {
  const auto few = static_cast<std::uint32_t>(few_boxes_.size());
  for (std::uint32_t body = 0; tests_all_ && body < few; ++body) draw.tests(body, few - 1);
  if (boxes_.empty()) return;
  Aabb bounds = boxes_[0];
  for (const Aabb& box : boxes_) bounds = merged(bounds, box);
  DrawVisitor visitor(draw, bounds);
  ColumnTraversal().traverse(input(), grid(), {}, visitor);
}

void Columns::visitCounters(const CounterVisitor& visit) const {
  SweepStats sum{};
  if (tests_all_) {
    sum[tests] = sum[box_tests] = few_boxes_.size() * (few_boxes_.size() - 1) / 2;
  } else {
    sum[grid_columns] = layout_.size();
    for (int worker = 0; worker < used_workers_; ++worker) {
      const SweepStats& own = workers_[static_cast<std::size_t>(worker)].stats;
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += own[i];
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) visit(kCounterNames[i], sum[i]);
}

class InvariantVisitor final : public ColumnVisitor {
 public:
  InvariantVisitor(const Kernels& kernels, std::span<const Aabb> boxes)
      : kernels_(kernels), boxes_(boxes) {}

  /// Checks that every column of a grid holds exactly the bodies that overlap it.
  [[gnu::cold]] void checkBins(const ColumnGrid& grid, std::span<const CellBody> bodies) {
    std::vector<std::vector<CellBody>> expected(grid.layout.size());
    BoxBlock block;
    for (const CellBody body : bodies) {
      kernels_.quantize_boxes(&boxes_[bodyId(body)], &body, 1, grid.layout.quantizers(), block);
      expected[block.columns[0]].push_back(body);
      forEachPhantomEntry(grid.layout, block, [&](std::size_t column, const CellEntry& entry) {
        expected[column].push_back(entry.body);
      });
    }
    std::vector<CellBody> found;
    for (std::size_t column = 0; column < expected.size(); ++column) {
      found.clear();
      grid.forEachEntry(column, [&](const CellEntry& entry) { found.push_back(entry.body); });
      std::ranges::sort(found);
      std::ranges::sort(expected[column]);
      if (found != expected[column]) fault_ = "a column does not hold the bodies that overlap it";
    }
  }

  void visitColumn(ColumnTraversal& traversal, const WorkRange&) override {
    const SortedColumn& sorted = traversal.sorted();
    for (std::size_t i = 0; i < sorted.size; ++i) {
      if (sorted.ends[i] <= i || sorted.ends[i] > sorted.size) fault_ = "window out of range";
      for (std::size_t j = sorted.ends[i]; j < sorted.size; ++j) {
        if (broadmark::overlaps(boxOf(sorted.entries[i]), boxOf(sorted.entries[j]))) {
          fault_ = "window too short";
        }
      }
    }
  }

  void visitSplit(const ColumnTraversal& traversal, const ColumnGrid& inner,
                  const WorkRange&) override {
    const SortedColumn& sorted = traversal.sorted();
    std::vector<CellBody> bodies;
    for (std::size_t i = 0; i < sorted.size; ++i) bodies.push_back(sorted.entries[i].body);
    checkBins(inner, bodies);
  }

  [[nodiscard]] const std::string& fault() const { return fault_; }

 private:
  [[nodiscard]] const Aabb& boxOf(const CellEntry& entry) const {
    return boxes_[bodyId(entry.body)];
  }

  const Kernels& kernels_;
  std::span<const Aabb> boxes_;
  std::string fault_;
};

std::string Columns::validate() const {
  if (tests_all_) return {};
  std::vector<CellBody> bodies(boxes_.size());
  std::iota(bodies.begin(), bodies.end(), CellBody{0});
  InvariantVisitor visitor(*kernels_, {boxes_.data(), boxes_.size()});
  visitor.checkBins(grid(), bodies);
  ColumnTraversal().traverse(input(), grid(), {}, visitor);
  return visitor.fault();
}

}  // namespace

std::unique_ptr<BroadPhase> create() { return std::make_unique<Columns>(); }

std::vector<Algorithm> variants() {
  const Algorithm family = {
      .family = "Columns",
      .traits = {.changing_worlds = ChangingWorlds::compacted,
                 .side_by_side_below = 400,
                 .max_objects = kMaxCellBodies - 1,
                 .rare_parameters = {{{"max_brute_force", "0"}}}},
      .description = {.principle = "grid, sorting",
                      .optimisations = "sampled layout, quantised bounds, bucket sort",
                      .time = "O(n + w), w pairs that share a column and overlap along it",
                      .space = "O(n + k)",
                      .source = "Broadmark; Ericson 2005, 7.1 and 7.5"}};
  Algorithm parallel_family = family;
  parallel_family.traits.rare_parameters.front()["min_share_us"] = "0";
  return {variantOf<Columns>(family, "columns", "sweep and prune in columns laid out by a sample",
                             {.vectorised = true}),
          variantOf<Columns>(parallel_family, "columns-mt",
                             "sweep and prune in columns laid out by a sample, on several threads",
                             {.parallel = true, .vectorised = true})};
}

}  // namespace broadmark::columns
