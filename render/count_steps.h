// Counts in steps of about equal ratio, for a scale of colours.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace broadmark {

class CountSteps {
 public:
  static constexpr std::size_t kMost = 6;

  /// From the least count, above 0, to the most.
  CountSteps(std::uint32_t least, std::uint32_t most);

  [[nodiscard]] std::size_t size() const { return begins_.size(); }
  /// The step that a count from least to most is in.
  [[nodiscard]] std::size_t stepOf(std::uint32_t count) const;
  /// "3 to 5"
  [[nodiscard]] std::string text(std::size_t step) const;
  /// Its place on a scale of kMost colours: few steps, too, go along the whole of it.
  [[nodiscard]] std::size_t place(std::size_t step) const;

 private:
  std::vector<std::uint32_t> begins_;  ///< the least count of each
  std::uint32_t most_;
};

}  // namespace broadmark
