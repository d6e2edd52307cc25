// The kernels of columns; for_each_isa.inl compiles this file for each instruction set.

/// Quantises kLanes boxes into the block, from its box k on.
inline void quantizeVector(const float* bounds, std::size_t k,
                           const columns::Quantizers& quantizers, columns::BoxBlock& block) {
  Vector min[3];
  Vector max[3];
  loadCorners(bounds, min);
  loadCorners(bounds + 4, max);
  const columns::Quantizer& sweep = quantizers.sweep;
  storeQuantized(min[sweep.axis], sweep.origin, sweep.scale, sweep.max, block.sweep_min + k);
  storeQuantized(max[sweep.axis], sweep.origin, sweep.scale, sweep.max, block.sweep_max + k);
  for (int i = 0; i < 2; ++i) {
    const columns::Quantizer& cut = quantizers.cut[i];
    storeQuantized(min[cut.axis], cut.origin, cut.scale, cut.max, block.cut_min[i] + k);
    storeQuantized(max[cut.axis], cut.origin, cut.scale, cut.max, block.cut_max[i] + k);
  }
}

/// Vectors of boxes are quantised; the rest are plain loops over arrays, which compilers vectorise.
void quantizeBoxes(const Aabb* boxes, const CellBody* bodies, std::size_t count,
                   const columns::Quantizers& quantizers, columns::BoxBlock& block) {
  constexpr std::uint32_t kMax = columns::Layout::kMaxCoord;
  constexpr int kBits = columns::Layout::kCoordBits;
  const auto* const bounds = reinterpret_cast<const float*>(boxes);
  constexpr std::size_t kFloats = 8;  // in a box
  const std::size_t whole = count / kLanes * kLanes;
  for (std::size_t k = 0; k < whole; k += kLanes) {
    quantizeVector(bounds + kFloats * k, k, quantizers, block);
  }
  if (whole < count) {  // a whole vector would read beyond the last box
    float rest[kFloats * kLanes] = {};
    for (std::size_t i = 0; i < kFloats * (count - whole); ++i) {
      rest[i] = bounds[kFloats * whole + i];
    }
    quantizeVector(rest, whole, quantizers, block);
  }
  const std::uint32_t columns_per_row = quantizers.columns_per_row;
  const CellBody phantom_a = phantomBit(quantizers.cut[0].axis);
  const CellBody phantom_b = phantomBit(quantizers.cut[1].axis);
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t min_a = block.cut_min[0][k];
    const std::uint32_t min_b = block.cut_min[1][k];
    const std::uint32_t max_a = block.cut_max[0][k];
    const std::uint32_t max_b = block.cut_max[1][k];
    // Boundaries crossed. If any, the maximum in the home column is clamped to kMax.
    const std::uint32_t crossings_a = (max_a >> kBits) - (min_a >> kBits);
    const std::uint32_t crossings_b = (max_b >> kBits) - (min_b >> kBits);
    const bool cross_a = crossings_a != 0;
    const bool cross_b = crossings_b != 0;
    const std::uint32_t cut_min_a = min_a & kMax;
    const std::uint32_t cut_min_b = min_b & kMax;
    const std::uint32_t cut_max_a = max_a & kMax;
    const std::uint32_t cut_max_b = max_b & kMax;
    const std::uint32_t column = (min_b >> kBits) * columns_per_row + (min_a >> kBits);
    block.columns[k] = column;
    block.keys[k] = columns::keyOf(cut_min_a, cut_min_b, cross_a ? kMax : cut_max_a,
                                   cross_b ? kMax : cut_max_b);
    block.crossings[k] = crossings_a + crossings_b;
    // The second column, for boxes with one crossing: on axis a, or else on axis b.
    block.next_columns[k] = column + (cross_a ? 1 : columns_per_row);
    block.next_keys[k] =
        columns::keyOf(cross_a ? 0 : cut_min_a, cross_a ? cut_min_b : 0, cut_max_a, cut_max_b);
    block.next_bodies[k] = bodies[k] | (cross_a ? phantom_a : phantom_b);
  }
  for (std::size_t k = 0; k < count; ++k) {
    block.entries[k] = {block.sweep_min[k], ~block.sweep_max[k], block.keys[k], bodies[k]};
  }
  for (std::size_t word = 0; word < columns::BoxBlock::kBoxes / 64; ++word) {
    std::uint64_t cross_none = 0;
    std::uint64_t cross_one = 0;
    for (std::size_t bit = 0; bit < 64; bit += kLanes) {
      const Keys crossings = loadKeys(block.crossings + 64 * word + bit);
      cross_none |= std::uint64_t{equal(crossings, broadcastKey(0))} << bit;
      cross_one |= std::uint64_t{equal(crossings, broadcastKey(1))} << bit;
    }
    const std::size_t before = 64 * word;
    const std::size_t here = count <= before ? 0 : count - before;
    const std::uint64_t valid = here >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << here) - 1;
    block.cross_one[word] = cross_one & valid;
    block.cross_several[word] = ~(cross_none | cross_one) & valid;
  }
}

