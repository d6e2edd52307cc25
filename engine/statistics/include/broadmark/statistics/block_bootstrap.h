// How sure a statistic of a series is, where neighbours in the series may resemble each other.
#pragma once

#include <algorithm>
#include <cstddef>
#include <random>
#include <span>
#include <vector>

#include "broadmark/statistics/statistics.h"

namespace broadmark {

/// 95 % interval around `estimate`, which is `statistic` of all `count` values, by a percentile
/// bootstrap of circular blocks (Politis and Romano, 1992). `block` values stay together.
/// `statistic` is called with the places of the values drawn. The interval is widened as Student's
/// t is when there are few blocks. The same values give the same interval.
template <class Statistic>
Interval blockBootstrap95(std::size_t count, std::size_t block, double estimate,
                          Statistic&& statistic) {
  constexpr int kResamples = 500;
  std::mt19937_64 random;
  std::uniform_int_distribution<std::size_t> starts(0, count - 1);
  std::vector<double> resampled(kResamples);
  std::vector<std::size_t> drawn(count);
  for (double& one : resampled) {
    for (std::size_t i = 0; i < count;) {
      std::size_t from = starts(random);
      for (std::size_t k = 0; k < block && i < count; ++k, ++i, ++from) drawn[i] = from % count;
    }
    one = statistic(std::span<const std::size_t>(drawn));
  }
  // A few blocks know less than resampling them says, as a few values do (Student).
  const double blocks = static_cast<double>(count) / static_cast<double>(block);
  const double widen = studentT975(std::max(blocks - 1, 1.0)) / 1.96;
  return {estimate + widen * (quantile(resampled, 0.025) - estimate),
          estimate + widen * (quantile(resampled, 0.975) - estimate)};
}

/// The length of blocks for a series that is judged by these values' mean: as blockLength() says,
/// but never short, since in short series likeness hides in the noise.
std::size_t safeBlockLength(std::span<const double> values);

}  // namespace broadmark
