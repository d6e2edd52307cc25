// Tests of rows of boxes against columns, of which kernels are made.
//
// A few rows are tested against the same vector of columns: it is loaded once, and as hits are
// rare, one branch suffices for all rows. Hits are added one by one; where a vector has many, its
// pairs are stored by vectors (add_many_hits.inl), 2 to 6 times as fast.

/// Rows tested at once: their bounds, six each, and six of the columns fit in 32 registers.
inline constexpr std::size_t kRows = 4;

inline std::size_t roundedDown(std::size_t position) { return position / kLanes * kLanes; }
inline std::size_t roundedUp(std::size_t position) { return roundedDown(position + kLanes - 1); }
inline std::size_t larger(std::size_t a, std::size_t b) { return a > b ? a : b; }
inline std::size_t smaller(std::size_t a, std::size_t b) { return a < b ? a : b; }

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

#if defined(BROADMARK_STORES_PAIRS)
#include "simd/add_many_hits.inl"
#else
constexpr bool isManyHits(std::uint64_t) { return false; }
template <class Policy>
void addManyHits(std::uint64_t, std::size_t, std::size_t, std::size_t, const Policy&, PairBuffer&) {
}
#endif

/// The hits of some rows in the vector at `column`.
struct VectorHits {
  std::size_t column;
  std::uint64_t hits;
};

/// Vectors with many hits that are collected before their pairs are stored.
inline constexpr std::size_t kMaxVectors = 32;

/// Adds the hits of the boxes [row, row + kCount) in `columns` from `column` on, tested on the axes
/// from kFirstAxis on. Stores vectors with many hits to `many` instead, since a call within the
/// loop would move the rows out of their registers. Stops after kMaxVectors of these; moves
/// `column` to the next vector, and returns their number.
template <int kFirstAxis, std::size_t kCount, class Policy>
[[gnu::always_inline]] inline std::size_t testVectors(const BoxArrays& boxes, std::size_t row,
                                                      Range columns, std::size_t& column,
                                                      const Policy& policy, PairBuffer& pairs,
                                                      VectorHits* many) {
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

  std::size_t many_count = 0;
  std::size_t at = column;
  for (; at < columns.end; at += kLanes) {
    Mask hits[kCount];
    for (int axis = kFirstAxis; axis < 3; ++axis) {
      const Vector column_min = load(min[axis] + at);
      const Vector column_max = load(max[axis] + at);
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
    if (kCount == kRows && isManyHits(all)) [[unlikely]] {
      many[many_count++] = {at, all};
      if (many_count < kMaxVectors) continue;
      at += kLanes;
      break;
    }
    addHits(all, row, at, columns.begin, policy, pairs);
  }
  column = at;
  return many_count;
}

/// Tests the boxes [row, row + kCount) against `columns` on the axes from kFirstAxis on, in whole,
/// aligned vectors; the excess lanes are dropped.
template <int kFirstAxis, std::size_t kCount, class Policy>
void testRows(const BoxArrays& boxes, std::size_t row, Range columns, const Policy& policy,
              PairBuffer& pairs) {
  VectorHits many[kMaxVectors];
  for (std::size_t column = roundedDown(columns.begin); column < columns.end;) {
    const std::size_t count =
        testVectors<kFirstAxis, kCount>(boxes, row, columns, column, policy, pairs, many);
    if constexpr (kCount == kRows) {
      for (std::size_t k = 0; k < count; ++k) {
        addManyHits(many[k].hits, row, many[k].column, columns.begin, policy, pairs);
      }
    }
  }
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