void streamCopy(const Aabb* boxes, std::size_t count, Aabb* target) {
  constexpr std::size_t kFloats = 8;  // in a box
  const auto* const from = reinterpret_cast<const float*>(boxes);
  auto* const to = reinterpret_cast<float*>(target);
  const std::size_t whole = kFloats * count / kLanes * kLanes;
  for (std::size_t i = 0; i < whole; i += kLanes) streamStore(to + i, loadUnaligned(from + i));
  for (std::size_t i = whole; i < kFloats * count; ++i) to[i] = from[i];
}

/// The lane and the offset of a bit in a mask of hits.
constexpr std::size_t laneOf(std::size_t bit) {
  return bit / (kHitLanes * kHitOffsets) * kHitLanes + bit % kHitLanes;
}
constexpr std::size_t offsetOf(std::size_t bit) { return bit / kHitLanes % kHitOffsets; }

/// The position of a hit: see columns::HitBuffer.
constexpr std::uint64_t positionOf(std::size_t row, std::size_t distance) {
  return std::uint64_t{row} | std::uint64_t{distance} << 32;
}

/// A vector of rows is tested against the entries at distance 1, at distance 2, and so on: windows
/// of neighbouring rows end nearly together, which leaves one mispredicted branch per vector of
/// rows.
void sweep(const std::uint32_t* keys, const std::uint32_t* ends, Range rows,
           columns::HitBuffer& hits) {
  constexpr std::size_t kBlock = 32;  // distances between two calls of reserve()
  static_assert(kBlock / kHitOffsets <= columns::HitBuffer::kReserve);
  std::uint64_t* const positions = hits.positions();
  std::uint64_t* const masks = hits.masks();
  for (std::size_t row = rows.begin; row < rows.end; row += kLanes) {
    const Keys limits = limitsOf(loadKeys(keys + row));
    Keys remaining = loadKeys(ends + row) - iotaFrom(static_cast<std::uint32_t>(row + 1));
    std::size_t distance = 1;
    while (positive(remaining) != 0) {
      std::size_t size = hits.reserve();
      const std::size_t stop = distance + kBlock;
      while (distance < stop && positive(remaining) != 0) {
        const std::uint64_t mask = hitsAtOffsets(keys + row + distance, limits, remaining);
        // Branchless: write unconditionally, advance only on a hit.
        positions[size] = positionOf(row, distance);
        masks[size] = mask;
        size += mask != 0 ? 1 : 0;
        remaining -= std::uint32_t{kHitOffsets};
        distance += kHitOffsets;
      }
      hits.setSize(size);
    }
  }
}

#if defined(BROADMARK_AVX512)
#include "columns/extract_pairs_avx512.inl"
#else
#include "columns/extract_pairs.inl"
#endif

inline constexpr columns::Kernels kKernels = {quantizeBoxes, streamCopy, sweep, extractPairs};
