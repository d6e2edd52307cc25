// Columns: a broad phase from scratch, made to be fast. Space is cut into columns over two axes; in
// each, boxes are swept along the third. No state is kept but buffers.
//
//  1. A sample of the boxes tells which axes to cut, and how often (columns/layout.h).
//  2. One pass over the boxes copies each into the columns that it touches, with its bounds on the
//     two axes in 32 bits (columns/copies.h, columns/chains.h).
//  3. Each column is put in order along the sweep axis, in one counting sort by at least as many
//     buckets as there are copies: a window ends with the bucket in which its box ends.
//  4. Columns that turn out to be crowded are cut into columns of their own, as if each were a
//     world: steps 1 to 3 again.
//  5. Windows are swept with vectors of bytes. Where bounds share a step, the boxes decide.
//
// A pair that shares several columns is reported in one of them: see MarkedBody, whose argument
// holds for any columns that tile the plane, split ones, too. A mark says that the body begins
// before the column does.
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
#include <bit>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "columns/chains.h"
#include "columns/copies.h"
#include "columns/hits.h"
#include "columns/kernels.h"
#include "columns/layout.h"
#include "past_caches.h"
#include "row_shares.h"
#include "sample.h"
#include "variants.h"

namespace broadmark::columns {
namespace {

/// Of the boxes in a layout, at most so many copies each on average.
constexpr std::size_t kMostCopies = 4;
/// Columns are split, and split again, at most so often.
constexpr int kMostLevels = 8;

constexpr std::size_t kBlock = BoxBlock::kBoxes;
/// The boxes themselves are looked at rarely: so many of them should not take up the caches.
constexpr std::size_t kBoxesPastCaches = std::size_t{1} << 17;
/// Of boxes past the caches, those of many rows are looked at together.
constexpr std::size_t kRowsPerLook = 16 * RowShares::kSmallChunk;
/// A column has as many buckets as copies, or up to twice as many, but no more than this.
constexpr std::size_t kMostBuckets = std::size_t{1} << 20;

/// A column, and whose it is.
struct Column {
  std::uint32_t part;
  std::uint32_t index;      ///< in that part's layout
  std::uint32_t split = 0;  ///< the part that it is cut into; 0: none
};

/// A layout, of the world or of a split column.
struct Part {
  Layout layout;
  int level = 0;                   ///< 0: the world
  std::uint32_t parent = 0;        ///< the column that it splits
  std::uint32_t first_column = 0;  ///< its columns are next to each other
};

class Columns final : public PairBroadPhase {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"copy_cost", "cost of a copy of a box, in tests of a pair: more make wider columns",
           &copy_cost_, 1, 1'000'000});
    visit({"crowded", "tests per copy in a column from which on it is split", &crowded_, 1,
           1'000'000'000});
  }

  void initialize(const SceneInfo& scene, const Frame& first, Execution& execution) override {
    PairBroadPhase::initialize(scene, first, execution);
    kernels_ = &kernels(execution.isa());
    workers_.resize(static_cast<std::size_t>(team().size()));
    updateObjects(first);
    updateStructures();
  }

  void updateObjects(const Frame& frame) override;
  void updateStructures() override;

  void drawStructure(DebugDraw& draw) const override;
  void visitCounters(const CounterVisitor& visit) const override;
  [[nodiscard]] std::string validate() const override;

 private:
  /// One worker's own data, on cache lines of their own.
  struct alignas(64) Worker {
    Chains chains;
    std::vector<std::uint32_t> places;  ///< per bucket of the column at hand
    std::vector<Aabb> sample;           ///< of the column at hand
    std::vector<Part> splits;           ///< of its crowded columns
    std::uint64_t compared_boxes = 0;
  };

  Worker& workerData(int worker) { return workers_[static_cast<std::size_t>(worker)]; }
  [[nodiscard]] Costs costs() const { return {static_cast<double>(copy_cost_)}; }
  [[nodiscard]] bool boxesPastCaches() const { return boxes_.size() >= kBoxesPastCaches; }
  [[nodiscard]] std::size_t rowsPerFlush() const {
    return boxesPastCaches() ? kRowsPerLook : RowShares::kSmallChunk;
  }
  /// The copies in a column.
  [[nodiscard]] Range contents(std::size_t column) const {
    return {starts_[column], starts_[column + 1]};
  }

  void findPairs() override;

  void addPart(const Part& part);
  bool copyBoxes(const Frame& frame);
  void placeColumns();
  void orderColumns();
  void orderColumn(std::size_t column, Worker& worker);
  void considerSplit(std::size_t column, std::uint64_t tests, Worker& worker);
  void split();
  void splitColumn(const Part& part, Worker& worker);
  template <class Work>
  void forShares(Range columns, Work work);

  std::int64_t copy_cost_ = 150;
  std::int64_t crowded_ = 100;
  const Kernels* kernels_ = nullptr;
  std::vector<Worker> workers_;

  LargeArray<Aabb> boxes_;
  std::vector<Part> parts_;
  std::vector<Column> columns_;
  std::vector<std::uint32_t> starts_;  ///< of columns in sorted_, and the end
  std::size_t placed_ = 0;             ///< columns that have a start; the others are new
  Sorted sorted_;
  RowShares shares_;
};

/// Calls visit(column, copy) for every column that boxes of a block touch.
///
/// First come all boxes' first columns, without a branch; few boxes touch others.
template <class Visit>
inline void forEachCopy(const Layout& layout, const BoxBlock& block, std::size_t count,
                        Visit visit) {
  constexpr int kBits = Layout::kStepBits;
  constexpr std::uint32_t kLast = Layout::kLastStep;
  std::array<std::uint32_t, BoxBlock::kBoxes> crossing;
  std::size_t crossings = 0;
  for (std::size_t k = 0; k < count; ++k) {
    visit(block.columns[k], block.copies[k]);
    crossing[crossings] = static_cast<std::uint32_t>(k);
    crossings += block.crossing[k] != 0 ? 1 : 0;
  }
  for (std::size_t c = 0; c < crossings; ++c) {
    const std::uint32_t k = crossing[c];
    Copy copy = block.copies[k];
    const MarkedBody body = copy.body;
    const std::uint32_t low_a = block.low[0][k];
    const std::uint32_t low_b = block.low[1][k];
    const std::uint32_t high_a = block.high[0][k];
    const std::uint32_t high_b = block.high[1][k];
    for (std::uint32_t b = low_b >> kBits; b <= high_b >> kBits; ++b) {
      const bool later_b = b != low_b >> kBits;
      const std::uint32_t first_b = later_b ? 0 : low_b & kLast;
      const std::uint32_t last_b = b != high_b >> kBits ? kLast : high_b & kLast;
      const std::uint32_t first_column = low_a >> kBits;
      for (std::uint32_t a = first_column + (later_b ? 0 : 1); a <= high_a >> kBits; ++a) {
        const bool later_a = a != first_column;
        const std::uint32_t first_a = later_a ? 0 : low_a & kLast;
        const std::uint32_t last_a = a != high_a >> kBits ? kLast : high_a & kLast;
        copy.key = keyOf(first_a, first_b, last_a, last_b);
        copy.body = body | cellMarks(later_a, later_b, false);
        visit(layout.indexOf(a, b), copy);
      }
    }
  }
}

void Columns::addPart(const Part& part) {
  const auto index = static_cast<std::uint32_t>(parts_.size());
  parts_.push_back(part);
  parts_.back().first_column = static_cast<std::uint32_t>(columns_.size());
  for (std::uint32_t column = 0; column < part.layout.size(); ++column) {
    columns_.push_back({index, column});
  }
}

void Columns::updateObjects(const Frame& frame) {
  boxes_.resize(frame.boxes.size());

  std::vector<Aabb>& sample = workers_.front().sample;
  takeSample(
      boxes_.size(), [&](std::size_t i) { return frame.boxes[i]; }, sample);
  Layout layout(sample, boxes_.size(), costs());
  for (;; layout.widen()) {
    parts_.clear();
    columns_.clear();
    placed_ = 0;
    addPart({layout});
    if (copyBoxes(frame)) break;
  }
}

/// Copies the boxes into the columns. False if there would be far too many copies: then the sample
/// has misled.
bool Columns::copyBoxes(const Frame& frame) {
  const Layout layout = parts_.front().layout;
  const std::size_t limit = kMostCopies * boxes_.size() + 4 * columns_.size();
  const bool past_caches = boxesPastCaches();
  team().run([&](int worker) {
    Chains& chains = workerData(worker).chains;
    chains.clear(columns_.size());
    const std::size_t blocks = (boxes_.size() + kBlock - 1) / kBlock;
    const auto [begin, end] = share(blocks, team().size(), worker);
    BoxBlock block;
    std::array<MarkedBody, kBlock> bodies;
    for (std::size_t k = begin; k < end && chains.leastCount() <= limit; ++k) {
      const std::size_t first = k * kBlock;
      const std::size_t count = std::min(kBlock, boxes_.size() - first);
      const Aabb* const boxes = frame.boxes.data() + first;
      std::iota(bodies.begin(), bodies.end(), static_cast<MarkedBody>(first));
      kernels_->find_steps(boxes, bodies.data(), count, layout.scales(), block);
      if (past_caches) {
        copyPastCaches(boxes, count * sizeof(Aabb), boxes_.data() + first);
      } else {
        std::copy_n(boxes, count, boxes_.data() + first);
      }
      forEachCopy(layout, block, count,
                  [&](std::size_t column, const Copy& copy) { chains.append(column, copy); });
    }
    if (past_caches) showCopiesPastCaches();
  });
  std::size_t copies = 0;
  for (const Worker& worker : workers_) copies += worker.chains.count();
  return copies <= limit || layout.size() == 1;
}

void Columns::updateStructures() {
  starts_.assign(1, 0);
  sorted_.resize(0);
  for (;;) {
    placeColumns();
    orderColumns();
    if (placed_ == columns_.size()) break;
    split();
  }
  shares_.measure({sorted_.ends.data(), sorted_.size}, team(), rowsPerFlush());
}

/// Turns the lengths of the new columns' chains into places, behind the others.
void Columns::placeColumns() {
  for (std::size_t column = placed_; column < columns_.size(); ++column) {
    std::size_t copies = 0;
    for (const Worker& worker : workers_) copies += worker.chains.count(column - placed_);
    starts_.push_back(starts_.back() + static_cast<std::uint32_t>(copies));
  }
  sorted_.resize(starts_.back());
}

/// Shares columns out, whole ones, about as many copies each.
template <class Work>
void Columns::forShares(Range columns, Work work) {
  team().run([&](int worker) {
    const std::size_t copies = starts_[columns.end] - starts_[columns.begin];
    const auto first_of = [&](int k) {
      const std::size_t place = starts_[columns.begin] + share(copies, team().size(), k).begin;
      const auto begin = starts_.begin() + static_cast<std::ptrdiff_t>(columns.begin);
      const auto end = starts_.begin() + static_cast<std::ptrdiff_t>(columns.end);
      if (k == team().size()) return columns.end;
      return static_cast<std::size_t>(std::lower_bound(begin, end, place) - starts_.begin());
    };
    for (std::size_t column = first_of(worker); column < first_of(worker + 1); ++column) {
      work(column, workerData(worker));
    }
  });
}

/// Puts the new columns in order, and adds the parts that crowded ones are to be split into.
void Columns::orderColumns() {
  for (Worker& worker : workers_) worker.splits.clear();
  forShares({placed_, columns_.size()},
            [&](std::size_t column, Worker& worker) { orderColumn(column, worker); });
  placed_ = columns_.size();
  for (const Worker& worker : workers_) {
    for (const Part& part : worker.splits) {
      columns_[part.parent].split = static_cast<std::uint32_t>(parts_.size());
      addPart(part);
    }
  }
}

void Columns::orderColumn(std::size_t column, Worker& worker) {
  const Range range = contents(column);
  if (range.size() == 0) return;
  const auto for_each_copy = [&](auto visit) {
    for (const Worker& each : workers_) each.chains.forEach(column - placed_, visit);
  };
  const auto bucket_bits =
      static_cast<int>(std::bit_width(std::min(range.size(), kMostBuckets) - 1));
  const auto bucket_of = [&](std::uint32_t step) {
    return step >> (Layout::kSweepBits - bucket_bits);
  };
  std::vector<std::uint32_t>& places = worker.places;
  places.assign(std::size_t{1} << bucket_bits, 0);
  for_each_copy([&](const Copy& copy) { ++places[bucket_of(copy.first)]; });
  std::uint32_t place = static_cast<std::uint32_t>(range.begin);
  for (std::uint32_t& count : places) place += std::exchange(count, place);
  for_each_copy([&](const Copy& copy) { sorted_.copies[places[bucket_of(copy.first)]++] = copy; });
  std::uint64_t tests = 0;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const Copy& copy = sorted_.copies[i];
    const std::uint32_t end = places[bucket_of(copy.last)];
    sorted_.keys[i] = copy.key;
    sorted_.ends[i] = end;
    tests += end - i;
  }
  if (tests > static_cast<std::uint64_t>(crowded_) * range.size()) {
    considerSplit(column, tests, worker);
  }
}

