// The overlap kernels; for_each_isa.inl compiles this file for each instruction set.

#include "simd/overlap_tests.inl"

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
#if defined(BROADMARK_STORES_PAIRS)
  RowHits rowHits(unsigned lanes, std::size_t i, std::size_t column) const {
    return {lanes, static_cast<std::uint32_t>(i), iotaFrom(static_cast<std::uint32_t>(column))};
  }
#endif
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
#if defined(BROADMARK_STORES_PAIRS)
  RowHits rowHits(unsigned lanes, std::size_t i, std::size_t column) const {
    const Keys others = loadSelected(bodies + column, lanes);
    const unsigned home = equal(others & broadcastKey(bodies[i] & ~kBodyIdMask), Keys{});
    return {lanes & home, bodyId(bodies[i]), others & broadcastKey(kBodyIdMask)};
  }
#endif
};

void testTile(const BoxArrays& boxes, Range rows, Range columns, PairBuffer& pairs) {
  const Tile tile{columns};
  std::size_t row = rows.begin;
  for (; row + kRows <= rows.end; row += kRows) {
    testRows<0, kRows>(boxes, row, tile.after(row), tile, pairs);
  }
  for (; row < rows.end; ++row) testRows<0, 1>(boxes, row, tile.after(row), tile, pairs);
}

void sweepCells(const BoxArrays& boxes, const std::uint32_t* ends, const CellBody* bodies,
                Range rows, PairBuffer& pairs) {
  sweepWindows<0>(boxes, ends, rows, CellWindows{ends, bodies}, pairs);
}

inline constexpr OverlapKernels kKernels = {kLanes, testTile, sweepCells};
