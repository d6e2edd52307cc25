// Columns: a broad phase from scratch, made to be fast. Space is cut into columns over two axes; in
// each, boxes are swept along the third. No state is kept but buffers.
//
//  1. A sample of the boxes tells which axes to cut, and how often (columns/layout.h).
//  2. One pass over the boxes copies each into the columns that it touches, with its bounds on the
//     two axes in 32 bits (columns/copies.h, columns/chains.h).
//  3. One column after the other is put in order along the sweep axis, in one counting sort by at
//     least as many buckets as there are copies: a window ends with the bucket in which its box
//     ends (columns/walk.h).
//  4. At once, while the column is in the caches, its windows are swept with vectors of bytes.
//     Where bounds share a step, the boxes decide.
//  5. A column that turns out to be crowded is cut into columns of its own instead, as if it were a
//     world: steps 1 to 4 again. Where that does not help and many of its boxes overlap, these are
//     swept themselves.
//
// A pair that shares several columns is reported in one of them: see MarkedBody, whose argument
// holds for any columns that tile the plane, split ones, too. A mark says that the body begins
// before the column does.
//
// Workers go through parts of the columns that should cost about the same. Where such a part begins
// or ends within a column, both put it in order, and each sweeps some of its rows.
//
// O(n + w), w the pairs that share a column and overlap on the sweep axis, a few dozen per box. The
// order of the pairs is the same for any team.
//
// Known before: grids and sweeps within their cells (C. Ericson, "Real-Time Collision Detection",
// 2005, 7.1 and 7.5), small integers that bound boxes (as in quantised bounding volume
// hierarchies).

#include "columns.h"

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include "columns/hits.h"
#include "columns/walk.h"
#include "prefetch.h"
#include "sample.h"
#include "simd/overlap_kernels.h"
#include "test_counts.h"
#include "variants.h"

namespace broadmark::columns {
namespace {

constexpr std::size_t kBlock = BoxBlock::kBoxes;
/// The boxes themselves are looked at rarely: so many of them should not take up the caches.
constexpr std::size_t kBoxesPastCaches = std::size_t{1} << 17;
/// Rows whose hits, and boxes, are looked at together: more where boxes are past the caches.
constexpr std::size_t kRowsPerLook = 16 * Kernels::kSweptRows;
constexpr std::size_t kRowsPerLookPastCaches = 4 * kRowsPerLook;

/// What there was to do, as counters call it.
enum Count { cut_columns, splits, copies, tests, compared_boxes };
constexpr std::array<std::string_view, 5> kCountNames = {"columns", "split columns", "copies",
                                                         "tests", "pairs decided by their boxes"};
using Counts = std::array<std::uint64_t, kCountNames.size()>;

/// The row of a column up to which a part of its tests goes; a multiple of `look`, or the last.
std::size_t rowAt(const Sorted& sorted, double part, std::size_t look) {
  if (part >= 1) return sorted.size;
  const double wanted = part * static_cast<double>(sorted.tests);
  std::uint64_t tests = 0;
  std::size_t row = 0;
  while (row < sorted.size && static_cast<double>(tests) < wanted) {
    const std::size_t end = std::min(row + look, sorted.size);
    for (; row < end; ++row) tests += sorted.ends[row] - row;
  }
  return row;
}

/// What finds pairs needs to know. All is borrowed.
struct Search {
  const Kernels& kernels;
  const OverlapKernels& dense_kernels;
  const Aabb* boxes;
  std::size_t rows_per_look;
};

/// For columns in which many copies overlap: the boxes themselves are tested, so that a hit is a
/// pair at once. So a hit costs less than in the sweep of keys, a miss more.
struct DenseColumn {
  BoxArrays boxes;  ///< of the copies
  LargeArray<MarkedBody> bodies;
};

/// Whether that is the faster sweep for a column, by a sample of its tests: it follows from the
/// column alone.
bool isDense(const Sorted& column) {
  constexpr std::size_t kTests = 256;
  // From this part of hits on, by the times of both sweeps.
  constexpr std::size_t kHits = kTests / 8;
  std::size_t hits = 0;
  for (std::size_t test = 0; test < kTests; ++test) {
    const std::size_t i = test * column.size / kTests;
    const std::size_t behind = column.ends[i] - i;
    const std::size_t j = i + test * 97 % behind;  // somewhere in its window
    hits += std::size_t{j > i && overlapInSteps(column.copies[i], column.copies[j])};
  }
  return hits >= kHits;
}

/// Finds the pairs in columns.
class Sweep final : public ColumnVisitor {
 public:
  Sweep(const Search& search, const Sorted& sorted, DenseColumn& dense, PairBuffer& pairs)
      : search_(search),
        dense_(dense),
        pairs_(pairs),
        sink_(search.kernels, sorted, search.boxes, pairs) {}

