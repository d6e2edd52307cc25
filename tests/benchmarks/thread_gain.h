// What several threads gain over one. The cores of a virtual machine are at times halves of one, or
// shared with another guest, for tens of milliseconds: whatever runs there takes up to twice as
// long, and nothing tells. So a plain loop is timed before and after, and rounds in which its
// threads got in each other's way are left out.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/contest.h"
#include "broadmark/execution.h"

namespace broadmark::benchmarks {

/// Tells whether cores are whole.
class WholeCores {
 public:
  explicit WholeCores(int cores) : team_(cores) {}

  /// Whether a loop takes no longer on all of them at once than on one alone.
  bool areWhole() {
    constexpr double kMost = 1.06;
    const double alone = msOf([] { turn(); });
    return msOf([&] { team_.run([](int) { turn(); }); }) <= kMost * alone;
  }

 private:
  template <class Work>
  static double msOf(Work work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
        .count();
  }
  /// A millisecond of independent multiplications and additions, which keep a core busy: two such
  /// loops on halves of one take twice as long.
  static void turn() {
    std::array<double, 24> sums;
    sums.fill(1);
    for (int i = 0; i < 250'000; ++i) {
      for (double& sum : sums) sum = sum * 1.0000001 + 1e-9;
    }
    static std::atomic<double> result;
    result = std::accumulate(sums.begin(), sums.end(), 0.0);
  }

  ThreadTeam team_;
};

/// Of the rounds in which cores were whole. Medians, and the least and the largest gain; no numbers
/// if there were none.
struct ThreadGain {
  double one_ms = std::numeric_limits<double>::quiet_NaN();
  double several_ms = one_ms;
  double median = one_ms;
  double least = one_ms;
  double most = one_ms;
  std::size_t rounds = 0;
  int all_rounds = 0;  ///< those with other cores, too
};

/// What an algorithm gains, in so many rounds with whole cores, or ten times as many of all kinds.
inline ThreadGain gainOfThreads(const std::string& id, int threads,
                                std::span<const std::vector<Aabb>> frames, int wanted) {
  WholeCores cores(threads);
  Contest contest(id, frames);
  contest.add("one", caseOf(id, AnswerKind::pairs, 1));
  contest.add("several", caseOf(id, AnswerKind::pairs, threads));
  ThreadGain gain;
  std::vector<double> one;
  std::vector<double> several;
  std::vector<double> gains;
  for (; gain.all_rounds < 10 * wanted && std::cmp_less(gains.size(), wanted); ++gain.all_rounds) {
    const bool whole_before = cores.areWhole();
    contest.run(1);
    if (!cores.areWhole() || !whole_before) continue;
    one.push_back(contest.find("one").milliseconds.back());
    several.push_back(contest.find("several").milliseconds.back());
    gains.push_back(one.back() / several.back());
  }
  gain.rounds = gains.size();
  if (gains.empty()) return gain;
  const auto [least, most] = std::ranges::minmax(gains);
  gain.one_ms = quantile(one, 0.5);
  gain.several_ms = quantile(several, 0.5);
  gain.median = quantile(gains, 0.5);
  gain.least = least;
  gain.most = most;
  return gain;
}

}  // namespace broadmark::benchmarks
