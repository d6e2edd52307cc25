// Uniform grid: boxes get an entry in every cell they touch, and only boxes of the same cell are
// tested against each other, by brute force (Grid BF) or by a sweep (Grid SAP). The cells divide
// space on all three axes, or are columns, cut in x and z only. O(n + t), t the tests: n · m for
// brute force, m the mean number of boxes in a cell, and less by the fraction of a cell that a box
// occupies on the sweep axis.
//
// The grid is rebuilt each frame by two counting sorts: of the entries by cell; and, for the sweep,
// within each cell by the lower bound on the axis of that cell's largest spread, into one bucket
// per box. A window ends with the bucket of the upper bound. (Sorting within buckets would save
// fewer tests than it costs.) A pair that shares several cells is reported in one of them: see
// CellBody.
//
// A box that touches more than kMaxEntries cells gets no entries. Such boxes are in a cell of their
// own, and each is tested against the contents of all cells that it touches. So there are at most
// kMaxEntries · n entries.
//
// Papers: C. Ericson, "Real-Time Collision Detection", 2005, 7.1 (uniform grids); Y. R. Serpa and
// M. A. F. Rodrigues, "Broadmark: A Testing Framework for Broad-Phase Collision Detection
// Algorithms", Computer Graphics Forum, 2019 (these variants).

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/algorithm.h"
#include "cell_grid.h"
#include "corner.h"
#include "prefetch.h"
#include "simd/overlap_kernels.h"
#include "simd/sweep_kernels.h"
#include "test_counts.h"
#include "work_shares.h"

namespace broadmark::grid {
namespace {

/// The maximum for a box of the size of a cell.
constexpr std::size_t kMaxEntries = 8;

enum class Cut { columns, cells };
enum class CellSearch { brute_force, sweep };

/// A body in one of its cells.
struct CellEntry {
  std::uint32_t cell;
  CellBody body;
};

/// The axis of a cell's sweep, and equal buckets of its range for sorting the boxes.
class CellBuckets {
 public:
  /// A single bucket.
  CellBuckets() = default;
  /// As many buckets as boxes, on the axis with the largest range of lower bounds relative to the
  /// boxes.
  explicit CellBuckets(std::span<const Aabb> boxes) {
    Corner least = cornerOf(boxes.front().min);
    Corner most = least;
    Corner edges{};  // their sum
    for (const Aabb& box : boxes) {
      const Corner min = cornerOf(box.min);
      least = smaller(least, min);
      most = larger(most, min);
      edges += cornerOf(box.max) - min;
    }
    float widest = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float range = most[axis] - least[axis];
      const float width = range / edges[axis];
      if (!(width > widest)) continue;  // false, too, for 0/0
      widest = width;
      axis_ = axis;
      low_ = least[axis];
      last_ = static_cast<float>(std::min<std::size_t>(boxes.size() - 1, kMaxBuckets));
      scale_ = std::min(last_ / range, std::numeric_limits<float>::max());
    }
  }

  [[nodiscard]] int axis() const { return axis_; }
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(last_) + 1; }
  /// The bucket of a bound. A higher bound never gets a lower bucket: correctness rests on that.
  [[nodiscard]] std::uint32_t of(float bound) const {
    const float bucket = (bound - low_) * scale_;
    const float at_least = bucket > 0 ? bucket : 0;
    return static_cast<std::uint32_t>(
        static_cast<std::int32_t>(at_least < last_ ? at_least : last_));
  }

 private:
  static constexpr std::size_t kMaxBuckets = std::size_t{1} << 20;

  int axis_ = 0;
  float low_ = 0;
  float scale_ = 0;
  float last_ = 0;  ///< number of buckets - 1
};

class Grid final : public PairBroadPhase {
 public:
  Grid(Cut cut, CellSearch search, std::int64_t objects_per_cell)
      : cut_(cut), search_(search), objects_per_cell_(objects_per_cell) {}