  void column(Walk& walk, const Part& part) override {
    const Sorted& sorted = walk.sorted();
    // It is crowded, and cutting it would not help.
    const bool dense = walk.crowded() && isDense(sorted);
    const std::size_t together = dense ? Kernels::kSweptRows : search_.rows_per_look;
    const Range rows = {rowAt(sorted, part.from, together), rowAt(sorted, part.to, together)};
    if (dense) {
      sweepBoxes(sorted, rows);
    } else {
      sweepKeys(walk, rows);
    }
    if (rows.begin > 0) return;  // another counts it
    done_[copies] += sorted.size;
    done_[tests] += sorted.tests - sorted.size;
  }

  void split(const Walk&, const CutWorld& inside, const Part& part) override {
    if (part.from > 0) return;  // another counts it
    ++done_[splits];
    done_[cut_columns] += inside.layout.size();
  }

  [[nodiscard]] Counts done() const {
    Counts done = done_;
    done[compared_boxes] += sink_.comparedBoxes();
    return done;
  }

 private:
  void sweepKeys(Walk& walk, Range all) {
    constexpr std::size_t kRows = Kernels::kSweptRows;
    const Sorted& sorted = walk.sorted();
    for (std::size_t row = all.begin; row < all.end; row += kRows) {
      const Range rows = {row, std::min(row + kRows, all.end)};
      walk.sendForMore();
      search_.kernels.sweep(sorted.keys.data(), sorted.ends.data(), rows, sink_);
      // At certain rows, so that the order of the pairs follows from the rows alone.
      if (rows.end % search_.rows_per_look == 0) sink_.flush();
    }
    sink_.flush();
  }

  void sweepBoxes(const Sorted& sorted, Range rows) {
    dense_.boxes.resize(sorted.size);
    dense_.bodies.resize(sorted.size);
    for (std::size_t i = 0; i < sorted.size; ++i) {
      dense_.bodies[i] = sorted.copies[i].body;
      dense_.boxes.set(i, search_.boxes[bodyNumber(dense_.bodies[i])]);
    }
    search_.dense_kernels.sweep_cells(dense_.boxes, sorted.ends.data(), dense_.bodies.data(), rows,
                                      pairs_);
    for (std::size_t i = rows.begin; i < rows.end; ++i) {
      done_[compared_boxes] += sorted.ends[i] - i - 1;
    }
  }

  Search search_;
  DenseColumn& dense_;
  PairBuffer& pairs_;
  HitSink sink_;
  Counts done_{};
};

/// Draws columns, and tells the tests in them.
class Draw final : public ColumnVisitor {
 public:
  Draw(DebugDraw& draw, const Aabb& bounds) : draw_(draw), bounds_(bounds) {}

  void column(Walk& walk, const Part&) override {
    const Sorted& sorted = walk.sorted();
    draw_.cell(walk.box(bounds_), walk.level(), static_cast<std::uint32_t>(sorted.size));
    TestCounts tests(sorted.size);
    tests.addWindows({sorted.ends.data(), sorted.size});
    tests.tell(draw_, [&](std::size_t i) { return bodyNumber(sorted.copies[i].body); });
  }

 private:
  DebugDraw& draw_;
  Aabb bounds_;
};

/// Checks what is in columns.
class Check final : public ColumnVisitor {
 public:
  Check(const Kernels& kernels, std::span<const Aabb> boxes) : kernels_(kernels), boxes_(boxes) {}

