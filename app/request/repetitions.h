// How often the cases of a recording are run, and in which order.
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

  int warmup = 0;              ///< unmeasured repetitions before
  int most = 1;                ///< and fewest, unless:
  bool until_precise = false;  ///< a case is repeated until its mean is known well enough
  double precision = 0.02;     ///< relative width of the mean's interval
  double max_seconds = 300;    ///< of a recording
  std::uint64_t order_seed = 1;

  /// Repetitions of a case, with those for warming up.
  [[nodiscard]] int passes() const { return warmup + most; }
};

/// Tells for each case of a recording when it has been repeated often enough.
class RepetitionRule {
 public:
  /// The time begins to run.
  explicit RepetitionRule(const RepetitionOptions& options) : options_(options) {}

  [[nodiscard]] bool isEnough(const CaseResult& result) const;
  /// How many repetitions are the whole number for a case that is not run any more.
  [[nodiscard]] int wanted(const CaseResult& result) const;

 private:
  using Clock = std::chrono::steady_clock;

  const RepetitionOptions& options_;
  Clock::time_point begin_ = Clock::now();
};

/// The interleaving order of cases: at first as given, then shuffled, so that the after-effects of
/// a case, such as a warm processor, do not always hit the same successor.
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
