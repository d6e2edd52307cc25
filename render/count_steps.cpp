#include "count_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace broadmark {

CountSteps::CountSteps(std::uint32_t least, std::uint32_t most) : begins_{least}, most_(most) {
  constexpr double kAlmost = 1 - 1e-9;  // a power that is a whole number may be rounded up
  for (std::size_t step = 1; step < kMost && begins_.back() < most; ++step) {
    const double part = static_cast<double>(step) / kMost;
    const double begin = least * std::pow(static_cast<double>(most) / least, part);
    begins_.push_back(
        std::max(static_cast<std::uint32_t>(std::ceil(kAlmost * begin)), begins_.back() + 1));
  }
}

std::size_t CountSteps::stepOf(std::uint32_t count) const {
  return static_cast<std::size_t>(std::ranges::upper_bound(begins_, count) - begins_.begin()) - 1;
}

std::string CountSteps::text(std::size_t step) const {
  const std::uint32_t first = begins_[step];
  const std::uint32_t last = step + 1 < begins_.size() ? begins_[step + 1] - 1 : most_;
  return first == last ? fmt::format("{}", first) : fmt::format("{} to {}", first, last);
}

std::size_t CountSteps::place(std::size_t step) const {
  return size() == 1 ? kMost - 1 : step * (kMost - 1) / (size() - 1);
}

}  // namespace broadmark
