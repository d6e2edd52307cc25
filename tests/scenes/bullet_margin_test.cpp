// Bullet's physics beside algorithms that change the margin of Bullet's trees: a bake must not
// depend on them.

#include <gtest/gtest.h>

#include <atomic>
#include <semaphore>
#include <thread>
#include <utility>

#include "broadmark/exclusive_use.h"
#include "engine/helpers.h"
#include "scenes/scene_runs.h"

extern float gDbvtMargin;  // Bullet's, one for the whole process

namespace broadmark::tests {
namespace {

constexpr float kOtherMargin = 0.5F;

/// A thread that changes the margin for a moment when asked to, as algorithms do.
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

  /// Returns once it is changed, for a moment.
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
  std::thread thread_;  // last: uses the others
};

class BulletMargin : public testing::Test {
 protected:
  /// Of a bake of bodies that collide and, in Conveyor, are moved by setPose().
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

    // Every frame begins while it is changed.
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
