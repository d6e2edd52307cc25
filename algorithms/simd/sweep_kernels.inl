// The sweep kernels; for_each_isa.inl compiles this file for each instruction set.

#include "simd/overlap_tests.inl"

// Policies: see overlap_kernels.inl.

/// A window per row; bodies are sorted.
struct Windows {
  const std::uint32_t* ends;
  const std::uint32_t* bodies;

  std::size_t endOf(std::size_t i) const { return ends[i]; }
  bool isReported(std::size_t, std::size_t) const { return true; }
  Pair pair(std::size_t i, std::size_t j) const { return orderedPair(bodies[i], bodies[j]); }
#if defined(BROADMARK_STORES_PAIRS)
  RowHits rowHits(unsigned lanes, std::size_t i, std::size_t column) const {
    return {lanes, bodies[i], loadSelected(bodies + column, lanes)};
  }
#endif
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

void sweep(const BoxArrays& boxes, const std::uint32_t* ends, const std::uint32_t* bodies,
           Range rows, PairBuffer& pairs) {
  sweepWindows<1>(boxes, ends, rows, Windows{ends, bodies}, pairs);
}

void testRow(const BoxArrays& boxes, std::size_t row, CellBody body, Range columns,
             const CellBody* bodies, PairBuffer& pairs) {
  testRows<0, 1>(boxes, row, columns, CellRow{body, columns.end, bodies}, pairs);
}

inline constexpr SweepKernels kKernels = {sweep, testRow};