/// Adds a layout for a crowded column if that promises to be worth it.
void Columns::considerSplit(std::size_t column, std::uint64_t tests, Worker& worker) {
  const Range range = contents(column);
  const int level = parts_[columns_[column].part].level + 1;
  if (level == kMostLevels) return;
  takeSample(
      range.size(),
      [&](std::size_t i) { return boxes_[bodyNumber(sorted_.copies[range.begin + i].body)]; },
      worker.sample);
  const Layout layout(worker.sample, range.size(), costs());
  const double now = static_cast<double>(tests);
  const double then = layout.costPerBox() * static_cast<double>(range.size());
  if (layout.size() > 1 && then < now / 2) {
    worker.splits.push_back({layout, level, static_cast<std::uint32_t>(column)});
  }
}

/// Copies the boxes of the columns that are to be split into the new ones. Workers get whole
/// columns, about as many copies each.
void Columns::split() {
  const auto split_parts =
      std::ranges::find_if(parts_, [&](const Part& part) { return part.first_column >= placed_; });
  const std::span<const Part> parts(split_parts, parts_.end());
  std::size_t all = 0;
  for (const Part& part : parts) all += contents(part.parent).size();
  team().run([&](int worker) {
    Worker& mine = workerData(worker);
    mine.chains.clear(columns_.size() - placed_);
    const auto [begin, end] = share(all, team().size(), worker);
    std::size_t before = 0;
    for (const Part& part : parts) {
      if (before >= begin && before < end) splitColumn(part, mine);
      before += contents(part.parent).size();
    }
  });
}