  void visitParameters(const ParameterVisitor& visit) override {
    visit({"objects_per_cell", "target bodies per cell", &objects_per_cell_, 1, 1'000'000'000});
  }

  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    PairBroadPhase::initialize(scene, first, execution);
    kernels_ = &overlapKernels(execution.isa());
    sweep_kernels_ = &sweepKernels(execution.isa());
    workers_.resize(static_cast<std::size_t>(team().size()));
    updateObjects(first);
    updateStructures();
  }

  void updateObjects(const Frame& frame) override {
    boxes_.resize(frame.boxes.size());
    team().run(boxes_.size(), [&](int, Range part) {
      const auto mine = frame.boxes.subspan(part.begin, part.size());
      std::ranges::copy(mine, boxes_.begin() + static_cast<std::ptrdiff_t>(part.begin));
    });
  }

  void updateStructures() override {
    const std::size_t cells = boxes_.size() / static_cast<std::size_t>(objects_per_cell_);
    grid_.fit(boxes_, cells, cut_ == Cut::columns);
    findEntries();
    placeEntries();
    sortEntries();
    orderCells();
    shares_.measureRows(ends_, team());
  }

  void drawStructure(DebugDraw& draw) const override;
  void visitCounters(const CounterVisitor& visit) const override;
  [[nodiscard]] std::string validate() const override;

 private:
  /// One worker's data, on separate cache lines.
  struct alignas(64) Worker {
    std::vector<CellEntry> entries;      ///< of its share of the boxes
    std::vector<std::uint32_t> places;   ///< per cell: number of entries, then insertion index
    std::vector<Aabb> boxes;             ///< of the current cell
    std::vector<std::uint32_t> buckets;  ///< number of boxes per bucket, then end of each bucket
  };

  /// The cell of the boxes that touch too many others. Cell k of the grid is cell k + 1 here.
  static constexpr std::size_t kLarge = 0;

  Worker& workerData(int worker) { return workers_[static_cast<std::size_t>(worker)]; }

  void findPairs() override {
    const Range large = contents(kLarge);
    team().run(large.end, [&](int worker, Range part) {
      kernels_->sweep_cells(arrays_, ends_.data(), bodies_.data(), shares_.of(worker),
                            pairs(worker));
      for (std::size_t i = part.begin; i < part.end; ++i) {
        forEachRowOfCells(i, [&](Range entries, CellBody phantoms) {
          sweep_kernels_->test_row(arrays_, i, bodies_[i] | phantoms, entries, bodies_.data(),
                                   pairs(worker));
        });
      }
    });
  }

  [[nodiscard]] std::size_t cellCount() const { return grid_.size() + 1; }
  /// The entries of a cell.
  [[nodiscard]] Range contents(std::size_t cell) const {
    return {starts_[cell], starts_[cell + 1]};
  }

  /// Calls visit(cell, phantoms) for each cell that gets an entry of the box.
  template <class Visit>
  void forEachCell(const Aabb& box, Visit visit) const {
    const CellRange range = grid_.touched(box);
    if (range.count() > kMaxEntries) {
      visit(kLarge, 0);
    } else {
      grid_.forEachCell(range,
                        [&](std::size_t index, CellBody phantoms) { visit(index + 1, phantoms); });
    }
  }

  void findEntries() {
    team().run(boxes_.size(), [&](int worker, Range part) {
      Worker& mine = workerData(worker);
      mine.entries.clear();
      mine.places.assign(cellCount(), 0);
      for (std::size_t i = part.begin; i < part.end; ++i) {
        forEachCell(boxes_[i], [&](std::size_t cell, CellBody phantoms) {
          mine.entries.push_back(
              {static_cast<std::uint32_t>(cell), static_cast<CellBody>(i) | phantoms});
          ++mine.places[cell];
        });
      }
    });
  }

  /// Turns counts into indices, by cell and then by worker: the order of the entries is that of the
  /// bodies, for any team.
  void placeEntries() {
    starts_.resize(cellCount() + 1);
    std::uint32_t place = 0;
    for (std::size_t cell = 0; cell < cellCount(); ++cell) {
      starts_[cell] = place;
      for (Worker& worker : workers_) place += std::exchange(worker.places[cell], place);
    }
    starts_.back() = place;
    entries_.resize(place);
    arrays_.resize(place);
    bodies_.resize(place);
    ends_.resize(place);
  }

  void sortEntries() {
    team().run([&](int worker) {
      Worker& mine = workerData(worker);
      for (const CellEntry entry : mine.entries) entries_[mine.places[entry.cell]++] = entry.body;
    });
  }

  /// Sorts every cell's entries. Workers get whole cells, with about as many entries each: a
  /// crowded cell is sorted by one worker, but this is linear, and the search is divided by rows.
  void orderCells() {
    team().run([&](int worker) {
      const auto first_cell = [&](int k) {
        const std::size_t place = share(entries_.size(), team().size(), k).begin;
        return std::ranges::lower_bound(starts_, place) - starts_.begin();
      };
      for (auto cell = first_cell(worker); cell < first_cell(worker + 1); ++cell) {
        const Range range = contents(static_cast<std::size_t>(cell));
        if (range.begin < range.end) orderCell(range, workerData(worker));
      }
    });
  }

  /// Sorts a cell's entries by bucket of their lower bound; the window of each ends with the bucket
  /// of its upper bound. For brute force there is one bucket.
  void orderCell(Range range, Worker& worker) {
    std::vector<Aabb>& boxes = worker.boxes;
    boxes.resize(range.end - range.begin);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const std::size_t ahead = range.begin + i + kPrefetchDistance;
      if (ahead < entries_.size()) prefetch(&boxes_[bodyId(entries_[ahead])]);
      boxes[i] = boxes_[bodyId(entries_[range.begin + i])];
    }
    const CellBuckets buckets = search_ == CellSearch::sweep ? CellBuckets(boxes) : CellBuckets();
    const int axis = buckets.axis();
    std::vector<std::uint32_t>& places = worker.buckets;
    places.assign(buckets.count(), 0);
    for (const Aabb& box : boxes) ++places[buckets.of(box.min[axis])];
    std::exclusive_scan(places.begin(), places.end(), places.begin(),
                        static_cast<std::uint32_t>(range.begin));
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const std::uint32_t place = places[buckets.of(boxes[i].min[axis])]++;
      arrays_.set(place, boxes[i]);
      bodies_[place] = entries_[range.begin + i];
    }
    const float* const max = arrays_.max(axis);
    for (std::size_t i = range.begin; i < range.end; ++i) ends_[i] = places[buckets.of(max[i])];
  }

  /// Calls visit(entries, phantoms) for the entries that the large box at i is tested against: all
  /// in the cells that it touches, a row of cells (with contiguous entries) at a time.
  template <class Visit>
  void forEachRowOfCells(std::size_t i, Visit visit) const {
    const CellRange range = grid_.touched(arrays_.box(i));
    const auto visit_cells = [&](std::size_t first_cell, std::size_t last_cell, CellBody phantoms) {
      visit(Range{starts_[first_cell + 1], starts_[last_cell + 2]}, phantoms);
    };
    for (std::int32_t z = range.first[2]; z <= range.last[2]; ++z) {
      for (std::int32_t y = range.first[1]; y <= range.last[1]; ++y) {
        const std::size_t first = grid_.indexOf(range.first[0], y, z);
        const std::size_t last = grid_.indexOf(range.last[0], y, z);
        const bool later_y = y != range.first[1];
        const bool later_z = z != range.first[2];
        visit_cells(first, first, phantomBits(false, later_y, later_z));
        if (first < last) visit_cells(first + 1, last, phantomBits(true, later_y, later_z));
      }
    }
  }

  Cut cut_;
  CellSearch search_;
  std::int64_t objects_per_cell_;
  const OverlapKernels* kernels_ = nullptr;
  const SweepKernels* sweep_kernels_ = nullptr;
  std::vector<Worker> workers_;

  std::vector<Aabb> boxes_;
  CellGrid grid_;
  std::vector<std::uint32_t> starts_;  ///< start of each cell's entries, and the end
  std::vector<CellBody> entries_;      ///< by cell, in the order of the bodies
  BoxArrays arrays_;                   ///< by cell, in the order of the sweep
  std::vector<CellBody> bodies_;       ///< of arrays_
  std::vector<std::uint32_t> ends_;    ///< of the windows of arrays_
  WorkShares shares_;
};

