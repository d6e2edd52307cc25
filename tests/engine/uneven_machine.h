// A simulated machine with realistic noise, for tests of statistics.
#pragma once

#include <cmath>
#include <random>

namespace broadmark::tests {

/// A machine with a drifting pace and random bursts of background load, which its users share.
class UnevenMachine {
 public:
  /// `pace`: initial factor on all times. `wander`: standard deviation of the change of log(pace)
  /// between two pieces of work. `disturbance`: probability that a burst of slower work begins with
  /// a piece.
  explicit UnevenMachine(unsigned seed, double pace = 1, double wander = 0.002,
                         double disturbance = 0.01)
      : random_(seed), drift_(std::log(pace)), wander_(wander), disturbance_(disturbance) {}

  /// The time of work that takes `seconds` on a quiet machine, with autocorrelated noise of its own
  /// and a heavy tail.
  double time(double seconds, double& own_noise) {
    drift_ += wander_ * normal_(random_);
    if (burst_ == 0 && uniform_(random_) < disturbance_) burst_ = 20;
    if (burst_ > 0) --burst_;
    own_noise = 0.5 * own_noise + 0.03 * normal_(random_);
    const double tail = uniform_(random_) < 0.02 ? 1 + 4 * uniform_(random_) : 1;
    return seconds * std::exp(drift_ + own_noise) * tail * (burst_ > 0 ? 1.5 : 1);
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> uniform_;
  double drift_;
  double wander_;
  double disturbance_;
  int burst_ = 0;
};

}  // namespace broadmark::tests