void Columns::splitColumn(const Part& part, Worker& worker) {
  const Range range = contents(part.parent);
  const std::size_t first = part.first_column - placed_;
  const std::size_t limit = kMostCopies * range.size();
  std::size_t copies = 0;
  BoxBlock block;
  std::array<Aabb, kBlock> boxes;
  std::array<MarkedBody, kBlock> bodies;
  for (std::size_t row = range.begin; row < range.end && copies <= limit; row += kBlock) {
    const std::size_t count = std::min(kBlock, range.end - row);
    const Copy* const parents = sorted_.copies.data() + row;
    for (std::size_t i = 0; i < count; ++i) {
      bodies[i] = parents[i].body;
      boxes[i] = boxes_[bodyNumber(bodies[i])];
    }
    kernels_->find_steps(boxes.data(), bodies.data(), count, part.layout.scales(), block);
    forEachCopy(part.layout, block, count, [&](std::size_t column, const Copy& copy) {
      worker.chains.append(first + column, copy);
      ++copies;
    });
  }
  if (copies > limit) {  // the sample has misled: the column stays as it is
    for (std::size_t i = 0; i < part.layout.size(); ++i) worker.chains.drop(first + i);
    columns_[part.parent].split = 0;
    return;
  }
  for (std::size_t row = range.begin; row < range.end; ++row) {
    sorted_.ends[row] = static_cast<std::uint32_t>(row + 1);
  }
}

