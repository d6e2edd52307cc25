// The overlap kernels, written once; compiled for each instruction set by for_each_isa.inl.
//
// A few rows are tested against the same column vectors: a column is loaded once for all of them,
// and, as hits are rare, one branch decides for all of them whether there is anything to do.

/// Rows tested at once: four rows of six bounds and six of the columns fit in 32 registers.
inline constexpr std::size_t kRows = 4;

/// Where bodies are numbered by their position.
struct ByPosition {
  Pair pair(std::size_t i, std::size_t j) const {
    return {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)};
  }
};

/// Where bodies have been sorted.
struct ByLookup {
  const std::uint32_t* bodies;

  Pair pair(std::size_t i, std::size_t j) const {
    const std::uint32_t a = bodies[i];
    const std::uint32_t b = bodies[j];
    return {a < b ? a : b, a < b ? b : a};
  }
};

/// Adds the pairs of `row` and the set bits' columns that lie in `columns`.
template <class Bodies>
void addHits(unsigned hits, std::size_t row, std::size_t first_column, Range columns, Bodies bodies,
             PairBuffer& pairs) {
  Pair* room = pairs.room(kLanes);
  std::size_t count = 0;
  for (; hits != 0; hits &= hits - 1) {
    const std::size_t column = first_column + static_cast<std::size_t>(__builtin_ctz(hits));
    room[count] = bodies.pair(row, column);
    count += (column >= columns.begin) & (column < columns.end);
  }
  pairs.advance(count);
}

/// Tests the boxes [row, row + kCount) on the axes from kFirstAxis on against the columns behind
/// each of them, within `columns`.
template <int kFirstAxis, std::size_t kCount, class Bodies>
void testRows(const BoxArrays& boxes, std::size_t row, Range columns, Bodies bodies,
              PairBuffer& pairs) {
  Vector row_min[3][kCount];
  Vector row_max[3][kCount];
  for (int axis = kFirstAxis; axis < 3; ++axis) {
    for (std::size_t r = 0; r < kCount; ++r) {
      row_min[axis][r] = broadcast(boxes.min(axis)[row + r]);
      row_max[axis][r] = broadcast(boxes.max(axis)[row + r]);
    }
  }
  const float* min[3] = {boxes.min(0), boxes.min(1), boxes.min(2)};
  const float* max[3] = {boxes.max(0), boxes.max(1), boxes.max(2)};

  // Whole, aligned vectors: what they hold outside of `columns` is dropped where hits are added.
  for (std::size_t column = columns.begin / kLanes * kLanes; column < columns.end;
       column += kLanes) {
    Mask hits[kCount];
    for (int axis = kFirstAxis; axis < 3; ++axis) {
      const Vector column_min = load(min[axis] + column);
      const Vector column_max = load(max[axis] + column);
      for (std::size_t r = 0; r < kCount; ++r) {
        const Mask here = meet(row_min[axis][r], row_max[axis][r], column_min, column_max);
        hits[r] = axis == kFirstAxis ? here : both(hits[r], here);
      }
    }
    Mask any = hits[0];
    for (std::size_t r = 1; r < kCount; ++r) any = either(any, hits[r]);
    if (bits(any) == 0) [[likely]]
      continue;
    for (std::size_t r = 0; r < kCount; ++r) {
      const std::size_t behind = row + r + 1;
      addHits(bits(hits[r]), row + r, column,
              {columns.begin > behind ? columns.begin : behind, columns.end}, bodies, pairs);
    }
  }
}

void testTile(const BoxArrays& boxes, Range rows, Range columns, PairBuffer& pairs) {
  std::size_t row = rows.begin;
  for (; row + kRows <= rows.end; row += kRows) {
    const std::size_t begin = columns.begin > row + 1 ? columns.begin : row + 1;
    testRows<0, kRows>(boxes, row, {begin, columns.end}, ByPosition{}, pairs);
  }
  for (; row < rows.end; ++row) {
    const std::size_t begin = columns.begin > row + 1 ? columns.begin : row + 1;
    testRows<0, 1>(boxes, row, {begin, columns.end}, ByPosition{}, pairs);
  }
}

void sweep(const BoxArrays& boxes, const std::uint32_t* ends, const std::uint32_t* bodies,
           Range rows, PairBuffer& pairs) {
  const ByLookup lookup{bodies};
  std::size_t row = rows.begin;
  for (; row + kRows <= rows.end; row += kRows) {
    // The windows' common part together, then what each has beyond.
    std::size_t common = ends[row];
    for (std::size_t r = 1; r < kRows; ++r) {
      if (ends[row + r] < common) common = ends[row + r];
    }
    testRows<1, kRows>(boxes, row, {row + 1, common}, lookup, pairs);
    for (std::size_t r = 0; r < kRows; ++r) {
      const std::size_t begin = common > row + r + 1 ? common : row + r + 1;
      testRows<1, 1>(boxes, row + r, {begin, ends[row + r]}, lookup, pairs);
    }
  }
  for (; row < rows.end; ++row) testRows<1, 1>(boxes, row, {row + 1, ends[row]}, lookup, pairs);
}

inline constexpr OverlapKernels kKernels = {testTile, sweep};