  /// Whether every copy that a body should have in a world's columns is there, and nothing else.
  void contents(const CutWorld& world, std::span<const MarkedBody> bodies) {
    std::vector<std::vector<MarkedBody>> expected(world.layout.size());
    BoxBlock block;
    for (const MarkedBody body : bodies) {
      kernels_.find_steps(&boxes_[bodyNumber(body)], &body, 1, world.layout.scales(), block);
      expected[block.columns[0]].push_back(body);
      forEachOtherCopy(world.layout, block, [&](std::size_t column, const Copy& copy) {
        expected[column].push_back(copy.body);
      });
    }
    std::vector<MarkedBody> found;
    for (std::size_t column = 0; column < expected.size(); ++column) {
      found.clear();
      world.forEachCopy(column, [&](const Copy& copy) { found.push_back(copy.body); });
      std::ranges::sort(found);
      std::ranges::sort(expected[column]);
      if (found != expected[column]) fault_ = "a column does not hold what touches it";
    }
  }

  void column(Walk& walk, const Part&) override {
    const Sorted& sorted = walk.sorted();
    for (std::size_t i = 0; i < sorted.size; ++i) {
      if (sorted.ends[i] <= i || sorted.ends[i] > sorted.size) fault_ = "window out of range";
      for (std::size_t j = sorted.ends[i]; j < sorted.size; ++j) {
        if (broadmark::overlaps(boxOf(sorted.copies[i]), boxOf(sorted.copies[j]))) {
          fault_ = "window too short";
        }
      }
    }
  }

  void split(const Walk& walk, const CutWorld& inside, const Part&) override {
    const Sorted& sorted = walk.sorted();
    std::vector<MarkedBody> bodies;
    for (std::size_t i = 0; i < sorted.size; ++i) bodies.push_back(sorted.copies[i].body);
    contents(inside, bodies);
  }

  [[nodiscard]] const std::string& fault() const { return fault_; }

 private:
  [[nodiscard]] const Aabb& boxOf(const Copy& copy) const { return boxes_[bodyNumber(copy.body)]; }

