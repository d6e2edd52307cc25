// Divides items among a team by their work instead of their number.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "broadmark/execution.h"

namespace broadmark {

/// Shares are contiguous, and depend only on the work and the size of the team: so each worker
/// needs the same memory in every run.
class WorkShares {
 public:
  /// Item i of `count` takes work_of(i). Workers get whole chunks of items.
  template <class WorkOf>
  void measure(std::size_t count, std::size_t chunk, WorkOf work_of, ThreadTeam& team) {
    count_ = count;
    chunk_ = chunk;
    workers_ = team.size();
    work_.resize((count + chunk - 1) / chunk);
    team.run(work_.size(), [&](int, Range chunks) {
      for (std::size_t k = chunks.begin; k < chunks.end; ++k) {
        const std::size_t end = std::min(count, (k + 1) * chunk);
        std::uint64_t work = 0;
        for (std::size_t i = k * chunk; i < end; ++i) work += work_of(i);
        work_[k] = work;
      }
    });
    std::inclusive_scan(work_.begin(), work_.end(), work_.begin());
  }
  /// Rows, of which row i is tested against the columns (i, ends[i]).
  void measureRows(std::span<const std::uint32_t> ends, ThreadTeam& team) {
    constexpr std::size_t kRows = 64;
    measure(ends.size(), kRows, [&](std::size_t i) { return ends[i] - i; }, team);
  }

  /// The items of one worker: all shares have about the same work.
  [[nodiscard]] Range of(int worker) const {
    return {firstOf(worker), worker + 1 == workers_ ? count_ : firstOf(worker + 1)};
  }

 private:
  [[nodiscard]] std::size_t firstOf(int worker) const {
    const std::uint64_t total = work_.empty() ? 0 : work_.back();
    const std::uint64_t before =
        total / static_cast<std::uint64_t>(workers_) * static_cast<std::uint64_t>(worker);
    const auto chunk = std::ranges::upper_bound(work_, before) - work_.begin();
    return std::min(static_cast<std::size_t>(chunk) * chunk_, count_);
  }

  std::size_t count_ = 0;
  std::size_t chunk_ = 1;
  int workers_ = 1;
  std::vector<std::uint64_t> work_;  ///< prefix sums over chunks, inclusive
};

}  // namespace broadmark
