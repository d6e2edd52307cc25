// Boxes as six float arrays (structure of arrays), padded for SIMD.
//
// Example:
//
//   const std::vector<Aabb> boxes = {{{0, 0, 0}, {1, 1, 1}}, {{4, 0, 0}, {5, 1, 1}}};
//   BoxArrays arrays;
//   arrays.assign(boxes);
//   for (std::size_t i = 0; i < arrays.size(); i += BoxArrays::kPadding) {
//     const float* const min_x = arrays.min(0) + i;  // of 16 boxes, here 14 of padding
//   }
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "broadmark/aabb.h"
#include "broadmark/large_array.h"

namespace broadmark {

/// Boxes as structure of arrays: one array per corner and axis, each aligned to 64 bytes and
/// followed by `kPadding` boxes that overlap nothing, so that a kernel may load whole vectors from
/// any valid index without a tail loop. Movable; an object moved from may only be destroyed or
/// assigned to.
class BoxArrays {
 public:
  static constexpr std::size_t kPadding = 16;  ///< lanes of the widest vector

  /// The number of boxes, without padding.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// The bounds of all boxes along an axis, 0 to 2; valid until the next resize() or assign().
  [[nodiscard]] const float* min(int axis) const { return array(axis); }
  [[nodiscard]] const float* max(int axis) const { return array(axis + 3); }
  float* min(int axis) { return array(axis); }
  float* max(int axis) { return array(axis + 3); }

  /// A copy of box i, below size().
  [[nodiscard]] Aabb box(std::size_t i) const;
  /// Replaces box i, below size().
  void set(std::size_t i, const Aabb& box) {
    for (int axis = 0; axis < 3; ++axis) {
      min(axis)[i] = box.min[axis];
      max(axis)[i] = box.max[axis];
    }
  }

  /// Resizes to `size` uninitialised boxes, followed by padding. Reuses the memory if it suffices,
  /// otherwise allocates at least 1.5 times as much. Throws std::bad_alloc.
  void resize(std::size_t size);
  /// Stores a transposed copy of `boxes`. O(n); allocates as resize() does.
  void assign(std::span<const Aabb> boxes);

 private:
  [[nodiscard]] float* array(int which) const {
    return memory_.get() + static_cast<std::size_t>(which) * stride_;
  }

  std::unique_ptr<float[], FreeMemory> memory_;
  std::size_t size_ = 0;
  std::size_t stride_ = 0;  ///< floats from one array to the next
};

}  // namespace broadmark
