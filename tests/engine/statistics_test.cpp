// Statistics against known values: computed by hand where the sum is shown, otherwise from tables
// of Student's t (as in R's qt(0.975, df)).

#include "broadmark/statistics/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <vector>

namespace broadmark::tests {
namespace {

using Values = std::vector<double>;

TEST(Statistics, MeanAndStandardDeviation) {
  const Values values = {2, 4, 4, 4, 5, 5, 7, 9};
  EXPECT_DOUBLE_EQ(mean(values), 5);
  // Squares about 5: 9 + 1 + 1 + 1 + 0 + 0 + 4 + 16 = 32, over n - 1 = 7.
  EXPECT_DOUBLE_EQ(standardDeviation(values), std::sqrt(32.0 / 7));
}

TEST(Statistics, NothingAndASingleValue) {
  EXPECT_EQ(mean({}), 0);
  EXPECT_EQ(standardDeviation({}), 0);
  EXPECT_EQ(quantile({}, 0.5), 0);
  const Values single = {3};
  EXPECT_EQ(mean(single), 3);
  EXPECT_EQ(standardDeviation(single), 0);
  EXPECT_FALSE(confidence95({}).has_value());
  EXPECT_FALSE(confidence95(single).has_value());
}

// Type 7: rank q (n - 1), with linear interpolation.
TEST(Statistics, Quantiles) {
  const Values single = {3};
  for (const double q : {0.0, 0.3, 0.5, 0.99, 1.0}) EXPECT_EQ(quantile(single, q), 3);

  const Values two = {20, 10};
  EXPECT_DOUBLE_EQ(quantile(two, 0), 10);
  EXPECT_DOUBLE_EQ(quantile(two, 0.25), 12.5);
  EXPECT_DOUBLE_EQ(quantile(two, 0.95), 19.5);
  EXPECT_DOUBLE_EQ(quantile(two, 1), 20);

  const Values five = {50, 10, 40, 20, 30};
  EXPECT_DOUBLE_EQ(quantile(five, 0.5), 30);
  EXPECT_DOUBLE_EQ(quantile(five, 0.1), 14);
  EXPECT_DOUBLE_EQ(quantile(five, 0.95), 48);
  EXPECT_DOUBLE_EQ(quantile(five, 0.99), 49.6);
}

TEST(Statistics, StudentQuantiles) {
  const std::map<double, double> known = {
      {1, 12.7062},   {2, 4.30265},    {3, 3.18245},   {4, 2.77645},   {5, 2.57058},
      {7, 2.36462},   {9, 2.26216},    {10, 2.22814},  {11, 2.20099},  {13, 2.16037},
      {14, 2.14479},  {17, 2.10982},   {19, 2.09302},  {25, 2.05954},  {29, 2.04523},
      {40, 2.02108},  {50, 2.00856},   {80, 1.99006},  {100, 1.98397}, {200, 1.97190},
      {500, 1.96472}, {1000, 1.96234}, {1e6, 1.95997}, {1e12, 1.95996}};
  for (const auto& [degrees, t] : known) EXPECT_NEAR(studentT(0.05, degrees), t, 1e-3) << degrees;
}

// Welch's degrees of freedom are no integers. Values by numerical integration of the density.
TEST(Statistics, StudentQuantilesInBetween) {
  for (const auto& [degrees, t] : std::map<double, double>{
           {1.25, 8.02795}, {1.5, 6.01666}, {2.5, 3.57465}, {3.5, 2.94009}, {4.5, 2.65891}}) {
    EXPECT_NEAR(studentT(0.05, degrees), t, 2e-3 * t) << degrees;
  }
}

// As in R's qt(1 - error_rate / 2, degrees).
TEST(Statistics, StudentQuantilesOfSmallErrorRates) {
  EXPECT_NEAR(studentT(0.01, 5), 4.03214, 1e-4);
  EXPECT_NEAR(studentT(0.001, 10), 4.58689, 1e-4);
  EXPECT_NEAR(studentT(0.0001, 30), 4.48204, 1e-2);
  EXPECT_NEAR(studentT(0.5, 1), 1, 1e-4);
  EXPECT_NEAR(studentT(0.0027, 1e9), 2.99998, 1e-3);
}

TEST(Statistics, StudentQuantilesFallWithDegrees) {
  double last = studentT(0.05, 1);
  for (double degrees = 1.1; degrees < 300; degrees *= 1.05) {
    const double t = studentT(0.05, degrees);
    EXPECT_LT(t, last) << degrees;
    last = t;
  }
}

TEST(Statistics, ConfidenceOfTheMean) {
  const Values values = {1, 2, 3, 4, 5};
  // Deviation sqrt(10 / 4), standard error sqrt(0.5), t of 4 degrees.
  const double half = 2.77645 * std::sqrt(0.5);
  const auto interval = confidence95(values);
  ASSERT_TRUE(interval);
  EXPECT_NEAR(interval->low, 3 - half, 1e-4);
  EXPECT_NEAR(interval->high, 3 + half, 1e-4);
}

Summary summariseAll(const std::vector<Values>& repetitions) {
  const std::vector<std::span<const double>> views(repetitions.begin(), repetitions.end());
  return summarise(views);
}

TEST(Summary, OfTwoRepetitions) {
  const Summary summary = summariseAll({{1, 2, 3}, {3, 4, 5}});
  EXPECT_DOUBLE_EQ(summary.seconds_per_frame, 3);
  EXPECT_DOUBLE_EQ(summary.median, 3);
  EXPECT_DOUBLE_EQ(summary.p95, 4.75);
  EXPECT_DOUBLE_EQ(summary.p99, 4.95);
  EXPECT_DOUBLE_EQ(summary.min, 1);
  EXPECT_DOUBLE_EQ(summary.stddev, std::sqrt(2.0));  // squares 4 + 1 + 0 + 0 + 1 + 4 over 5
  EXPECT_EQ(summary.outliers, 0U);
  // The means are 2 and 4: standard error 1, t of 1 degree.
  ASSERT_TRUE(summary.ci95);
  EXPECT_NEAR(summary.ci95->low, 3 - 12.7062, 1e-3);
  EXPECT_NEAR(summary.ci95->high, 3 + 12.7062, 1e-3);
}

TEST(Summary, OfOneRepetitionHasNoInterval) {
  EXPECT_FALSE(summariseAll({{1, 2, 3}}).ci95.has_value());
}

TEST(Summary, OfNothing) {
  const Summary summary = summariseAll({});
  EXPECT_EQ(summary.seconds_per_frame, 0);
  EXPECT_EQ(summary.min, 0);
  EXPECT_EQ(summary.outliers, 0U);
  EXPECT_FALSE(summary.ci95.has_value());
}

// A repetition that timed out before its first frame has no mean (not 0).
TEST(Summary, RepetitionsWithoutFramesDoNotCount) {
  const Summary summary = summariseAll({{2, 4}, {}});
  EXPECT_DOUBLE_EQ(summary.seconds_per_frame, 3);
  EXPECT_FALSE(summary.ci95.has_value());
}

TEST(Summary, OutliersAreCountedAndKept) {
  // Quartiles 3 and 7 (type 7 of nine values): the fence is 7 + 3 · 4 = 19.
  const Values quiet = {1, 2, 3, 4, 5, 6, 7, 8, 19};
  EXPECT_EQ(summariseAll({quiet}).outliers, 0U);
  const Values loud = {1, 2, 3, 4, 5, 6, 7, 8, 19.5};
  const Summary summary = summariseAll({loud});
  EXPECT_EQ(summary.outliers, 1U);
  EXPECT_DOUBLE_EQ(summary.seconds_per_frame, 55.5 / 9);
}

/// A series in which each value is `correlation` times the previous value, plus noise.
Values seriesOf(std::size_t count, double correlation, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise;
  Values series;
  double value = 0;
  for (std::size_t i = 0; i < count; ++i)
    series.push_back(value = correlation * value + noise(random));
  return series;
}

TEST(MedianOfSeries, OfFewValuesHasNoInterval) {
  for (std::size_t count = 1; count < 12; ++count) {
    const Estimate estimate = medianOfSeries(seriesOf(count, 0, 1));
    EXPECT_TRUE(std::isfinite(estimate.value));
    EXPECT_EQ(estimate.ci95.low, -INFINITY) << count;
    EXPECT_EQ(estimate.ci95.high, INFINITY) << count;
  }
  EXPECT_TRUE(std::isfinite(medianOfSeries(seriesOf(20, 0, 1)).ci95.low));
}

TEST(MedianOfSeries, HoldsTheTrueMedianAsOftenAsItSays) {
  constexpr int kSeries = 2000;
  for (const double error_rate : {0.05, 0.005}) {
    for (const double correlation : {0.0, 0.6}) {
      int misses = 0;
      for (unsigned seed = 0; seed < kSeries; ++seed) {
        const Interval interval = medianOfSeries(seriesOf(300, correlation, seed), error_rate).ci95;
        misses += interval.low > 0 || interval.high < 0 ? 1 : 0;
      }
      const double expected = error_rate * kSeries;
      EXPECT_LE(misses, 1.5 * expected + 3 * std::sqrt(expected))
          << error_rate << ' ' << correlation;
      EXPECT_GT(misses, 0);
    }
  }
}

TEST(MedianOfSeries, IsLessSureWhereNeighboursAreAlike) {
  const auto width = [](double correlation) {
    const Interval interval = medianOfSeries(seriesOf(1000, correlation, 5)).ci95;
    return (interval.high - interval.low) * (1 - correlation);  // relative to independent values
  };
  EXPECT_GT(width(0.9), 0.7 * width(0));
}

TEST(BlockLength, GrowsWithLikeness) {
  EXPECT_EQ(blockLength(Values{1, 2}), 1U);
  EXPECT_EQ(blockLength(Values(50, 1.0)), 1U);
  const Values alike = seriesOf(2000, 0.9, 1);
  EXPECT_LE(blockLength(seriesOf(2000, 0, 1)), 4U);
  EXPECT_GE(blockLength(alike), 20U);
  EXPECT_LE(blockLength(alike), 500U);
}

}  // namespace
}  // namespace broadmark::tests
