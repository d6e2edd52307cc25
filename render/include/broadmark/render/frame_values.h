// A number for each frame, made to be drawn however many frames there are.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace broadmark {

/// Beside the numbers stand the lowest and highest of every 2, 4, 8, … frames, so that neither a
/// plot nor the search for a mark has to look at all frames. Setting a number is O(log n).
class FrameValues {
 public:
  static constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

  /// The lowest and highest number of some frames; both NaN where none is known.
  struct Range {
    float low = kUnknown;
    float high = kUnknown;

    [[nodiscard]] bool known() const { return !std::isnan(low); }
  };

  /// NaN: not known (any more).
  void set(std::uint32_t frame, float value);
  /// NaN where none is known.
  [[nodiscard]] float at(std::uint32_t frame) const {
    return frame < values_.size() ? values_[frame] : kUnknown;
  }
  /// The frames up to the last that was set.
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(values_.size()); }

  /// Of the frames from `index` * 2^`level` on, 2^`level` of them. O(1).
  [[nodiscard]] Range block(unsigned level, std::uint32_t index) const;
  /// Of the frames from `first` to `last`. O(log n).
  [[nodiscard]] Range within(std::uint32_t first, std::uint32_t last) const;
  /// The first frame from `first` to `last` whose number is known. O(log n).
  [[nodiscard]] std::optional<std::uint32_t> firstKnown(std::uint32_t first,
                                                        std::uint32_t last) const;

 private:
  std::vector<float> values_;
  std::vector<std::vector<Range>> levels_;  ///< [k]: of 2^(k + 1) frames; the last has one block
};

}  // namespace broadmark
