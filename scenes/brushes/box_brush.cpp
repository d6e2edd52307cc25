// Box: bodies at random in a box.

#include <array>

#include "broadmark/scenes/brush.h"

namespace broadmark::scenes::box_brush {
namespace {

class BoxBrush final : public Brush {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"count", "number of bodies", &count_, 1, 10'000'000});
    visit({"size_x", "size of the box along x, in world units", &size_[0], 1e-3, 1e6});
    visit({"size_y", "size of the box along y, in world units", &size_[1], 1e-3, 1e6});
    visit({"size_z", "size of the box along z, in world units", &size_[2], 1e-3, 1e6});
  }
  [[nodiscard]] double count(double) const override { return static_cast<double>(count_); }
  [[nodiscard]] Vec3 place(std::size_t, Random& random) const override {
    Vec3 place;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      place[axis] = static_cast<float>(random.between(-size_[axis] / 2, size_[axis] / 2));
    }
    return place;
  }
  [[nodiscard]] bool scatters() const override { return true; }

 private:
  std::int64_t count_ = 100;
  std::array<double, 3> size_ = {10, 10, 10};
};

}  // namespace

BrushEntry entry() {
  return {.listing = {"box", "bodies at random in a box"},
          .create = []() -> std::unique_ptr<Brush> { return std::make_unique<BoxBrush>(); }};
}

}  // namespace broadmark::scenes::box_brush