void Grid::drawStructure(DebugDraw& draw) const {
  // More cells would hide each other. The fullest cells are drawn.
  constexpr std::size_t kMaxDrawn = 10'000;
  std::vector<std::size_t> cells;
  for (std::size_t cell = kLarge + 1; cell < cellCount(); ++cell) {
    if (starts_[cell] < starts_[cell + 1]) cells.push_back(cell);
  }
  const auto population = [&](std::size_t cell) { return starts_[cell + 1] - starts_[cell]; };
  if (cells.size() > kMaxDrawn) {
    std::ranges::nth_element(cells, cells.begin() + kMaxDrawn, std::ranges::greater(), population);
    cells.resize(kMaxDrawn);
  }
  Aabb bounds = kEmptyBox;
  for (const Aabb& box : boxes_) bounds = merged(bounds, box);
  for (const std::size_t cell : cells) {
    draw.cell(grid_.cell(cell - 1, bounds), 0, population(cell));
  }
  TestCounts tests(ends_.size());
  tests.addWindows(ends_);
  for (std::size_t i = 0; i < contents(kLarge).end; ++i) {
    forEachRowOfCells(i, [&](Range others, CellBody) { tests.add(i, others); });
  }
  tests.report(draw, [this](std::size_t i) { return bodyId(bodies_[i]); });
}

