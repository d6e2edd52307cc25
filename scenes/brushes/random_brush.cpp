// Random: as many bodies as give a box this density.

#include <array>

#include "broadmark/scenes/brush.h"

namespace broadmark::scenes::random_brush {
namespace {

class RandomBrush final : public Brush {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"density", "share of the box that bodies of unit shape and this scale fill", &density_,
           1e-6, 1});
    visit({"size_x", "size of the box along x, in world units", &size_[0], 1e-3, 1e6});
    visit({"size_y", "size of the box along y, in world units", &size_[1], 1e-3, 1e6});
    visit({"size_z", "size of the box along z, in world units", &size_[2], 1e-3, 1e6});
  }
  [[nodiscard]] double count(double body_volume) const override {
    return density_ * size_[0] * size_[1] * size_[2] / body_volume;
  }
  [[nodiscard]] Vec3 place(std::size_t, Random& random) const override {
    Vec3 place;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      place[axis] = static_cast<float>(random.between(-size_[axis] / 2, size_[axis] / 2));
    }
    return place;
  }
  [[nodiscard]] bool scatters() const override { return true; }

 private:
  double density_ = 0.1;
  std::array<double, 3> size_ = {10, 10, 10};
};

}  // namespace

BrushEntry entry() {
  return {.listing = {"random", "as many bodies, at random in a box, as fill it to a density"},
          .create = []() -> std::unique_ptr<Brush> { return std::make_unique<RandomBrush>(); }};
}

}  // namespace broadmark::scenes::random_brush
