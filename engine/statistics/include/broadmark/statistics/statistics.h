// Statistics of timings, as pure functions.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace broadmark {

/// Arithmetic mean; 0 for no values.
double mean(std::span<const double> values);
/// Sample standard deviation (n − 1); 0 for fewer than two values.
double standardDeviation(std::span<const double> values);
/// Quantile q in [0, 1] with linear interpolation between closest ranks (Hyndman & Fan type 7, the
/// default of R and NumPy); 0 for no values.
double quantile(std::span<const double> values, double q);
/// Upper 97.5 % point of Student's t with `degrees` degrees of freedom (>= 1).
double studentT975(double degrees);

/// An interval around an estimate.
struct Interval {
  double low = 0;
  double high = 0;
};

/// An estimate and its 95 % confidence interval.
struct Estimate {
  double value = 0;
  Interval ci95;
};

/// The median of a series in the order of time, whose neighbours may resemble each other, as the
/// frames of a run do. The interval is a percentile bootstrap of circular blocks (Politis and
/// Romano, 1992), as long as blockLength() says of the values' sides of the median, but not shorter
/// than 2 n^(1/3); it is widened as Student's t is when there are few blocks. The same values give
/// the same interval. Not empty.
Estimate medianOfSeries(std::span<const double> values);
/// How many neighbours are to stay together when a series is resampled for its mean: the rule of
/// Politis and White (2004, corrected 2009) for circular blocks. At least 1, at most a quarter of
/// the series.
std::size_t blockLength(std::span<const double> values);

/// The length of blocks for a series that is judged by these values' mean: as blockLength() says,
/// but never short, since in short series likeness hides in the noise.
std::size_t safeBlockLength(std::span<const double> values);
/// 95 % interval around `estimate`, which is `statistic` of all `count` values, by a percentile
/// bootstrap of circular blocks (Politis and Romano, 1992). `block` values stay together.
/// `statistic` is called with the places of the values drawn. The interval is widened as Student's
/// t is when there are few blocks. The same values give the same interval.
Interval blockBootstrap95(std::size_t count, std::size_t block, double estimate,
                          const std::function<double(std::span<const std::size_t>)>& statistic);

/// 95 % confidence interval of the mean of independent values; nothing for fewer than two.
std::optional<Interval> confidence95(std::span<const double> values);

/// How many values lie where.
struct Histogram {
  double low = 0;   ///< where the first bin begins
  double high = 0;  ///< where the last one ends
  std::vector<std::size_t> counts;

  [[nodiscard]] double begin(std::size_t bin) const;
};

/// From the second to the 98th percentile: the tails would squeeze all else into one bin, and count
/// to the first and the last. No bins if all of these are the same. Not empty.
Histogram histogramOf(std::span<const double> values, std::size_t bins);

/// Times of one case, in seconds. Outliers are counted, never dropped.
struct Summary {
  double seconds_per_frame = 0;  ///< the mean, as in the paper
  double median = 0;
  double p95 = 0;
  double p99 = 0;
  double min = 0;
  double stddev = 0;
  std::size_t outliers = 0;  ///< frames above the third quartile + 3 interquartile ranges
  /// Of the mean, over repetitions; nothing for a single one.
  std::optional<Interval> ci95;
};

/// Summarises frame times, given per repetition.
Summary summarise(std::span<const std::span<const double>> repetitions);

}  // namespace broadmark
