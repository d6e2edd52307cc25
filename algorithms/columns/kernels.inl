// The kernels of the columns, written once; compiled for each instruction set by for_each_isa.inl.
//
// Boxes into steps: a vector of boxes at once. What is made of the steps is a plain loop over
// arrays, which compilers turn into vectors by themselves.
//
// The sweep: a vector of rows is tested at once against what lies one place behind each of them,
// two places, and so on: neighbours have nearly the same windows, so that a vector of rows has one
// badly predicted end of a loop. Nothing else branches: hits are always written, and counted only
// if there are any.

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
  const MarkedBody mark_a = axisMark(scales.of[0].axis);
  const MarkedBody mark_b = axisMark(scales.of[1].axis);
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t low_a = block.low[0][k];
    const std::uint32_t low_b = block.low[1][k];
    const std::uint32_t high_a = block.high[0][k];
    const std::uint32_t high_b = block.high[1][k];
    // How many columns it goes on for. Then its last step in this one is the last one there is.
    const std::uint32_t more_a = (high_a >> kBits) - (low_a >> kBits);
    const std::uint32_t more_b = (high_b >> kBits) - (low_b >> kBits);
    const bool on_a = more_a != 0;
    const bool on_b = more_b != 0;
    const std::uint32_t first_a = low_a & kLast;
    const std::uint32_t first_b = low_b & kLast;
    const std::uint32_t last_a = high_a & kLast;
    const std::uint32_t last_b = high_b & kLast;
    const std::uint32_t column = (low_b >> kBits) * columns_in_row + (low_a >> kBits);
    block.columns[k] = column;
    block.keys[k] = columns::keyOf(first_a, first_b, on_a ? kLast : last_a, on_b ? kLast : last_b);
    block.crossed[k] = more_a + more_b;
    // If it crosses one side: on the first axis, or else on the second.
    block.next_columns[k] = column + (on_a ? 1 : columns_in_row);
    block.next_keys[k] = columns::keyOf(on_a ? 0 : first_a, on_a ? first_b : 0, last_a, last_b);
    block.next_bodies[k] = bodies[k] | (on_a ? mark_a : mark_b);
  }
  for (std::size_t k = 0; k < count; ++k) {
    block.copies[k] = {block.first[k], ~block.last[k], block.keys[k], bodies[k]};
  }
  for (std::size_t word = 0; word < columns::BoxBlock::kBoxes / 64; ++word) {
    std::uint64_t none = 0;
    std::uint64_t one = 0;
    for (std::size_t bit = 0; bit < 64; bit += kLanes) {
      const Keys crossed = loadKeys(block.crossed + 64 * word + bit);
      none |= std::uint64_t{equal(crossed, broadcastKey(0))} << bit;
      one |= std::uint64_t{equal(crossed, broadcastKey(1))} << bit;
    }
    const std::size_t before = 64 * word;
    const std::size_t here = count <= before ? 0 : count - before;
    const std::uint64_t all = here >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << here) - 1;
    block.cross_one[word] = one & all;
    block.cross_more[word] = ~(none | one) & all;
  }
}

void copyPastCaches(const Aabb* boxes, std::size_t count, Aabb* to) {
  constexpr std::size_t kFloats = 8;  // in a box
  const auto* const from = reinterpret_cast<const float*>(boxes);
  auto* const target = reinterpret_cast<float*>(to);
  const std::size_t whole = kFloats * count / kLanes * kLanes;
  for (std::size_t i = 0; i < whole; i += kLanes) {
    storePastCaches(target + i, loadFromAnywhere(from + i));
  }
  for (std::size_t i = whole; i < kFloats * count; ++i) target[i] = from[i];
}

/// Which lane and which step a bit of hits is of.
constexpr std::size_t laneOf(std::size_t bit) {
  return bit / (kHitLanes * kHitSteps) * kHitLanes + bit % kHitLanes;
}
constexpr std::size_t stepOf(std::size_t bit) { return bit / kHitLanes % kHitSteps; }

/// The place of a hit: see columns::HitSink.
constexpr std::uint64_t placeOf(std::size_t row, std::size_t distance) {
  return std::uint64_t{row} | std::uint64_t{distance} << 32;
}

void sweep(const std::uint32_t* keys, const std::uint32_t* ends, Range rows,
           columns::HitSink& sink) {
  // So far rows go together before those are counted that are to go on.
  constexpr std::size_t kStretch = 32;
  static_assert(kStretch / kHitSteps <= columns::HitSink::kRoom);
  std::uint64_t* const places = sink.places();
  std::uint64_t* const bits = sink.bits();
  for (std::size_t row = rows.begin; row < rows.end; row += kLanes) {
    const Keys limits = limitsOf(loadKeys(keys + row));
    Keys left = loadKeys(ends + row) - lanesFrom(static_cast<std::uint32_t>(row + 1));
    std::size_t distance = 1;
    while (positive(left) != 0) {
      std::size_t hits = sink.room();
      const std::size_t stop = distance + kStretch;
      while (distance < stop && positive(left) != 0) {
        const std::uint64_t found = hitsOfSteps(keys + row + distance, limits, left);
        places[hits] = placeOf(row, distance);
        bits[hits] = found;
        hits += found != 0 ? 1 : 0;
        left -= std::uint32_t{kHitSteps};
        distance += kHitSteps;
      }
      sink.advance(hits);
    }
  }
}

#if defined(BROADMARK_AVX512)
#include "columns/take_pairs_avx512.inl"
#else
#include "columns/take_pairs.inl"
#endif

inline constexpr columns::Kernels kKernels = {findSteps, copyPastCaches, sweep, takePairs};
