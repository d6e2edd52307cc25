// Ball: bodies at random in a ball.

#include "brushes/counted_brush.h"
#include "entries.h"

namespace broadmark::scenes::ball_brush {
namespace {

class BallBrush final : public CountedBrush<100> {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    CountedBrush::visitParameters(visit);
    visit({"radius", "radius of the ball, in world units", &radius_, 1e-3, 1e6});
  }
  [[nodiscard]] Vec3 place(std::size_t, Random& random) const override {
    return random.inBall(radius_);
  }
  [[nodiscard]] bool scatters() const override { return true; }

 private:
  double radius_ = 5;
};

}  // namespace

BrushEntry entry() { return {{"ball", "bodies at random in a ball"}, makeAs<Brush, BallBrush>}; }

}  // namespace broadmark::scenes::ball_brush
