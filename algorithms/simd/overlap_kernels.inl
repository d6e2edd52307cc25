// The overlap kernels; for_each_isa.inl compiles this file for each instruction set.
//
// A few rows are tested against the same vector of columns: it is loaded once, and as hits are
// rare, one branch suffices for all rows.

/// Rows tested at once: their bounds, six each, and six of the columns fit in 32 registers.
inline constexpr std::size_t kRows = 4;

inline std::size_t roundedDown(std::size_t position) { return position / kLanes * kLanes; }
inline std::size_t roundedUp(std::size_t position) { return roundedDown(position + kLanes - 1); }
inline std::size_t larger(std::size_t a, std::size_t b) { return a > b ? a : b; }
inline std::size_t smaller(std::size_t a, std::size_t b) { return a < b ? a : b; }

// Policies: which columns a row is paired with, and the bodies at rows and columns.

/// The columns of the triangle i < j; body ids are positions.
struct Tile {
  Range columns;

  Range after(std::size_t i) const { return {larger(columns.begin, i + 1), columns.end}; }
  std::size_t endOf(std::size_t) const { return columns.end; }
  bool isReported(std::size_t, std::size_t) const { return true; }
  Pair pair(std::size_t i, std::size_t j) const {
    return {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)};
  }
};

/// A window per row; bodies are sorted.
struct Windows {
  const std::uint32_t* ends;
  const std::uint32_t* bodies;

  std::size_t endOf(std::size_t i) const { return ends[i]; }
  bool isReported(std::size_t, std::size_t) const { return true; }
  Pair pair(std::size_t i, std::size_t j) const { return orderedPair(bodies[i], bodies[j]); }
};

/// A window per row, within a cell.
struct CellWindows {
  const std::uint32_t* ends;
  const CellBody* bodies;

  std::size_t endOf(std::size_t i) const { return ends[i]; }
  bool isReported(std::size_t i, std::size_t j) const {
    return isHomeCellPair(bodies[i], bodies[j]);
  }
  Pair pair(std::size_t i, std::size_t j) const {
    return orderedPair(bodyId(bodies[i]), bodyId(bodies[j]));
  }
};

/// One body of a cell against columns of it.
struct CellRow {
  CellBody body;
  std::size_t end;
  const CellBody* bodies;

  std::size_t endOf(std::size_t) const { return end; }
  bool isReported(std::size_t, std::size_t j) const { return isHomeCellPair(body, bodies[j]); }
  Pair pair(std::size_t, std::size_t j) const {
    return orderedPair(bodyId(body), bodyId(bodies[j]));
  }
};

/// Adds the pairs of the set bits: bit r * kLanes + l stands for row + r and column + l. Drops
/// those outside the row's columns, which whole vectors include.
template <class Policy>
void addHits(std::uint64_t hits, std::size_t row, std::size_t column, std::size_t begin,
             const Policy& policy, PairBuffer& pairs) {
  Pair* const room = pairs.room(kRows * kLanes);
  std::size_t count = 0;
  for (; hits != 0; hits &= hits - 1) {
    const auto bit = static_cast<std::size_t>(__builtin_ctzll(hits));
    const std::size_t i = row + bit / kLanes;
    const std::size_t j = column + bit % kLanes;
    room[count] = policy.pair(i, j);
    count += (j > i) & (j >= begin) & (j < policy.endOf(i)) & policy.isReported(i, j);
  }
  pairs.advance(count);
}

/// Tests the boxes [row, row + kCount) against `columns` on the axes from kFirstAxis on.
template <int kFirstAxis, std::size_t kCount, class Policy>
void testRows(const BoxArrays& boxes, std::size_t row, Range columns, const Policy& policy,
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

  // Whole, aligned vectors; addHits() drops the excess lanes.
  for (std::size_t column = roundedDown(columns.begin); column < columns.end; column += kLanes) {
    Mask hits[kCount];
    for (int axis = kFirstAxis; axis < 3; ++axis) {
      const Vector column_min = load(min[axis] + column);
      const Vector column_max = load(max[axis] + column);
      for (std::size_t r = 0; r < kCount; ++r) {
        const Vector low = row_min[axis][r];
        const Vector high = row_max[axis][r];
        hits[r] = axis == kFirstAxis ? overlap(low, high, column_min, column_max)
                                     : overlap(hits[r], low, high, column_min, column_max);
      }
    }
    Mask any = hits[0];
    for (std::size_t r = 1; r < kCount; ++r) any = maskOr(any, hits[r]);
    if (none(any)) [[likely]]
      continue;
    std::uint64_t all = 0;
    for (std::size_t r = 0; r < kCount; ++r) all |= std::uint64_t{bits(hits[r])} << (r * kLanes);
    addHits(all, row, column, columns.begin, policy, pairs);
  }
}

void testTile(const BoxArrays& boxes, Range rows, Range columns, PairBuffer& pairs) {
  const Tile tile{columns};
  std::size_t row = rows.begin;
  for (; row + kRows <= rows.end; row += kRows) {
    testRows<0, kRows>(boxes, row, tile.after(row), tile, pairs);
  }
  for (; row < rows.end; ++row) testRows<0, 1>(boxes, row, tile.after(row), tile, pairs);
}

/// Tests every row against its window (row, ends[row]) on the axes from kFirstAxis on.
template <int kFirstAxis, class Policy>
void sweepWindows(const BoxArrays& boxes, const std::uint32_t* ends, Range rows,
                  const Policy& policy, PairBuffer& pairs) {
  std::size_t row = rows.begin;
  for (; row + kRows <= rows.end; row += kRows) {
    // The common part of the windows for all rows at once, then the rest row by row.
    std::size_t common = ends[row];
    for (std::size_t r = 1; r < kRows; ++r) common = smaller(common, ends[row + r]);
    common = roundedUp(common);
    testRows<kFirstAxis, kRows>(boxes, row, {row + 1, common}, policy, pairs);
    for (std::size_t r = row; r < row + kRows; ++r) {
      if (ends[r] > common) testRows<kFirstAxis, 1>(boxes, r, {common, ends[r]}, policy, pairs);
    }
  }
  for (; row < rows.end; ++row) {
    testRows<kFirstAxis, 1>(boxes, row, {row + 1, ends[row]}, policy, pairs);
  }
}

void sweep(const BoxArrays& boxes, const std::uint32_t* ends, const std::uint32_t* bodies,
           Range rows, PairBuffer& pairs) {
  sweepWindows<1>(boxes, ends, rows, Windows{ends, bodies}, pairs);
}

void sweepCells(const BoxArrays& boxes, const std::uint32_t* ends, const CellBody* bodies,
                Range rows, PairBuffer& pairs) {
  sweepWindows<0>(boxes, ends, rows, CellWindows{ends, bodies}, pairs);
}

void testRow(const BoxArrays& boxes, std::size_t row, CellBody body, Range columns,
             const CellBody* bodies, PairBuffer& pairs) {
  testRows<0, 1>(boxes, row, columns, CellRow{body, columns.end, bodies}, pairs);
}

inline constexpr OverlapKernels kKernels = {kLanes, testTile, sweep, sweepCells, testRow};
