// Number and order of the repetitions of a recording's cases.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "broadmark/results/results.h"

namespace broadmark {

struct RepetitionOptions {
  static constexpr int kMinUntilPrecise = 5;
  static constexpr int kMaxUntilPrecise = 100;

  int warmup = 0;              ///< unmeasured passes before each repetition
  int max_count = 1;           ///< also the minimum unless until_precise
  bool until_precise = false;  ///< repeat a case until its mean is precise
  double precision = 0.02;     ///< relative width of the mean's confidence interval
  double max_seconds = 300;    ///< per recording
  std::uint64_t order_seed = 1;
};

/// Decides when each case of a recording has been repeated often enough.
class RepetitionRule {
 public:
  /// Starts the time limit.
  explicit RepetitionRule(const RepetitionOptions& options) : options_(options) {}

  [[nodiscard]] bool isEnough(const CaseResult& result) const;
  /// Whether the precision is reached, or not requested.
  [[nodiscard]] bool isPrecise(const CaseResult& result) const;
  /// Number of repetitions that make a finished case complete.
  [[nodiscard]] int expected(const CaseResult& result) const;

 private:
  using Clock = std::chrono::steady_clock;

  const RepetitionOptions& options_;
  Clock::time_point start_ = Clock::now();
};

/// Interleaving order of cases: initially as given, then shuffled, so that after-effects of a case,
/// such as a warm processor, do not always affect the same successor.
class TurnOrder {
 public:
  TurnOrder(std::size_t cases, std::uint64_t seed);

  void shuffle();
  [[nodiscard]] const std::vector<std::size_t>& cases() const { return order_; }

 private:
  std::vector<std::size_t> order_;
  std::mt19937_64 random_;
};

}  // namespace broadmark
