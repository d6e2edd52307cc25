// Statistics of timings.

#include "broadmark/statistics/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

namespace broadmark {
namespace {

double sortedQuantile(const std::vector<double>& sorted, double q) {
  if (sorted.empty()) return 0;
  const double rank = q * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], rank - static_cast<double>(below));
}

std::vector<double> sortedCopy(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  return sorted;
}

double squaredStandardError(std::span<const double> values) {
  const double deviation = standardDeviation(values);
  return deviation * deviation / static_cast<double>(values.size());
}

/// Autocovariance of values around `centre` at this lag.
double autocovariance(std::span<const double> values, double centre, std::size_t lag) {
  double sum = 0;
  for (std::size_t i = lag; i < values.size(); ++i) {
    sum += (values[i] - centre) * (values[i - lag] - centre);
  }
  return sum / static_cast<double>(values.size());
}

/// The last lag with a significant autocorrelation: the next few are all noise.
std::size_t lastSignificantLag(const std::vector<double>& covariances, std::size_t count) {
  const auto n = static_cast<double>(count);
  const double noise = 2 * std::sqrt(std::log10(n) / n) * covariances[0];
  constexpr std::size_t kRun = 5;
  std::size_t consecutive = 0;
  for (std::size_t lag = 1; lag < covariances.size(); ++lag) {
    consecutive = std::abs(covariances[lag]) < noise ? consecutive + 1 : 0;
    if (consecutive == kRun) return lag - kRun;
  }
  return covariances.size() - 1;
}

std::size_t minBlockLength(std::size_t count) {
  return static_cast<std::size_t>(std::ceil(2 * std::cbrt(static_cast<double>(count))));
}

/// +1 for each value above the median, -1 below: these signs determine the median's variance.
std::vector<double> signsAroundMedian(std::span<const double> values, double median) {
  std::vector<double> signs(values.size());
  std::ranges::transform(values, signs.begin(), [median](double value) {
    return static_cast<double>(value > median) - static_cast<double>(value < median);
  });
  return signs;
}

}  // namespace