void Columns::findPairs() {
  team().run([&](int worker) {
    constexpr std::size_t kChunk = Kernels::kSweptRows;
    HitSink sink(*kernels_, sorted_, boxes_.data(), pairs(worker));
    const Range rows = shares_.rowsOf(worker);
    for (std::size_t row = rows.begin; row < rows.end; row += kChunk) {
      const Range chunk = {row, std::min(row + kChunk, rows.end)};
      kernels_->sweep(sorted_.keys.data(), sorted_.ends.data(), chunk, sink);
      // At certain rows, so that the order of the pairs follows from the rows alone.
      if (chunk.end % rowsPerFlush() == 0) sink.flush();
    }
    sink.flush();
    workerData(worker).compared_boxes = sink.comparedBoxes();
  });
}

void Columns::drawStructure(DebugDraw& draw) const {
  constexpr Rgb kColumnColour = 0x4FA3D1;
  if (boxes_.empty()) return;
  Aabb bounds = boxes_[0];
  for (const Aabb& box : boxes_) bounds = merged(bounds, box);
  std::vector<Aabb> boxes(columns_.size());
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const Part& part = parts_[columns_[i].part];
    boxes[i] = part.layout.column(columns_[i].index, part.level == 0 ? bounds : boxes[part.parent]);
    if (columns_[i].split != 0 || contents(i).size() == 0) continue;
    draw.cell(boxes[i], kColumnColour, part.level, static_cast<std::uint32_t>(contents(i).size()));
  }
}

