// Algorithms change the margin of Bullet's trees, a global variable. Bakes with Bullet's physics
// must not depend on it.

#include <gtest/gtest.h>

#include <atomic>
#include <semaphore>
#include <thread>
#include <utility>

#include "broadmark/exclusive_use.h"
#include "engine/helpers.h"
#include "scenes/scene_runs.h"

extern float gDbvtMargin;  // Bullet's global variable

namespace broadmark::tests {
namespace {

constexpr float kOtherMargin = 0.5F;

/// A thread that changes the margin briefly on request, as algorithms do.
class MarginChanger {
 public:
  MarginChanger() : thread_([this] { run(); }) {}
  ~MarginChanger() {
    stopped_ = true;
    wanted_.release();
    thread_.join();
  }
  MarginChanger(const MarginChanger&) = delete;
  MarginChanger& operator=(const MarginChanger&) = delete;

  /// Returns when the margin has changed, before it is restored.
  void change() {
    wanted_.release();
    changed_.acquire();
  }

 private:
  void run() {
    for (wanted_.acquire(); !stopped_; wanted_.acquire()) {
      const ExclusiveUse use(kBulletTreeMargin);
      const float before = std::exchange(gDbvtMargin, kOtherMargin);
      changed_.release();
      for (int turn = 0; turn < 20; ++turn) std::this_thread::yield();
      gDbvtMargin = before;
    }
  }

  std::atomic<bool> stopped_ = false;
  std::binary_semaphore wanted_{0};
  std::binary_semaphore changed_{0};
  std::thread thread_;  // last, because it uses the members above
};

class BulletMargin : public testing::Test {
 protected:
  /// The hash of a bake of colliding bodies; Conveyor also moves bodies by setPose().
  std::string hashOfBake(const std::string& scene, const FrameProgress& progress = {}) {
    const auto path = directory_ / "scene.aabbs";
    const auto simulation =
        sceneWith(scene, {{"objects", "200"}, {"frames", "40"}, {"density", "0.2"}}, "bullet");
    EXPECT_TRUE(bake(*simulation, {path}, progress));
    return bakedHash(path).value_or("");
  }

  TemporaryDirectory directory_;
};

TEST_F(BulletMargin, ChangedByOthersDoesNotChangeABake) {
  for (const std::string scene : {"brownian", "conveyor"}) {
    const std::string alone = hashOfBake(scene);
    const float before = std::exchange(gDbvtMargin, kOtherMargin);
    EXPECT_NE(hashOfBake(scene), alone) << scene << ": this margin makes no difference";
    gDbvtMargin = before;

    // Every frame begins while the margin is changed.
    MarginChanger changer;
    const auto change = [&changer](std::uint32_t) {
      changer.change();
      return true;
    };
    EXPECT_EQ(hashOfBake(scene, change), alone) << scene;
  }
}

}  // namespace
}  // namespace broadmark::tests