double mean(std::span<const double> values) {
  if (values.empty()) return 0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double standardDeviation(std::span<const double> values) {
  if (values.size() < 2) return 0;
  const double centre = mean(values);
  double squares = 0;
  for (const double value : values) squares += (value - centre) * (value - centre);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

double quantile(std::span<const double> values, double q) {
  return sortedQuantile(sortedCopy(values), q);
}

double studentT975(double degrees) {
  // Exact to the digits given; in between and beyond, interpolated in 1/degrees, in which the
  // quantile is nearly linear and convex, so never too small: at most 3 % too large below 1.5
  // degrees, 0.6 % up to 3, 0.15 % up to 6, 0.02 % from 10 on.
  struct Row {
    double degrees, t;
  };
  static constexpr std::array kTable = {Row{1, 12.7062},    Row{1.25, 8.02795}, Row{1.5, 6.01666},
                                        Row{1.75, 4.94885}, Row{2, 4.30265},    Row{2.5, 3.57465},
                                        Row{3, 3.18245},    Row{3.5, 2.94009},  Row{4, 2.77645},
                                        Row{5, 2.57058},    Row{6, 2.44691},    Row{7, 2.36462},
                                        Row{8, 2.30600},    Row{9, 2.26216},    Row{10, 2.22814},
                                        Row{12, 2.17881},   Row{15, 2.13145},   Row{20, 2.08596},
                                        Row{30, 2.04227},   Row{60, 2.00030},   Row{120, 1.97993}};
  constexpr double kNormal = 1.95996;
  if (degrees <= 1) return kTable.front().t;
  for (std::size_t i = 1; i < kTable.size(); ++i) {
    if (degrees > kTable[i].degrees) continue;
    const auto [d0, t0] = kTable[i - 1];
    const auto [d1, t1] = kTable[i];
    return std::lerp(t0, t1, (1 / d0 - 1 / degrees) / (1 / d0 - 1 / d1));
  }
  return std::lerp(kNormal, kTable.back().t, kTable.back().degrees / degrees);
}

std::size_t blockLength(std::span<const double> values) {
  constexpr std::size_t kMinValues = 8;
  if (values.size() < kMinValues) return 1;
  const auto n = static_cast<double>(values.size());
  const double centre = mean(values);
  std::vector<double> covariances;
  const auto lags = std::min(values.size() / 2, static_cast<std::size_t>(10 * std::cbrt(n)) + 5);
  for (std::size_t lag = 0; lag <= lags; ++lag) {
    covariances.push_back(autocovariance(values, centre, lag));
  }
  if (covariances[0] == 0) return 1;
  const auto window = std::min(2 * lastSignificantLag(covariances, values.size()), lags);
  double density = covariances[0];
  double curvature = 0;
  for (std::size_t lag = 1; lag <= window; ++lag) {
    const double share = static_cast<double>(lag) / static_cast<double>(window);
    const double weight = share <= 0.5 ? 1 : 2 * (1 - share);  // a trapezoid
    density += 2 * weight * covariances[lag];
    curvature += 2 * weight * static_cast<double>(lag) * covariances[lag];
  }
  if (density <= 0) return 1;
  const double length = std::cbrt(1.5 * curvature * curvature / (density * density) * n);
  return static_cast<std::size_t>(std::clamp(std::ceil(length), 1.0, std::ceil(n / 4)));
}

std::size_t safeBlockLength(std::span<const double> values) {
  return std::max(blockLength(values), minBlockLength(values.size()));
}

Interval blockBootstrap95(std::size_t count, std::size_t block, double estimate,
                          const std::function<double(std::span<const std::size_t>)>& statistic) {
  constexpr int kResamples = 500;
  std::mt19937_64 random;
  std::uniform_int_distribution<std::size_t> starts(0, count - 1);
  std::vector<double> resampled(kResamples);
  std::vector<std::size_t> drawn(count);
  for (double& value : resampled) {
    for (std::size_t i = 0; i < count;) {
      std::size_t from = starts(random);
      for (std::size_t k = 0; k < block && i < count; ++k, ++i, ++from) drawn[i] = from % count;
    }
    value = statistic(drawn);
  }
  // Few blocks underestimate the variance, as few values do (Student).
  const double blocks = static_cast<double>(count) / static_cast<double>(block);
  const double factor = studentT975(std::max(blocks - 1, 1.0)) / 1.96;
  return {estimate + factor * (quantile(resampled, 0.025) - estimate),
          estimate + factor * (quantile(resampled, 0.975) - estimate)};
}

Estimate medianOfSeries(std::span<const double> values) {
  const double median = quantile(values, 0.5);
  const std::size_t block = safeBlockLength(signsAroundMedian(values, median));
  std::vector<double> sample(values.size());
  const auto median_of = [&](std::span<const std::size_t> drawn) {
    std::ranges::transform(drawn, sample.begin(), [&](std::size_t index) { return values[index]; });
    const auto middle = sample.begin() + static_cast<std::ptrdiff_t>(sample.size() / 2);
    std::ranges::nth_element(sample, middle);
    if (sample.size() % 2 == 1) return *middle;
    return std::midpoint(*std::max_element(sample.begin(), middle), *middle);
  };
  const Interval interval = blockBootstrap95(values.size(), block, median, median_of);
  return {median, {std::min(interval.low, median), std::max(interval.high, median)}};
}

std::optional<Interval> confidence95(std::span<const double> values) {
  if (values.size() < 2) return std::nullopt;
  const double half =
      studentT975(static_cast<double>(values.size() - 1)) * std::sqrt(squaredStandardError(values));
  const double centre = mean(values);
  return Interval{centre - half, centre + half};
}

double Histogram::begin(std::size_t bin) const {
  return std::lerp(low, high, static_cast<double>(bin) / static_cast<double>(counts.size()));
}

Histogram histogramOf(std::span<const double> values, std::size_t bins) {
  Histogram histogram{.low = quantile(values, 0.02), .high = quantile(values, 0.98)};
  if (histogram.low >= histogram.high) return histogram;
  histogram.counts.resize(bins);
  for (const double value : values) {
    const double share = (value - histogram.low) / (histogram.high - histogram.low);
    const double bin = std::clamp(share, 0.0, 1.0) * static_cast<double>(bins);
    ++histogram.counts[std::min(static_cast<std::size_t>(bin), bins - 1)];
  }
  return histogram;
}

Summary summarise(std::span<const std::span<const double>> repetitions) {
  std::vector<double> sorted;
  std::vector<double> means;
  for (const auto repetition : repetitions) {
    sorted.insert(sorted.end(), repetition.begin(), repetition.end());
    if (!repetition.empty()) means.push_back(mean(repetition));
  }
  std::ranges::sort(sorted);
  const double q1 = sortedQuantile(sorted, 0.25);
  const double q3 = sortedQuantile(sorted, 0.75);
  const auto outliers = std::ranges::count_if(
      sorted, [fence = q3 + 3 * (q3 - q1)](double value) { return value > fence; });
  return {.seconds_per_frame = mean(sorted),
          .median = sortedQuantile(sorted, 0.5),
          .p95 = sortedQuantile(sorted, 0.95),
          .p99 = sortedQuantile(sorted, 0.99),
          .min = sorted.empty() ? 0 : sorted.front(),
          .stddev = standardDeviation(sorted),
          .outliers = static_cast<std::size_t>(outliers),
          .ci95 = confidence95(means)};
}

}  // namespace broadmark
