// Boxes as six float arrays (structure of arrays), padded for SIMD.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "broadmark/aabb.h"
#include "broadmark/large_array.h"

namespace broadmark {

/// Boxes as structure of arrays: one array per corner and axis, each aligned to 64 bytes and
/// followed by `kPadding` boxes that overlap nothing, so that a kernel may load whole vectors from
/// any valid index without a tail loop.
class BoxArrays {
 public:
  static constexpr std::size_t kPadding = 16;  ///< lanes of the widest vector

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const float* min(int axis) const { return array(axis); }
  [[nodiscard]] const float* max(int axis) const { return array(axis + 3); }
  float* min(int axis) { return array(axis); }
  float* max(int axis) { return array(axis + 3); }

  [[nodiscard]] Aabb box(std::size_t i) const;
  void set(std::size_t i, const Aabb& box) {
    for (int axis = 0; axis < 3; ++axis) {
      min(axis)[i] = box.min[axis];
      max(axis)[i] = box.max[axis];
    }
  }

  /// Resizes to `size` uninitialised boxes, followed by padding. Reuses the memory if it
  /// suffices.
  void resize(std::size_t size);
  /// Stores a transposed copy of `boxes`.
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
