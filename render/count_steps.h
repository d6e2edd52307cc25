// Counts in steps of about equal ratio, for a scale of colours.
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
  static constexpr std::size_t kMost = 6;

  /// From the least count, above 0, to the most.
  CountSteps(std::uint32_t least, std::uint32_t most) : begins_{least}, most_(most) {
    constexpr double kAlmost = 1 - 1e-9;  // a power that is a whole number may be rounded up
    for (std::size_t step = 1; step < kMost && begins_.back() < most; ++step) {
      const double part = static_cast<double>(step) / kMost;
      const double begin = least * std::pow(static_cast<double>(most) / least, part);
      begins_.push_back(
          std::max(static_cast<std::uint32_t>(std::ceil(kAlmost * begin)), begins_.back() + 1));
    }
  }

  [[nodiscard]] std::size_t size() const { return begins_.size(); }
  /// The step that a count from least to most is in.
  [[nodiscard]] std::size_t stepOf(std::uint32_t count) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(begins_, count) - begins_.begin()) - 1;
  }
  /// "3 to 5"
  [[nodiscard]] std::string text(std::size_t step) const {
    const std::uint32_t first = begins_[step];
    const std::uint32_t last = step + 1 < begins_.size() ? begins_[step + 1] - 1 : most_;
    return first == last ? fmt::format("{}", first) : fmt::format("{} to {}", first, last);
  }
  /// Its place on a scale of kMost colours: few steps, too, go along the whole of it.
  [[nodiscard]] std::size_t place(std::size_t step) const {
    return size() == 1 ? kMost - 1 : step * (kMost - 1) / (size() - 1);
  }

 private:
  std::vector<std::uint32_t> begins_;  ///< the least count of each
  std::uint32_t most_;
};

}  // namespace broadmark
