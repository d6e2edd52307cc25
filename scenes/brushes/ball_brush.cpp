// Ball: bodies at random in a ball.

#include "broadmark/scenes/brush.h"

namespace broadmark::scenes::ball_brush {
namespace {

class BallBrush final : public Brush {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"count", "number of bodies", &count_, 1, 10'000'000});
    visit({"radius", "radius of the ball, in world units", &radius_, 1e-3, 1e6});
  }
  [[nodiscard]] double count(double) const override { return static_cast<double>(count_); }
  [[nodiscard]] Vec3 place(std::size_t, Random& random) const override {
    return random.inBall(radius_);
  }
  [[nodiscard]] bool scatters() const override { return true; }

 private:
  std::int64_t count_ = 100;
  double radius_ = 5;
};

}  // namespace

BrushEntry entry() {
  return {.listing = {"ball", "bodies at random in a ball"},
          .create = []() -> std::unique_ptr<Brush> { return std::make_unique<BallBrush>(); }};
}

}  // namespace broadmark::scenes::ball_brush
