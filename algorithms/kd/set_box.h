// Writing single boxes into arrays of them.
#pragma once

#include <cstddef>

#include "broadmark/box_arrays.h"

namespace broadmark::kd {

inline void setBox(BoxArrays& boxes, std::size_t i, const Aabb& box) {
  for (int axis = 0; axis < 3; ++axis) {
    boxes.min(axis)[i] = box.min[axis];
    boxes.max(axis)[i] = box.max[axis];
  }
}

}  // namespace broadmark::kd
