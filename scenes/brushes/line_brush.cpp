// Line: bodies in a row, at even distances.

#include <array>

#include "brushes/counted_brush.h"
#include "entries.h"

namespace broadmark::scenes::line_brush {
namespace {

class LineBrush final : public CountedBrush<10> {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    CountedBrush::visitParameters(visit);
    visit(
        {"step_x", "way from one body to the next along x, in world units", &step_[0], -1e6, 1e6});
    visit(
        {"step_y", "way from one body to the next along y, in world units", &step_[1], -1e6, 1e6});
    visit(
        {"step_z", "way from one body to the next along z, in world units", &step_[2], -1e6, 1e6});
  }
  [[nodiscard]] Vec3 place(std::size_t index, Random&) const override {
    Vec3 place;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      place[axis] = static_cast<float>(static_cast<double>(index) * step_[axis]);
    }
    return place;
  }

 private:
  std::array<double, 3> step_ = {1, 0, 0};
};

}  // namespace

BrushEntry entry() {
  return {{"line", "bodies in a row, beginning at the point"}, makeAs<Brush, LineBrush>};
}

}  // namespace broadmark::scenes::line_brush