void Columns::visitCounters(const CounterVisitor& visit) const {
  std::uint64_t tests = 0;
  for (std::size_t i = 0; i < sorted_.size; ++i) tests += sorted_.ends[i] - i - 1;
  std::uint64_t compared = 0;
  for (const Worker& worker : workers_) compared += worker.compared_boxes;
  visit("columns", columns_.size());
  visit("split columns", parts_.size() - 1);
  visit("copies", sorted_.size);
  visit("tests", tests);
  visit("pairs decided by their boxes", compared);
}

std::string Columns::validate() const {
  // Every copy a box should have, ticked off as the columns are gone through.
  std::vector<std::vector<MarkedBody>> expected(columns_.size());
  BoxBlock block;
  const auto expect = [&](const Part& part, MarkedBody body) {
    kernels_->find_steps(&boxes_[bodyNumber(body)], &body, 1, part.layout.scales(), block);
    forEachCopy(part.layout, block, 1, [&](std::size_t column, const Copy& copy) {
      expected[part.first_column + column].push_back(copy.body);
    });
  };
  for (std::size_t i = 0; i < boxes_.size(); ++i) expect(parts_[0], static_cast<MarkedBody>(i));
  for (std::size_t column = 0; column < columns_.size(); ++column) {
    const auto [begin, end] = contents(column);
    std::vector<MarkedBody> found;
    for (std::size_t i = begin; i < end; ++i) found.push_back(sorted_.copies[i].body);
    std::ranges::sort(found);
    std::ranges::sort(expected[column]);
    if (found != expected[column]) return "a column does not hold what touches it";
    if (columns_[column].split != 0) {
      for (const MarkedBody body : found) expect(parts_[columns_[column].split], body);
      continue;
    }
    for (std::size_t i = begin; i < end; ++i) {
      if (sorted_.ends[i] <= i || sorted_.ends[i] > end) return "window out of range";
      for (std::size_t j = sorted_.ends[i]; j < end; ++j) {
        if (broadmark::overlaps(boxes_[bodyNumber(sorted_.copies[i].body)],
                                boxes_[bodyNumber(sorted_.copies[j].body)])) {
          return "window too short";
        }
      }
    }
  }
  return {};
}

}  // namespace

std::unique_ptr<BroadPhase> create() { return std::make_unique<Columns>(); }

std::vector<Algorithm> variants() {
  const Algorithm family = {
      .family = "Columns",
      .traits = {.changing_worlds = ChangingWorlds::compacted, .max_objects = kMaxMarkedBodies - 1},
      .description = {.principle = "grid, sorting",
                      .optimisations = "layout by sample, small integers, bucket sort",
                      .time = "O(n + w), w pairs that share a column and overlap along it",
                      .space = "O(n + k)",
                      .source = "Broadmark; Ericson 2005, 7.1 and 7.5"}};
  return {variantOf(family, create, "columns", "columns chosen by a sample, a sweep in each",
                    {.vectorised = true}),
          variantOf(family, create, "columns-mt",
                    "columns chosen by a sample, a sweep in each, on several threads",
                    {.parallel = true, .vectorised = true})};
}

}  // namespace broadmark::columns
