// Speed-up of several threads over one. The cores of a virtual machine may be SMT siblings, or
// shared with another guest for tens of milliseconds: code then takes up to twice as long, without
// an indication. So a plain loop is timed before and after each round, and rounds in which its
// threads slowed each other are discarded.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/contest.h"
#include "benchmarks/stopwatch.h"
#include "broadmark/execution.h"

namespace broadmark::benchmarks {

/// Detects whether cores are whole, that is, not shared.
class WholeCores {
 public:
  explicit WholeCores(int cores) : team_(cores) {}

  /// Whether a loop takes no longer on all cores at once than on a single core.
  bool areWhole() {
    constexpr double kMaxRatio = 1.06;
    const double single = nanosecondsOf([] { spin(); });
    return nanosecondsOf([&] { team_.run([](int) { spin(); }); }) <= kMaxRatio * single;
  }

 private:
  /// A millisecond of independent multiplications and additions, which saturate a core: two such
  /// loops on SMT siblings take twice as long.
  static void spin() {
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

/// Medians, minimum and maximum gain over the rounds with whole cores; NaN if there were none.
struct ThreadGain {
  double one_ms = std::numeric_limits<double>::quiet_NaN();
  double several_ms = one_ms;
  double median = one_ms;
  double min = one_ms;
  double max = one_ms;
  std::size_t rounds = 0;
  int all_rounds = 0;  ///< including the discarded ones
};

/// The gain of an algorithm over `wanted` rounds with whole cores, or ten times as many in total.
inline ThreadGain gainOfThreads(const std::string& id, int threads,
                                std::span<const std::vector<Aabb>> frames, int wanted) {
  WholeCores cores(threads);
  Contest contest(id, frames);
  contest.add("one", caseOf(id, AnswerKind::pairs, 1));
  contest.add("several", caseOf(id, AnswerKind::pairs, threads));
  ThreadGain gain;
  std::vector<double> one_ms;
  std::vector<double> several_ms;
  std::vector<double> gains;
  for (; gain.all_rounds < 10 * wanted && std::cmp_less(gains.size(), wanted); ++gain.all_rounds) {
    const bool whole_before = cores.areWhole();
    contest.run(1);
    if (!cores.areWhole() || !whole_before) continue;
    one_ms.push_back(contest.find("one").milliseconds.back());
    several_ms.push_back(contest.find("several").milliseconds.back());
    gains.push_back(one_ms.back() / several_ms.back());
  }
  gain.rounds = gains.size();
  if (gains.empty()) return gain;
  const auto [min, max] = std::ranges::minmax(gains);
  gain.one_ms = quantile(one_ms, 0.5);
  gain.several_ms = quantile(several_ms, 0.5);
  gain.median = quantile(gains, 0.5);
  gain.min = min;
  gain.max = max;
  return gain;
}

}  // namespace broadmark::benchmarks
