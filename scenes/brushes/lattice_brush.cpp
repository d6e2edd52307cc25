// Lattice: bodies in rows, columns and layers around the point.

#include <array>

#include "broadmark/scenes/brush.h"
#include "entries.h"

namespace broadmark::scenes::lattice_brush {
namespace {

class LatticeBrush final : public Brush {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"count_x", "number of bodies along x", &count_[0], 1, 1'000'000});
    visit({"count_y", "number of bodies along y", &count_[1], 1, 1'000'000});
    visit({"count_z", "number of bodies along z", &count_[2], 1, 1'000'000});
    visit({"spacing", "distance between neighbours, in world units", &spacing_, 0, 1e6});
  }
  [[nodiscard]] double count(double) const override {
    return static_cast<double>(count_[0]) * static_cast<double>(count_[1]) *
           static_cast<double>(count_[2]);
  }
  [[nodiscard]] Vec3 place(std::size_t index, Random&) const override {
    Vec3 place;
    auto rest = static_cast<std::int64_t>(index);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto steps = static_cast<double>(rest % count_[axis]);
      rest /= count_[axis];
      place[axis] =
          static_cast<float>(spacing_ * (steps - static_cast<double>(count_[axis] - 1) / 2));
    }
    return place;
  }

 private:
  std::array<std::int64_t, 3> count_ = {5, 5, 5};
  double spacing_ = 2;
};

}  // namespace

BrushEntry entry() {
  return {{"lattice", "bodies in rows, columns and layers around the point"},
          makeAs<Brush, LatticeBrush>};
}

}  // namespace broadmark::scenes::lattice_brush
