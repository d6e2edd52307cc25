// A physics engine that fails on purpose, and otherwise moves nothing.

#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>

#include "broadmark/scenes/body_pool.h"
#include "broadmark/scenes/engine_plugin.h"

namespace broadmark::scenes {
namespace {

class StillBody : public PhysicsBody {
 public:
  explicit StillBody(const BodyDescription& body) : shape_(body.shape), pose_(body.pose) {}

  [[nodiscard]] const Shape& shape() const override { return shape_; }
  [[nodiscard]] Pose pose() const override { return pose_; }
  [[nodiscard]] Vec3 linearVelocity() const override { return {}; }
  [[nodiscard]] Vec3 angularVelocity() const override { return {}; }
  void setPose(const Pose& pose) override { pose_ = pose; }
  void setVelocity(const Vec3& /*linear*/, const Vec3& /*angular*/) override {}
  [[nodiscard]] bool asleep() const override { return false; }
  [[nodiscard]] bool frozen() const override { return false; }
  void freeze() override {}

 private:
  Shape shape_;
  Pose pose_;
};

class UnrulyEngine final : public PhysicsEngine {
 public:
  void visitParameters(const ParameterVisitor& visit) override {
    visit({"engine_deed", "what it does in the second frame", &deed_});
  }
  void setLayers(const LayerMatrix& /*layers*/) override {}
  PhysicsBody& addBody(const BodyDescription& body) override { return bodies_.add(body); }
  void removeBody(PhysicsBody& body) override { bodies_.remove(static_cast<StillBody&>(body)); }
  void addWall(const HalfSpace& /*wall*/) override {}
  void setGravity(const Vec3& gravity) override { gravity_ = gravity; }
  [[nodiscard]] Vec3 gravity() const override { return gravity_; }
  void step() override {
    if (++steps_ != 2) return;
    if (deed_.value == "throw") throw std::runtime_error("thrown on purpose");
    if (deed_.value == "throw-number") throw 42;
    if (deed_.value == "crash" || deed_.value == "die") {
      const rlimit none{0, 0};
      ::setrlimit(RLIMIT_CORE, &none);                          // no core dump
      if (deed_.value == "die") std::signal(SIGSEGV, SIG_DFL);  // past all handlers
      std::raise(SIGSEGV);
    }
    if (deed_.value == "abort") std::abort();
    if (deed_.value == "hang") {
      std::fputs("hanging on purpose\n", stderr);
      while (true) ::pause();
    }
  }
  [[nodiscard]] bool allAsleep() const override { return false; }

 private:
  Choice deed_{"none", {"none", "throw", "throw-number", "crash", "die", "abort", "hang"}};
  int steps_ = 0;
  Vec3 gravity_{};
  BodyPool<StillBody> bodies_;
};

std::vector<EngineEntry> engines() {
  return {{.listing = {.id = "unruly",
                       .summary = "crashes, hangs or throws when asked to",
                       .dynamics = Dynamics::scripted},
           .create = [](const PhysicsSettings&) -> std::unique_ptr<PhysicsEngine> {
             return std::make_unique<UnrulyEngine>();
           }}};
}

}  // namespace
}  // namespace broadmark::scenes

BROADMARK_ENGINE_PLUGIN(broadmark::scenes::engines);
