// Statistics of timings.

#include "broadmark/statistics/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

/// Continued fraction of the incomplete beta function, by the modified Lentz method. Converges
/// quickly for x < (a + 1) / (a + b + 2).
double betaFraction(double a, double b, double x) {
  constexpr double kTiny = 1e-300;
  constexpr double kPrecision = 1e-15;
  constexpr int kMaxTerms = 10'000;
  const auto apart_from_zero = [](double value) { return value == 0 ? kTiny : value; };
  double c = 1;
  double d = 1 / apart_from_zero(1 - (a + b) * x / (a + 1));
  double fraction = d;
  for (int m = 1; m < kMaxTerms; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    for (const double term : {even, odd}) {
      d = 1 / apart_from_zero(1 + term * d);
      c = apart_from_zero(1 + term / c);
      fraction *= c * d;
    }
    if (std::abs(c * d - 1) < kPrecision) break;
  }
  return fraction;
}

/// Regularised incomplete beta function I_x(a, b); `y` is 1 - x, which may be too small to
/// subtract.
double incompleteBeta(double a, double b, double x, double y) {
  if (x > (a + 1) / (a + b + 2)) return 1 - incompleteBeta(b, a, y, x);
  if (x <= 0) return 0;
  // std::lgamma() sets a global variable.
  int sign = 0;
  const double log_front = ::lgamma_r(a + b, &sign) - ::lgamma_r(a, &sign) - ::lgamma_r(b, &sign) +
                           a * std::log(x) + b * std::log(y);
  return std::exp(log_front) * betaFraction(a, b, x) / a;
}

/// +1 for each value above the median, -1 below: these signs determine the median's variance.
std::vector<double> signsAroundMedian(std::span<const double> values, double median) {
  std::vector<double> signs(values.size());
  std::ranges::transform(values, signs.begin(), [median](double value) {
    return static_cast<double>(value > median) - static_cast<double>(value < median);
  });
  return signs;
}

/// Variance of the sum of a series with mean 0, per value, from all circular blocks of it.
double longRunVariance(std::span<const double> values, std::size_t block) {
  double sum =
      std::accumulate(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(block), 0.0);
  double squares = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    squares += sum * sum;
    sum += values[(i + block) % values.size()] - values[i];
  }
  return squares / static_cast<double>(values.size() * block);
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

double studentT(double error_rate, double degrees) {
  // The quantile hardly changes beyond, and the incomplete beta function loses its digits.
  constexpr double kMaxDegrees = 1e6;
  degrees = std::clamp(degrees, 1.0, kMaxDegrees);
  const auto beyond = [&](double t) {  // the probability of a larger absolute value
    return incompleteBeta(degrees / 2, 0.5, degrees / (degrees + t * t), t * t / (degrees + t * t));
  };
  double low = 0;
  double high = 1;
  while (beyond(high) > error_rate) high *= 2;
  constexpr int kBisections = 60;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = std::midpoint(low, high);
    (beyond(middle) > error_rate ? low : high) = middle;
  }
  return high;
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
  const double factor = studentT(0.05, blocks - 1) / 1.96;
  return {estimate + factor * (quantile(resampled, 0.025) - estimate),
          estimate + factor * (quantile(resampled, 0.975) - estimate)};
}

Estimate medianOfSeries(std::span<const double> values, double error_rate, std::size_t min_block) {
  const std::vector<double> sorted = sortedCopy(values);
  const double median = sortedQuantile(sorted, 0.5);
  const std::vector<double> signs = signsAroundMedian(values, median);
  const std::size_t block = std::min(std::max(safeBlockLength(signs), min_block), values.size());
  const auto count = static_cast<double>(values.size());
  const double variance = std::max(longRunVariance(signs, block), 1.0);
  // Overlapping blocks have 1.5 times the degrees of freedom of separate ones.
  const double degrees = 1.5 * (count / static_cast<double>(block) - 1);
  const double half = studentT(error_rate, degrees) * std::sqrt(variance / count) / 2;
  if (half >= 0.5) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return {median, {-kInfinity, kInfinity}};
  }
  return {median, {sortedQuantile(sorted, 0.5 - half), sortedQuantile(sorted, 0.5 + half)}};
}

std::optional<Interval> confidence95(std::span<const double> values) {
  if (values.size() < 2) return std::nullopt;
  const double half = studentT(0.05, static_cast<double>(values.size() - 1)) *
                      std::sqrt(squaredStandardError(values));
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
