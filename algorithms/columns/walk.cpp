// Walks through columns. A column's copies are put in order by one counting sort; reading them from
// their chains is the last time that they come from memory.

#include "columns/walk.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "sample.h"

namespace broadmark::columns {
namespace {

/// A column has as many buckets as copies, or up to twice as many, but no more than this.
constexpr std::size_t kMostBuckets = std::size_t{1} << 20;
/// What it costs to put a copy in order and to test it at all, in tests.
constexpr double kWorkPerCopy = 40;

}  // namespace

void Walk::go(const Boxes& boxes, const CutWorld& world, const Part& part, ColumnVisitor& visitor) {
  boxes_ = boxes;
  visitor_ = &visitor;
  level_ = 0;
  goThrough(world, part);
}

double Walk::workOf(const Layout& layout, std::size_t copies) const {
  const auto count = static_cast<double>(copies);
  return count *
         (kWorkPerCopy + std::min(count * layout.metPart(), static_cast<double>(boxes_.crowded)));
}

void Walk::goThrough(const CutWorld& world, const Part& part) {
  const std::size_t columns = world.layout.size();
  double all = 0;
  for (std::size_t column = 0; column < columns; ++column) {
    all += workOf(world.layout, world.count(column));
  }
  const double begin = part.from * all;
  const double end = part.to * all;
  double before = 0;
  for (std::size_t column = 0; column < columns && before < end; ++column) {
    const std::size_t count = world.count(column);
    const double work = workOf(world.layout, count);
    if (count > 0 && before + work > begin) {
      order(world, column, count);
      ahead_ = column + 1 < columns ? ChainsAhead(world.chains, column + 1) : ChainsAhead();
      path_[static_cast<std::size_t>(level_)] = {&world.layout, column};
      const Part of_column = {std::max(0.0, (begin - before) / work),
                              std::min(1.0, (end - before) / work)};
      if (!split(of_column)) visitor_->column(*this, of_column);
    }
    before += work;
  }
}

void Walk::order(const CutWorld& world, std::size_t column, std::size_t count) {
  const auto bucket_bits = static_cast<int>(std::bit_width(std::min(count, kMostBuckets) - 1));
  const auto bucket_of = [&](std::uint32_t step) {
    return step >> (Layout::kSweepBits - bucket_bits);
  };
  places_.assign(std::size_t{1} << bucket_bits, 0);
  world.forEachCopy(column, [&](const Copy& copy) { ++places_[bucket_of(copy.first)]; });
  std::uint32_t place = 0;
  for (std::uint32_t& number : places_) place += std::exchange(number, place);
  sorted_.resize(count);
  world.forEachCopy(
      column, [&](const Copy& copy) { sorted_.copies[places_[bucket_of(copy.first)]++] = copy; });
  sorted_.tests = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Copy& copy = sorted_.copies[i];
    const std::uint32_t end = places_[bucket_of(copy.last())];
    sorted_.keys[i] = copy.key;
    sorted_.ends[i] = end;
    sorted_.tests += end - i;
  }
}

/// Cuts the column at hand and goes through what is in it, if it is crowded and that promises to be
/// worth it.
bool Walk::split(const Part& part) {
  const std::size_t count = sorted_.size;
  if (!crowded() || level_ + 1 == kMostLevels) return false;
  takeSample(
      count,
      [&](std::size_t i) -> const Aabb& {
        return boxes_.boxes[bodyNumber(sorted_.copies[i].body)];
      },
      sample_);
  const Layout layout(sample_, count, boxes_.copy_cost);
  const double cost = layout.costPerBox() * static_cast<double>(count);
  if (layout.size() == 1 || cost >= static_cast<double>(sorted_.tests) / 2) return false;
  Chains& chains = chains_[static_cast<std::size_t>(level_)];
  if (!fill(layout, chains)) return false;  // the sample has misled
  const CutWorld inside = {layout, {&chains, 1}};
  visitor_->split(*this, inside, part);
  ++level_;
  goThrough(inside, part);
  --level_;
  return true;
}

/// Copies what is in the column at hand into columns of its own. False if there would be far too
/// many copies.
bool Walk::fill(const Layout& layout, Chains& chains) {
  constexpr std::size_t kBlock = BoxBlock::kBoxes;
  const std::size_t limit = kMostCopies * sorted_.size;
  std::size_t copies = 0;
  BoxBlock block;
  std::array<Aabb, kBlock> boxes;
  std::array<MarkedBody, kBlock> bodies;
  chains.clear(layout.size());
  for (std::size_t row = 0; row < sorted_.size && copies <= limit; row += kBlock) {
    const std::size_t count = std::min(kBlock, sorted_.size - row);
    for (std::size_t i = 0; i < count; ++i) {
      bodies[i] = sorted_.copies[row + i].body;
      boxes[i] = boxes_.boxes[bodyNumber(bodies[i])];
    }
    boxes_.kernels->find_steps(boxes.data(), bodies.data(), count, layout.scales(), block);
    copies += appendCopies(layout, block, count, chains);
  }
  return copies <= limit;
}

Aabb Walk::box(const Aabb& bounds) const {
  Aabb box = bounds;
  for (int level = 0; level <= level_; ++level) {
    const Place& place = path_[static_cast<std::size_t>(level)];
    box = place.layout->column(place.column, box);
  }
  return box;
}

}  // namespace broadmark::columns
