// The kernels of Tide, written once; compiled for each instruction set by for_each_isa.inl.

using namespace broadmark::tide;

/// For a body that moved far, appeared or vanished: separate queries around its old and new boxes.
inline MoveQuery* addSeparateQueries(MoveQuery query, const GridBox& before, const GridBox& now,
                                     MoveQuery* next) {
  if (query.cell_before != kInvalidIndex) {
    query.region = before;
    query.events = kEndEvents;
    *next++ = query;
    query.cell_before = query.cell;  // the first query reports the change of cell
  }
  if (query.cell != kInvalidIndex) {
    query.region = now;
    query.events = kBeginEvents;
    *next++ = query;
  }
  return next;
}

/// Moves a body and writes its queries; returns the end of the list.
inline MoveQuery* moveBody(GridLayout& layout, std::uint32_t frame, std::uint32_t index, Body& body,
                           const Aabb& to, MoveQuery* next) {
  const std::uint32_t cell_before = body.cell();
  const GridBox before = layout.quantize(body.box);
  const GridBox now = layout.quantize(to);
  std::uint32_t level = 0;
  std::uint32_t cell = kInvalidIndex;
  if (!isEmpty(to)) {
    level = GridLayout::levelOf(now);
    cell = layout.cellOf(now, level);
    layout.growLevel(now, level);
  }
  body.move(to, cell, frame);
  // One query around both boxes, unless they are far apart.
  const GridCoord far = 1 << GridLayout::kCellBits | now.size();
  const auto is_near = [&](GridCoord a, GridCoord b) { return (b - a <= far) & (a - b <= far); };
  const bool near = isEveryAxis(is_near(before.min, now.min) & is_near(before.max, now.max));
  const GridBox both = {smaller(before.min, now.min), larger(before.max, now.max)};
  // A body that stays in its cell is stored with both boxes, so that queries find it by either.
  // Branchless, since changes of cell are unpredictable.
  const GridCoord stays = GridCoord{} - std::int32_t{cell == cell_before};
  const GridBox covered = {stays ? both.min : now.min, stays ? both.max : now.max};
  const PackedBounds bounds = layout.packBounds(covered, now, level);
  MoveQuery query = {both, bounds, index, kBeginEvents | kEndEvents, cell, cell_before};
  if (near && cell_before != kInvalidIndex && cell != kInvalidIndex) [[likely]] {
    *next = query;
    return next + 1;
  }
  return addSeparateQueries(query, before, now, next);
}

std::size_t moveBodies(GridLayout& layout, std::uint32_t frame, const std::uint32_t* bodies,
                       std::size_t count, const Aabb* boxes, Body* states, MoveQuery* queries) {
  MoveQuery* next = queries;
  for (std::size_t i = 0; i < count; ++i) {
    if (i + kPrefetchL2Distance < count) {
      prefetchL2(&boxes[bodies[i + kPrefetchL2Distance]]);
      prefetchL2(&states[bodies[i + kPrefetchL2Distance]]);
    }
    if (i + kPrefetchDistance < count) {
      prefetch(&boxes[bodies[i + kPrefetchDistance]]);
      prefetch(&states[bodies[i + kPrefetchDistance]]);
    }
    const std::uint32_t body = bodies[i];
    next = moveBody(layout, frame, body, states[body], boxes[body], next);
  }
  return static_cast<std::size_t>(next - queries);
}

bool makeQuery(const GridLayout& layout, const CellBucket* buckets, const GridBox& box,
               std::uint32_t level, CellQuery& query) {
  const GridLayout::Level& grid = layout.level(level);
  const auto [first, last] = layout.queryRange(box, level);
  const GridCoord is_unwrapped = (first >= grid.origin) & (last - grid.origin < grid.dims);
  if (!isEveryAxis(is_unwrapped & (last - first <= 1))) return false;
  const GridCoord index = (first - grid.origin) * grid.strides;
  const GridCoord has_second = last > first;
  setBuckets({.first = buckets + grid.base + sumOfAxes(index),
              .offset = grid.strides & has_second,
              .has_second = has_second,
              .query = GridLayout::relativeToCell(first, box, level)},
             query);
  return true;
}

// Branchless, since hits are unpredictable: write unconditionally, advance only on a match.
Kernels::Counts runQueries(const CellQuery* queries, std::size_t count, std::uint32_t first,
                           Hit* hits, Hit* overflows) {
  Kernels::Counts counts = {0, 0};
  for (std::size_t i = 0; i < count; ++i) {
    const CellQuery& query = queries[i];
    const auto* const buckets = reinterpret_cast<const std::uint64_t* const*>(query.buckets);
    const std::uint64_t within = linesWithin(buckets, query.packed) & query.active;
    const std::uint64_t slots = within & CellQuery::kSlotBits;
    const std::uint64_t overflow = within & CellQuery::kOverflowBits;
    const auto index = first + static_cast<std::uint32_t>(i);
    hits[counts.hits] = {slots, index};
    counts.hits += slots != 0 ? 1 : 0;
    overflows[counts.overflows] = {overflow, index};
    counts.overflows += overflow != 0 ? 1 : 0;
  }
  return counts;
}

inline constexpr Kernels kKernels = {moveBodies, makeQuery, runQueries};
