// The kernels of Tide, written once; compiled for each instruction set by for_each_isa.inl.

using namespace broadmark::tide;

/// Writes a search for each place of a body that has moved far, has come or has gone.
inline Search* addApart(Search search, const Extent& before, const Extent& now, Search* next) {
  if (search.cell_before != kNowhere) {
    search.around = before;
    search.wanted = kEnds;
    *next++ = search;
    search.cell_before = search.cell;  // that has been told
  }
  if (search.cell != kNowhere) {
    search.around = now;
    search.wanted = kBeginnings;
    *next++ = search;
  }
  return next;
}

/// Moves a body, and writes its searches; returns where the next ones go.
inline Search* moveBody(Cells& cells, std::uint32_t frame, std::uint32_t index, Body& body,
                        const Aabb& to, Search* next) {
  const std::uint32_t cell_before = body.cell();
  const Extent before = cells.extentOf(body.box);
  const Extent now = cells.extentOf(to);
  std::uint32_t level = 0;
  std::uint32_t cell = kNowhere;
  if (!isEmpty(to)) {
    level = Cells::levelOf(now);
    cell = cells.cellOf(now, level);
    cells.reach(now, level);
  }
  body.move(to, cell, frame);
  // Around both places at once, unless it has moved far.
  const Steps far = 1 << Cells::kCellBits | now.edges();
  const auto is_near = [&](Steps from, Steps at) {
    return (at - from <= far) & (from - at <= far);
  };
  const bool near = isEveryAxis(is_near(before.min, now.min) & is_near(before.max, now.max));
  const Extent both = {smaller(before.min, now.min), larger(before.max, now.max)};
  // In a cell that it does not leave it is found at both places. Nobody could predict whether it
  // leaves it.
  const Steps stays = Steps{} - std::int32_t{cell == cell_before};
  const Extent found = {stays ? both.min : now.min, stays ? both.max : now.max};
  const Bounds bounds = cells.boundsOf(found, now, level);
  Search search = {both, bounds, index, kBeginnings | kEnds, cell, cell_before};
  if (near && cell_before != kNowhere && cell != kNowhere) [[likely]] {
    *next = search;
    return next + 1;
  }
  return addApart(search, before, now, next);
}

std::size_t addSearches(Cells& cells, std::uint32_t frame, const std::uint32_t* bodies,
                        std::size_t count, const Aabb* boxes, Body* of_bodies, Search* searches) {
  Search* next = searches;
  for (std::size_t i = 0; i < count; ++i) {
    if (i + kPrefetchL2Distance < count) {
      prefetchL2(&boxes[bodies[i + kPrefetchL2Distance]]);
      prefetchL2(&of_bodies[bodies[i + kPrefetchL2Distance]]);
    }
    if (i + kPrefetchDistance < count) {
      prefetch(&boxes[bodies[i + kPrefetchDistance]]);
      prefetch(&of_bodies[bodies[i + kPrefetchDistance]]);
    }
    const std::uint32_t body = bodies[i];
    next = moveBody(cells, frame, body, of_bodies[body], boxes[body], next);
  }
  return static_cast<std::size_t>(next - searches);
}

bool setLook(const Cells& cells, const Line* lines, const Extent& extent, std::uint32_t level,
             Look& look) {
  const Cells::Level& at = cells.level(level);
  const auto [first, last] = cells.rangeAround(extent, level);
  const Steps in_bulk = (first >= at.first) & (last - at.first < at.counts);
  if (!isEveryAxis(in_bulk & (last - first <= 1))) return false;
  const Steps number = (first - at.first) * at.strides;
  const Steps is_two = last > first;
  setLines({.first = lines + at.first_cell + sumOfAxes(number),
            .next = at.strides & is_two,
            .is_two = is_two,
            .extent = Cells::countedFrom(first, extent, level)},
           look);
  return true;
}

// Nobody could predict which looks find somebody, so nothing branches: all of them are written
// down, and counted only if they do.
Kernels::Found look(const Look* looks, std::size_t count, std::uint32_t first, Hit* hits,
                    Hit* followed) {
  Kernels::Found found = {0, 0};
  for (std::size_t i = 0; i < count; ++i) {
    const Look& look = looks[i];
    const auto* const lines = reinterpret_cast<const std::uint64_t* const*>(look.lines);
    const std::uint64_t within = linesWithin(lines, look.limits) & look.wanted;
    const std::uint64_t places = within & Look::kPlaces;
    const std::uint64_t are_followed = within & Look::kFollowed;
    const auto number = first + static_cast<std::uint32_t>(i);
    hits[found.hits] = {places, number};
    found.hits += places != 0 ? 1 : 0;
    followed[found.followed] = {are_followed, number};
    found.followed += are_followed != 0 ? 1 : 0;
  }
  return found;
}

inline constexpr Kernels kKernels = {addSearches, setLook, look};
