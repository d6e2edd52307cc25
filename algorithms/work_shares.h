// Shares a triangle of tests out over a team, by work and not by number of rows.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "broadmark/execution.h"
#include "simd/overlap_kernels.h"

namespace broadmark {

/// Row i is tested against the columns (i, ends[i]). Shares are contiguous and fixed by `ends` and
/// the size of the team alone. Workers get whole chunks of rows, also in crowded parts.
class RowShares {
 public:
  void measure(std::span<const std::uint32_t> ends, ThreadTeam& team) {
    rows_ = ends.size();
    workers_ = team.size();
    work_.resize((rows_ + kChunk - 1) / kChunk);
    team.run(work_.size(), [&](int, Range chunks) {
      for (std::size_t chunk = chunks.begin; chunk < chunks.end; ++chunk) {
        const std::size_t rows_end = std::min(rows_, (chunk + 1) * kChunk);
        std::uint64_t work = 0;
        for (std::size_t i = chunk * kChunk; i < rows_end; ++i) work += ends[i] - i;
        work_[chunk] = work;
      }
    });
    std::inclusive_scan(work_.begin(), work_.end(), work_.begin());
  }

  /// The rows of one worker: all have about the same work.
  [[nodiscard]] Range rowsOf(int worker) const {
    return {firstRow(worker), worker + 1 == workers_ ? rows_ : firstRow(worker + 1)};
  }

 private:
  static constexpr std::size_t kChunk = 64;  ///< rows whose work is summed up together

  [[nodiscard]] std::size_t firstRow(int worker) const {
    const std::uint64_t total = work_.empty() ? 0 : work_.back();
    const std::uint64_t before =
        total / static_cast<std::uint64_t>(workers_) * static_cast<std::uint64_t>(worker);
    const auto chunk = std::ranges::upper_bound(work_, before) - work_.begin();
    return std::min(static_cast<std::size_t>(chunk) * kChunk, rows_);
  }

  std::size_t rows_ = 0;
  int workers_ = 1;
  std::vector<std::uint64_t> work_;  ///< tests up to and with each chunk
};

}  // namespace broadmark
