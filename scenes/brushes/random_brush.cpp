// Random: bodies at random in a box, as many as give it a density.

#include "broadmark/scenes/brush.h"
#include "brushes/box_space.h"
#include "entries.h"

namespace broadmark::scenes::random_brush {
namespace {

class RandomBrush final : public Brush {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"density", "share of the box that bodies of unit shape and this scale fill", &density_,
           1e-6, 1});
    space_.visitParameters(visit);
  }
  [[nodiscard]] double count(double body_volume) const override {
    const auto& size = space_.size();
    return density_ * size[0] * size[1] * size[2] / body_volume;
  }
  [[nodiscard]] Vec3 place(std::size_t, Random& random) const override {
    return space_.pointInside(random);
  }
  [[nodiscard]] bool scatters() const override { return true; }

 private:
  double density_ = 0.1;
  BoxSpace space_;
};

}  // namespace

BrushEntry entry() {
  return {{"random", "as many bodies, at random in a box, as fill it to a density"},
          makeAs<Brush, RandomBrush>};
}

}  // namespace broadmark::scenes::random_brush
