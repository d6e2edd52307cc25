// The sweep of cells of the grids, for columns that are much like one.

#include "columns/dense_sweep.h"

#include <cstddef>

namespace broadmark::columns {

bool DenseSweep::pays(const Sorted& column) {
  constexpr std::size_t kTests = 256;
  // From this part of hits on, by the times of both sweeps.
  constexpr std::size_t kHits = kTests / 8;
  std::size_t hits = 0;
  for (std::size_t test = 0; test < kTests; ++test) {
    const std::size_t i = test * column.size / kTests;
    const std::size_t behind = column.ends[i] - i;
    const std::size_t j = i + test * 97 % behind;  // somewhere in its window
    const Copy& a = column.copies[i];
    const Copy& b = column.copies[j];
    hits += std::size_t{j > i && overlapInSteps(a, b)};
  }
  return hits >= kHits;
}

void DenseSweep::begin(const Sorted& column, const Aabb* boxes) {
  ends_ = column.ends.data();
  arrays_.resize(column.size);
  bodies_.resize(column.size);
  for (std::size_t i = 0; i < column.size; ++i) {
    bodies_[i] = column.copies[i].body;
    arrays_.set(i, boxes[bodyNumber(bodies_[i])]);
  }
}

void DenseSweep::sweep(const OverlapKernels& kernels, Range rows, PairBuffer& pairs) const {
  kernels.sweep_cells(arrays_, ends_, bodies_.data(), rows, pairs);
}

}  // namespace broadmark::columns
