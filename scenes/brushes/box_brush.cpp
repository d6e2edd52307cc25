// Box: bodies at random in a box.

#include "brushes/box_space.h"
#include "brushes/counted_brush.h"
#include "entries.h"

namespace broadmark::scenes::box_brush {
namespace {

class BoxBrush final : public CountedBrush<100> {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    CountedBrush::visitParameters(visit);
    space_.visitParameters(visit);
  }
  [[nodiscard]] Vec3 place(std::size_t, Random& random) const override {
    return space_.pointInside(random);
  }
  [[nodiscard]] bool scatters() const override { return true; }

 private:
  BoxSpace space_;
};

}  // namespace

BrushEntry entry() { return {{"box", "bodies at random in a box"}, makeAs<Brush, BoxBrush>}; }

}  // namespace broadmark::scenes::box_brush
