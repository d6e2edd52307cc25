// The axis along which the boxes of one cell are swept, and the buckets that they are sorted into.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "broadmark/aabb.h"
#include "corner.h"

namespace broadmark {

/// The axis of a cell's sweep, and buckets of equal length on it.
class CellBuckets {
 public:
  /// A single bucket.
  CellBuckets() = default;
  /// As many buckets as boxes, on the axis on which the range of lower bounds is the longest
  /// compared with the boxes.
  explicit CellBuckets(std::span<const Aabb> boxes) {
    Corner least = cornerOf(boxes.front().min);
    Corner most = least;
    Corner edges{};  // the sum of them
    for (const Aabb& box : boxes) {
      const Corner min = cornerOf(box.min);
      least = smaller(least, min);
      most = larger(most, min);
      edges += cornerOf(box.max) - min;
    }
    float widest = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float range = most[axis] - least[axis];
      const float width = range / edges[axis];
      if (!(width > widest)) continue;  // also when it is 0/0
      widest = width;
      axis_ = axis;
      low_ = least[axis];
      last_ = static_cast<float>(std::min<std::size_t>(boxes.size() - 1, kMostBuckets));
      scale_ = std::min(last_ / range, std::numeric_limits<float>::max());
    }
  }

  [[nodiscard]] int axis() const { return axis_; }
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(last_) + 1; }
  /// The bucket of a bound. A higher bound never gets a lower bucket: correctness rests on that.
  [[nodiscard]] std::uint32_t of(float bound) const {
    const float bucket = (bound - low_) * scale_;
    const float at_least = bucket > 0 ? bucket : 0;
    return static_cast<std::uint32_t>(
        static_cast<std::int32_t>(at_least < last_ ? at_least : last_));
  }

 private:
  static constexpr std::size_t kMostBuckets = std::size_t{1} << 20;

  int axis_ = 0;
  float low_ = 0;
  float scale_ = 0;
  float last_ = 0;  ///< number of buckets - 1
};

}  // namespace broadmark
