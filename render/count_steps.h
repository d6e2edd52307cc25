// Bins of counts with about equal ratios, for a colour scale.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace broadmark {

class CountSteps {
 public:
  static constexpr std::size_t kMaxSteps = 6;

  /// Bins from `min`, above 0, to `max`.
  CountSteps(std::uint32_t min, std::uint32_t max) : begins_{min}, max_(max) {
    constexpr double kRoundingSlack = 1 - 1e-9;  // because an integer power may be rounded up
    for (std::size_t step = 1; step < kMaxSteps && begins_.back() < max; ++step) {
      const double fraction = static_cast<double>(step) / kMaxSteps;
      const double begin = min * std::pow(static_cast<double>(max) / min, fraction);
      begins_.push_back(std::max(static_cast<std::uint32_t>(std::ceil(kRoundingSlack * begin)),
                                 begins_.back() + 1));
    }
  }

  [[nodiscard]] std::size_t size() const { return begins_.size(); }
  /// The step of a count from `min` to `max`.
  [[nodiscard]] std::size_t stepOf(std::uint32_t count) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(begins_, count) - begins_.begin()) - 1;
  }
  /// "3 to 5"
  [[nodiscard]] std::string text(std::size_t step) const {
    const std::uint32_t first = begins_[step];
    const std::uint32_t last = step + 1 < begins_.size() ? begins_[step + 1] - 1 : max_;
    return first == last ? fmt::format("{}", first) : fmt::format("{} to {}", first, last);
  }
  /// The step's index on a scale of kMaxSteps colours; fewer steps also span the whole scale.
  [[nodiscard]] std::size_t scaleIndex(std::size_t step) const {
    return size() == 1 ? kMaxSteps - 1 : step * (kMaxSteps - 1) / (size() - 1);
  }

 private:
  std::vector<std::uint32_t> begins_;  ///< the minimum of each step
  std::uint32_t max_;
};

}  // namespace broadmark
