// A number per frame, with fast queries for drawing any number of frames.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace broadmark {

/// Also stores the minimum and maximum of every 2, 4, 8, … frames, so that neither plotting nor the
/// search for a mark visits all frames. Setting a number is O(log n).
class FrameValues {
 public:
  static constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

  /// The minimum and maximum of some frames; NaN if no number is known.
  struct Range {
    float low = kUnknown;
    float high = kUnknown;

    [[nodiscard]] bool known() const { return !std::isnan(low); }
  };

  /// Sets the number of a frame; NaN: unknown.
  void set(std::uint32_t frame, float value);
  /// The number of a frame; NaN if unknown.
  [[nodiscard]] float at(std::uint32_t frame) const {
    return frame < values_.size() ? values_[frame] : kUnknown;
  }
  /// The number of frames up to the last set frame.
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(values_.size()); }

  /// The range of 2^`level` frames from `index` * 2^`level`. O(1).
  [[nodiscard]] Range block(unsigned level, std::uint32_t index) const;
  /// The range of the frames from `first` to `last`. O(log n).
  [[nodiscard]] Range within(std::uint32_t first, std::uint32_t last) const;
  /// The first frame with the maximum from `first` to `last`. O(log n).
  [[nodiscard]] std::optional<std::uint32_t> highest(std::uint32_t first, std::uint32_t last) const;
  /// The first frame with a known number from `first` to `last`. O(log n).
  [[nodiscard]] std::optional<std::uint32_t> firstKnown(std::uint32_t first,
                                                        std::uint32_t last) const;

 private:
  /// The first frame in a block for which `contains(range)` is true.
  template <class Predicate>
  [[nodiscard]] std::optional<std::uint32_t> firstWhere(std::uint32_t first, std::uint32_t last,
                                                        const Predicate& contains) const;

  std::vector<float> values_;
  std::vector<std::vector<Range>> levels_;  ///< [k]: of 2^(k + 1) frames; the last has one block
};

}  // namespace broadmark