  const Kernels& kernels_;
  std::span<const Aabb> boxes_;
  std::string fault_;
};

class Columns final : public PairBroadPhase {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"copy_cost", "cost of a copy of a box, in tests of a pair: more make wider columns",
           &copy_cost_, 1, 1'000'000});
    visit({"split_threshold", "tests per copy in a column from which on it is split",
           &split_threshold_, 1, 1'000'000'000});
  }

  void initialize(const SceneInfo& scene, const Frame& first, Execution& execution) override {
    PairBroadPhase::initialize(scene, first, execution);
    kernels_ = &kernels(execution.isa());
    dense_kernels_ = &overlapKernels(execution.isa());
    chains_.resize(static_cast<std::size_t>(team().size()));
    workers_.resize(static_cast<std::size_t>(team().size()));
    updateObjects(first);
  }

  void updateObjects(const Frame& frame) override;

  void drawStructure(DebugDraw& draw) const override;
  void visitCounters(const CounterVisitor& visit) const override;
  [[nodiscard]] std::string validate() const override;

 private:
  /// One worker's own data, on cache lines of their own.
  struct alignas(64) Worker {
    Walk walk;
    DenseColumn dense;
    Counts done{};
  };

  [[nodiscard]] bool boxesPastCaches() const { return boxes_.size() >= kBoxesPastCaches; }
  [[nodiscard]] Walk::Boxes allBoxes() const {
    return {kernels_,
            {boxes_.data(), boxes_.size()},
            static_cast<double>(copy_cost_),
            static_cast<std::uint64_t>(split_threshold_)};
  }
  [[nodiscard]] CutWorld world() const { return {layout_, chains_}; }

  void findPairs() override;
  bool copyBoxes(const Frame& frame);

  std::int64_t copy_cost_ = 150;
  std::int64_t split_threshold_ = 100;
  const Kernels* kernels_ = nullptr;
  const OverlapKernels* dense_kernels_ = nullptr;

  LargeArray<Aabb> boxes_;
  std::vector<Aabb> sample_;
  Layout layout_;
  std::vector<Chains> chains_;  ///< one of each worker
  std::vector<Worker> workers_;
};

void Columns::updateObjects(const Frame& frame) {
  team().wake();  // while this thread chooses a layout
  boxes_.resize(frame.boxes.size());
  takeSample(
      boxes_.size(), [&](std::size_t i) -> const Aabb& { return frame.boxes[i]; }, sample_);
  layout_ = Layout(sample_, boxes_.size(), static_cast<double>(copy_cost_));
  while (!copyBoxes(frame)) layout_.widen();
}

/// Copies the boxes into the columns. False if there would be far too many copies: then the sample
/// has misled.
bool Columns::copyBoxes(const Frame& frame) {
  const Layout layout = layout_;
  const std::size_t limit = Walk::kMostCopies * boxes_.size() + 4 * layout.size();
  const bool past_caches = boxesPastCaches();
  team().run([&](int worker) {
    Chains& chains = chains_[static_cast<std::size_t>(worker)];
    chains.clear(layout.size());
    const std::size_t blocks = (boxes_.size() + kBlock - 1) / kBlock;
    const auto [begin, end] = share(blocks, team().size(), worker);
    BoxBlock block;
    std::array<MarkedBody, kBlock> bodies;
    std::size_t copies = 0;
    for (std::size_t k = begin; k < end && copies <= limit; ++k) {
      const std::size_t first = k * kBlock;
      const std::size_t count = std::min(kBlock, boxes_.size() - first);
      const Aabb* const boxes = frame.boxes.data() + first;
      std::iota(bodies.begin(), bodies.end(), static_cast<MarkedBody>(first));
      kernels_->find_steps(boxes, bodies.data(), count, layout.scales(), block);
      // While the copies wait for memory, the next boxes come.
      const auto next = frame.boxes.subspan(first + count);
      prefetchFar(next.data(), next.data() + std::min(kBlock, next.size()));
      copies += appendCopies(layout, block, count, chains);
      if (past_caches) {
        kernels_->copy_past_caches(boxes, count, boxes_.data() + first);
      } else {
        std::copy_n(boxes, count, boxes_.data() + first);
      }
    }
    if (past_caches) showWritesPastCaches();
  });
  std::size_t copies = 0;
  for (const Chains& chains : chains_) copies += chains.count();
  return copies <= limit || layout.size() == 1;
}

void Columns::findPairs() {
  team().run([&](int worker) {
    Worker& mine = workers_[static_cast<std::size_t>(worker)];
    const Search search = {*kernels_, *dense_kernels_, boxes_.data(),
                           boxesPastCaches() ? kRowsPerLookPastCaches : kRowsPerLook};
    Sweep sweep(search, mine.walk.sorted(), mine.dense, pairs(worker));
    const double size = team().size();
    mine.walk.go(allBoxes(), world(), {worker / size, (worker + 1) / size}, sweep);
    mine.done = sweep.done();
  });
}

void Columns::drawStructure(DebugDraw& draw) const {
  if (boxes_.empty()) return;
  Aabb bounds = boxes_[0];
  for (const Aabb& box : boxes_) bounds = merged(bounds, box);
  Draw visitor(draw, bounds);
  Walk().go(allBoxes(), world(), {}, visitor);
}

void Columns::visitCounters(const CounterVisitor& visit) const {
  for (std::size_t i = 0; i < kCountNames.size(); ++i) {
    std::uint64_t sum = i == cut_columns ? layout_.size() : 0;
    for (const Worker& worker : workers_) sum += worker.done[i];
    visit(kCountNames[i], sum);
  }
}

std::string Columns::validate() const {
  std::vector<MarkedBody> bodies(boxes_.size());
  std::iota(bodies.begin(), bodies.end(), MarkedBody{0});
  Check check(*kernels_, {boxes_.data(), boxes_.size()});
  check.contents(world(), bodies);
  Walk().go(allBoxes(), world(), {}, check);
  return check.fault();
}

}  // namespace

std::unique_ptr<BroadPhase> create() { return std::make_unique<Columns>(); }

std::vector<Algorithm> variants() {
  const Algorithm family = {
      .family = "Columns",
      .traits = {.changing_worlds = ChangingWorlds::compacted,
                 .side_by_side_below = 400,
                 .max_objects = kMaxMarkedBodies - 1},
      .description = {.principle = "grid, sorting",
                      .optimisations = "layout by sample, small integers, bucket sort",
                      .time = "O(n + w), w pairs that share a column and overlap along it",
                      .space = "O(n + k)",
                      .source = "Broadmark; Ericson 2005, 7.1 and 7.5"}};
  return {variantOf<Columns>(family, "columns", "columns chosen by a sample, a sweep in each",
                             {.vectorised = true}),
          variantOf<Columns>(family, "columns-mt",
                             "columns chosen by a sample, a sweep in each, on several threads",
                             {.parallel = true, .vectorised = true})};
}

}  // namespace broadmark::columns
