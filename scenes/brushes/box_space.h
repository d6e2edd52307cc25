// The box that some brushes fill with bodies at random.
#pragma once

#include <array>

#include "broadmark/parameters.h"
#include "broadmark/scenes/random.h"

namespace broadmark::scenes {

/// A box around the point that is painted at.
class BoxSpace {
 public:
  void visitParameters(const ParameterVisitor& visit) {
    visit({"size_x", "size of the box along x, in world units", &size_[0], 1e-3, 1e6});
    visit({"size_y", "size of the box along y, in world units", &size_[1], 1e-3, 1e6});
    visit({"size_z", "size of the box along z, in world units", &size_[2], 1e-3, 1e6});
  }

  [[nodiscard]] const std::array<double, 3>& size() const { return size_; }

  /// A uniformly random point in it.
  [[nodiscard]] Vec3 pointInside(Random& random) const {
    Vec3 point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      point[axis] = static_cast<float>(random.between(-size_[axis] / 2, size_[axis] / 2));
    }
    return point;
  }

 private:
  std::array<double, 3> size_ = {10, 10, 10};
};

}  // namespace broadmark::scenes