void Grid::visitCounters(const CounterVisitor& visit) const {
  visit("cells", grid_.size());
  visit("copies", bodies_.size());
  visit("large bodies", contents(kLarge).end);
}

std::string Grid::validate() const {
  if (bodies_.size() > kMaxEntries * boxes_.size()) return "too many copies";
  // The expected entries of each box, removed during the traversal of the cells.
  std::vector<std::vector<CellBody>> expected(cellCount());
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    forEachCell(boxes_[i], [&](std::size_t cell, CellBody phantoms) {
      expected[cell].push_back(static_cast<CellBody>(i) | phantoms);
    });
  }
  for (std::size_t cell = 0; cell < cellCount(); ++cell) {
    const auto [begin, end] = contents(cell);
    std::vector<CellBody> found(bodies_.begin() + static_cast<std::ptrdiff_t>(begin),
                                bodies_.begin() + static_cast<std::ptrdiff_t>(end));
    std::ranges::sort(found);
    std::ranges::sort(expected[cell]);
    if (found != expected[cell]) return "a cell does not hold the bodies that touch it";
    for (std::size_t i = begin; i < end; ++i) {
      const Aabb& box = boxes_[bodyId(bodies_[i])];
      if (arrays_.box(i) != merged(box, box))
        return "a copy differs from its box";  // except the padding
      if (ends_[i] <= i || ends_[i] > end) return "window out of range";
      for (std::size_t j = ends_[i]; j < end; ++j) {
        if (broadmark::overlaps(box, arrays_.box(j))) return "window too short";
      }
    }
  }
  return {};
}

/// The differences between the variants.
struct GridVariant {
  std::string id;
  Cut cut = Cut::cells;
  CellSearch search = CellSearch::brute_force;
  std::int64_t objects_per_cell = 200;  ///< the original's default
  bool parallel = false;
};

Algorithm variant(const GridVariant& options) {
  const bool sweeps = options.search == CellSearch::sweep;
  const std::string cells = options.cut == Cut::columns ? "columns (cut in x and z), " : "cells, ";
  return {.id = options.id,
          .family = sweeps ? "Grid SAP" : "Grid BF",
          .summary = "uniform grid of " + cells + (sweeps ? "a sweep" : "brute force") +
                     " in each" + (options.parallel ? ", on several threads" : ""),
          .traits = {.parallel = options.parallel,
                     .vectorised = true,
                     .changing_worlds = ChangingWorlds::compacted,
                     .side_by_side_below = 400,
                     .max_objects = kMaxCellBodies - 1},
          .description = {.principle = sweeps ? "grid, sorting" : "grid",
                          .optimisations = sweeps ? "axis per cell, bucket sort" : "",
                          .time = sweeps ? "O(n + w), w pairs that share a cell and overlap on its "
                                           "sweep axis"
                                         : "O(n + w), w pairs that share a cell",
                          .space = "O(n + k)",
                          .source = "Serpa and Rodrigues 2019; Ericson 2005, 7.1"},
          .create = [options] {
            return std::make_unique<Grid>(options.cut, options.search, options.objects_per_cell);
          }};
}

}  // namespace

std::vector<Algorithm> variants() {
  constexpr CellSearch kSweep = CellSearch::sweep;
  // Swept columns profit from a larger width, as their sweeps are long: 16 to 29 % faster on 32,000
  // to a million bodies, slightly slower on 2,000.
  constexpr std::int64_t kSweptColumn = 1000;
  return {variant({.id = "grid-bf"}),
          variant({.id = "grid-bf-mt", .parallel = true}),
          variant({.id = "grid2d-bf", .cut = Cut::columns}),
          variant({.id = "grid2d-bf-mt", .cut = Cut::columns, .parallel = true}),
          variant({.id = "grid-sap", .search = kSweep}),
          variant({.id = "grid-sap-mt", .search = kSweep, .parallel = true}),
          variant({"grid2d-sap", Cut::columns, kSweep, kSweptColumn}),
          variant({"grid2d-sap-mt", Cut::columns, kSweep, kSweptColumn, /*parallel=*/true})};
}

}  // namespace broadmark::grid
