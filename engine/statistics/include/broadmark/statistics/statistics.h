// Statistics of timings, as pure functions.
//
// Example:
//
//   const std::vector<double> seconds = {1e-3, 1.1e-3, 0.9e-3, 5e-3};
//   const double median = quantile(seconds, 0.5);
//   const std::optional<Interval> interval = confidence95(seconds);
//   const Summary summary = summarise(std::vector<std::span<const double>>{seconds});
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace broadmark {

// Values have any unit, and must not be NaN. Functions that sort do so in a copy.

/// Arithmetic mean; 0 for no values.
double mean(std::span<const double> values);
/// Sample standard deviation (n − 1); 0 for fewer than two values.
double standardDeviation(std::span<const double> values);
/// Quantile q in [0, 1] with linear interpolation between closest ranks (Hyndman & Fan type 7, the
/// default of R and NumPy); 0 for no values. Sorts: O(n log n).
double quantile(std::span<const double> values, double q);
/// The value that Student's t exceeds in absolute value with probability `error_rate`, in (0, 1].
/// Fewer than 1 degree of freedom count as 1.
double studentT(double error_rate, double degrees);

/// A closed interval.
struct Interval {
  double low = 0;
  double high = 0;
};

/// An estimate and its confidence interval, of 95 % unless stated otherwise.
struct Estimate {
  double value = 0;
  Interval ci95;
};

/// The median of a time series with correlated neighbours, such as the frames of a run. The
/// interval inverts a sign test: it ends at two order statistics, further apart where signs around
/// the median are correlated within safeBlockLength(), or within `min_block` values. It misses the
/// true median with probability `error_rate`, and is infinite for too few values. Requires values.
/// Sorts.
Estimate medianOfSeries(std::span<const double> values, double error_rate = 0.05,
                        std::size_t min_block = 1);
/// The block length, in values, for resampling a series to estimate its mean: the rule of Politis
/// and White (2004, corrected 2009) for circular blocks. At least 1, at most a quarter of the
/// series, rounded up; 1 for fewer than 8 values. O(n^(4/3)).
std::size_t blockLength(std::span<const double> values);
/// blockLength() with a minimum that grows with the cube root of the length of the series, since in
/// short series noise hides the correlation. May exceed that length.
std::size_t safeBlockLength(std::span<const double> values);

/// 95 % interval around `estimate`, which is `statistic` of all `count` values, by a percentile
/// bootstrap with circular blocks of `block` values (Politis and Romano, 1992). `statistic` is
/// called 500 times with the indices of the drawn values, `count` of them. With few blocks the
/// interval is widened by Student's t. Deterministic. Requires values and a block of at least 1.
Interval blockBootstrap95(std::size_t count, std::size_t block, double estimate,
                          const std::function<double(std::span<const std::size_t>)>& statistic);

/// 95 % confidence interval, by Student's t, of the mean of independent values; nullopt for fewer
/// than two.
std::optional<Interval> confidence95(std::span<const double> values);

/// A histogram with bins of equal width.
struct Histogram {
  double low = 0;                   ///< lower end of the first bin
  double high = 0;                  ///< upper end of the last bin
  std::vector<std::size_t> counts;  ///< values by bin; empty: no bins

  /// The lower end of a bin; of the one after the last, its upper end. Requires bins.
  [[nodiscard]] double begin(std::size_t bin) const;
};

/// Bins from the second to the 98th percentile: the tails would compress the rest into one bin; the
/// first and last bins count them. No bins if these percentiles are equal, as without values.
/// Requires `bins` of at least 1.
Histogram histogramOf(std::span<const double> values, std::size_t bins);

/// Times of one case, in seconds. Outliers are counted, never dropped.
struct Summary {
  double seconds_per_frame = 0;  ///< the mean over all frames, as in the paper
  double median = 0;
  double p95 = 0;  ///< 95th percentile
  double p99 = 0;
  double min = 0;
  double stddev = 0;         ///< over all frames of all repetitions
  std::size_t outliers = 0;  ///< frames above the third quartile + 3 interquartile ranges
  /// Interval of the mean, over repetitions; nullopt for a single one.
  std::optional<Interval> ci95;
};

/// Summarises frame times in seconds, given per repetition; all 0 without any. Sorts.
Summary summarise(std::span<const std::span<const double>> repetitions);

}  // namespace broadmark
