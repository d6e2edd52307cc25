// The kernels of the columns, written once; compiled for each instruction set by for_each_isa.inl.
//
// Boxes into steps: a vector of boxes at once. What is made of the steps is a plain loop over
// arrays, which compilers turn into vectors by themselves.
//
// The sweep: neighbours have nearly the same windows. So a group of rows is tested at once against
// what their windows span together: a vector of columns is loaded once for all of them, and there
// is one badly predicted end of a loop instead of many. Nothing else branches: hits are always
// written, and counted only if there are any.

/// The steps of kLanes boxes, from box k of the block on.
inline void findStepsOf(const float* bounds, std::size_t k, const columns::StepScales& scales,
                        columns::BoxBlock& block) {
  Vector min[3];
  Vector max[3];
  loadCorners(bounds, min);
  loadCorners(bounds + 4, max);
  const columns::StepScale& sweep = scales.sweep;
  storeSteps(min[sweep.axis], sweep.low, sweep.factor, sweep.last, block.first + k);
  storeSteps(max[sweep.axis], sweep.low, sweep.factor, sweep.last, block.last + k);
  for (int which = 0; which < 2; ++which) {
    const columns::StepScale& scale = scales.of[which];
    storeSteps(min[scale.axis], scale.low, scale.factor, scale.last, block.low[which] + k);
    storeSteps(max[scale.axis], scale.low, scale.factor, scale.last, block.high[which] + k);
  }
}

void findSteps(const Aabb* boxes, const MarkedBody* bodies, std::size_t count,
               const columns::StepScales& scales, columns::BoxBlock& block) {
  constexpr std::uint32_t kLast = columns::Layout::kLastStep;
  constexpr int kBits = columns::Layout::kStepBits;
  const auto* const bounds = reinterpret_cast<const float*>(boxes);
  constexpr std::size_t kFloats = 8;  // in a box
  const std::size_t whole = count / kLanes * kLanes;
  for (std::size_t k = 0; k < whole; k += kLanes) {
    findStepsOf(bounds + kFloats * k, k, scales, block);
  }
  if (whole < count) {  // behind the last box there is nothing that could be loaded
    float rest[kFloats * kLanes] = {};
    for (std::size_t i = 0; i < kFloats * (count - whole); ++i) {
      rest[i] = bounds[kFloats * whole + i];
    }
    findStepsOf(rest, whole, scales, block);
  }
  const std::uint32_t columns_in_row = scales.columns_in_row;
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t low_a = block.low[0][k];
    const std::uint32_t low_b = block.low[1][k];
    const std::uint32_t high_a = block.high[0][k];
    const std::uint32_t high_b = block.high[1][k];
    // How many columns it goes on for. Then its last step in this one is the last one there is.
    const std::uint32_t more_a = (high_a >> kBits) - (low_a >> kBits);
    const std::uint32_t more_b = (high_b >> kBits) - (low_b >> kBits);
    const std::uint32_t goes_on_a = more_a != 0 ? kLast : 0;
    const std::uint32_t goes_on_b = more_b != 0 ? kLast : 0;
    block.keys[k] = columns::keyOf(low_a & kLast, low_b & kLast, (high_a & kLast) | goes_on_a,
                                   (high_b & kLast) | goes_on_b);
    block.columns[k] = (low_b >> kBits) * columns_in_row + (low_a >> kBits);
    static_assert(columns::kFirstAxis == 1 && columns::kSecondAxis == 2);
    const bool simple = more_a + more_b <= 1;
    block.crossing[k] = simple ? more_a + 2 * more_b : columns::kOtherwise;
  }
  for (std::size_t k = 0; k < count; ++k) {
    block.copies[k] = {block.first[k], block.last[k], block.keys[k], bodies[k]};
  }
}

/// Which row and which lane a bit of hits is of.
constexpr std::size_t rowOf(std::size_t bit) { return bit / kHitLanes % kHitRows; }
constexpr std::size_t laneOf(std::size_t bit) {
  return bit / (kHitLanes * kHitRows) * kHitLanes + bit % kHitLanes;
}

