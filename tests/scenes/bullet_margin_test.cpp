// Bullet's physics beside algorithms that change the margin of Bullet's trees: a bake must not
// depend on them.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <utility>

#include "broadmark/exclusive_use.h"
#include "engine/helpers.h"
#include "scenes/scene_runs.h"

extern float gDbvtMargin;  // Bullet's, one for the whole process

namespace broadmark::tests {
namespace {

constexpr float kOtherMargin = 0.5F;

/// A thread that keeps changing the margin for a short time, as algorithms do.
class MarginChanger {
 public:
  MarginChanger() : thread_([this] { run(); }) {
    while (changes_ == 0) std::this_thread::yield();
  }
  ~MarginChanger() {
    stopped_ = true;
    thread_.join();
  }
  MarginChanger(const MarginChanger&) = delete;
  MarginChanger& operator=(const MarginChanger&) = delete;

  [[nodiscard]] int changes() const { return changes_; }

 private:
  void run() {
    while (!stopped_) {
      const ExclusiveUse use(kBulletTreeMargin);
      const float before = std::exchange(gDbvtMargin, kOtherMargin);
      std::this_thread::sleep_for(std::chrono::microseconds(200));
      gDbvtMargin = before;
      ++changes_;
    }
  }

  std::atomic<bool> stopped_ = false;
  std::atomic<int> changes_ = 0;
  std::thread thread_;  // last: uses the others
};

class BulletMargin : public testing::Test {
 protected:
  /// Of a bake of bodies that collide and, in Conveyor, are moved by setPose().
  std::string hashOfBake(const std::string& scene) {
    const auto path = directory_ / "scene.aabbs";
    const auto simulation =
        sceneWith(scene, {{"objects", "200"}, {"frames", "40"}, {"density", "0.2"}}, "bullet");
    EXPECT_TRUE(bake(*simulation, {path}));
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

    const MarginChanger changer;
    EXPECT_EQ(hashOfBake(scene), alone) << scene;
    EXPECT_GT(changer.changes(), 10) << scene;
  }
}

}  // namespace
}  // namespace broadmark::tests
