// FreeFall: bodies fly apart, fall to the floor and come to rest. Much motion at first, hardly any
// at the end.

#include <cmath>
#include <cstdint>

#include "broadmark/scenes/scene.h"
#include "broadmark/scenes/simulation.h"
#include "entries.h"

namespace broadmark::scenes::freefall {
namespace {

float length(const Vec3& v) { return std::hypot(v[0], v[1], v[2]); }

class FreeFall final : public Scene {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"freeze_slow", "freeze slow bodies permanently once the scene has settled",
           &freeze_slow_});
    visit({"freeze_after", "frame after which slow bodies are frozen", &freeze_after_, 0,
           kMaxFrames});
    visit({"freeze_speed", "speed below which a body is slow, in world units per second",
           &freeze_speed_, 0, 1e6});
    visit({"freeze_angular_speed",
           "angular speed below which a body is slow, in radians per second",
           &freeze_angular_speed_, 0, 1e6});
  }

  void act(Stage& stage, std::uint32_t frame) override {
    if (!freeze_slow_ || frame < freeze_after_) return;
    for (const std::uint32_t id : stage.bodies.inEngine()) {
      PhysicsBody& body = *stage.bodies[id];
      if (!body.frozen() && isSlow(body)) body.freeze();
    }
  }

 private:
  [[nodiscard]] bool isSlow(const PhysicsBody& body) const {
    return length(body.linearVelocity()) < freeze_speed_ &&
           length(body.angularVelocity()) < freeze_angular_speed_;
  }

  bool freeze_slow_ = false;
  std::int64_t freeze_after_ = 140;
  double freeze_speed_ = 0.5;
  double freeze_angular_speed_ = 3;
};

}  // namespace

SceneEntry entry() {
  return {{"freefall", "FreeFall", "bodies fall to the floor and come to rest"},
          makeEntry<Scene, FreeFall>};
}

}  // namespace broadmark::scenes::freefall
