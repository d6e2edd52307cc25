// Which worker takes which cells.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace broadmark::tracy {

/// Contiguous shares of a list of cells, all with about the same work. Fixed shares rather than a
/// common queue: who does what, and so the memory that each needs, is the same in every run.
class CellShares {
 public:
  void resize(std::size_t workers) { first_cells_.resize(workers + 1); }

  /// `total` is the sum of cost(i) over the places [0, cells) in the list.
  template <class Cost>
  void shareOut(std::size_t cells, Cost cost, std::uint64_t total) {
    const std::size_t workers = first_cells_.size() - 1;
    const std::uint64_t each = total / workers + 1;
    std::size_t cell = 0;
    std::uint64_t done = 0;
    for (std::size_t worker = 0; worker < workers; ++worker) {
      first_cells_[worker] = cell;
      for (; cell < cells && done < each * (worker + 1); ++cell) done += cost(cell);
    }
    first_cells_.back() = cells;
  }

  /// Calls visit(i) for the places in the list of a worker's share.
  template <class Visit>
  void forEachIndex(int worker, Visit visit) const {
    const auto first = first_cells_.begin() + worker;
    for (std::size_t i = first[0]; i < first[1]; ++i) visit(i);
  }

 private:
  std::vector<std::size_t> first_cells_;  ///< of each worker's share, and the end of the last
};

}  // namespace broadmark::tracy