/// Tests a group of rows against columns from `begin` until `end` is reached. Of the first vector
/// of columns only the hits `first` count, of the others the hits `others`.
inline void sweepRows(const std::uint32_t* keys, const Keys (&limits)[kHitRows],
                      const Keys (&ends)[kHitRows], std::size_t row, std::size_t begin,
                      std::size_t end, columns::HitSink& sink, std::uint64_t first,
                      std::uint64_t others) {
  std::uint64_t wanted = first;
  Keys positions = lanesFrom(static_cast<std::uint32_t>(begin));
  for (std::size_t column = begin; column < end;) {
    columns::Hits* hits = sink.room();
    const std::size_t room_end = column + columns::HitSink::kRoom * kLanes;
    const std::size_t stop = end < room_end ? end : room_end;
    for (; column < stop; column += kLanes) {
      const std::uint64_t found =
          hitsOfRows(loadKeys(keys + column), positions, limits, ends) & wanted;
      positions = movedOn(positions);
      wanted = others;
      hits->row = static_cast<std::uint32_t>(row);
      hits->column = static_cast<std::uint32_t>(column);
      hits->bits = found;
      hits += found != 0 ? 1 : 0;
    }
    sink.advance(hits);
  }
}

/// Of the hits of a group with the vector right behind its first row: those of columns behind their
/// row. The others are found twice, or are of a row with itself.
constexpr std::uint64_t behindRows() {
  std::uint64_t wanted = 0;
  for (std::size_t bit = 0; bit < kHitRows * kLanes; ++bit) {
    if (laneOf(bit) >= rowOf(bit)) wanted |= std::uint64_t{1} << bit;
  }
  return wanted;
}

/// All hits of a row of a group.
constexpr std::uint64_t hitsOfRow(std::size_t row) {
  std::uint64_t wanted = 0;
  for (std::size_t bit = 0; bit < kHitRows * kLanes; ++bit) {
    if (rowOf(bit) == row) wanted |= std::uint64_t{1} << bit;
  }
  return wanted;
}

void sweep(const std::uint32_t* keys, const std::uint32_t* ends, Range rows,
           columns::HitSink& sink) {
  // Windows that differ by more are tested row by row where they do.
  constexpr std::size_t kFar = 64;
  constexpr std::size_t kMost = columns::Kernels::kSweptRows;
  constexpr std::uint64_t kAll = ~std::uint64_t{0};
  std::uint32_t limits[kMost];
  for (std::size_t r = 0; r < kMost; ++r) limits[r] = columns::limitsOf(keys[rows.begin + r]);
  for (std::size_t row = rows.begin; row < rows.end; row += kHitRows) {
    Keys group_limits[kHitRows];
    Keys group_ends[kHitRows];
    std::size_t farthest = 0;
    for (std::size_t r = 0; r < kHitRows; ++r) {
      group_limits[r] = broadcastKey(limits[row - rows.begin + r]);
      group_ends[r] = broadcastKey(ends[row + r]);
      farthest = farthest > ends[row + r] ? farthest : ends[row + r];
    }
    const std::size_t begin = row + 1;
    std::size_t common = farthest;
    if (farthest > begin + kFar) [[unlikely]] {
      std::size_t nearest = farthest;
      for (std::size_t r = 0; r < kHitRows; ++r) {
        nearest = nearest < ends[row + r] ? nearest : ends[row + r];
      }
      if (nearest < begin) nearest = begin;
      if (farthest - nearest > kFar) common = begin + (nearest - begin) / kLanes * kLanes;
    }
    sweepRows(keys, group_limits, group_ends, row, begin, common, sink, behindRows(), kAll);
    if (common == farthest) [[likely]]
      continue;
    for (std::size_t r = 0; r < kHitRows; ++r) {
      const std::uint64_t of_row = hitsOfRow(r);
      sweepRows(keys, group_limits, group_ends, row, common, ends[row + r], sink, of_row, of_row);
    }
  }
}

inline constexpr columns::Kernels kKernels = [] {
  columns::Kernels kernels = {{}, {}, findSteps, sweep};
  for (std::size_t bit = 0; bit < 64; ++bit) {
    kernels.row_of[bit] = static_cast<std::uint8_t>(rowOf(bit));
    kernels.lane_of[bit] = static_cast<std::uint8_t>(laneOf(bit));
  }
  return kernels;
}();
