// Saving the available frames as a recording, in the background.
#include "inspector/jobs/background_save.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>

#include "broadmark/error.h"
#include "engine/helpers.h"
#include "inspector/inspector_test.h"
#include "support/wandering_boxes.h"

namespace broadmark::tests {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kFrames = 20;

/// Frames that call `before` with the index of each.
class WatchedFrames final : public FrameSource {
 public:
  explicit WatchedFrames(std::function<void(std::uint32_t)> before) : before_(std::move(before)) {}

  [[nodiscard]] const SceneInfo& scene() const override { return frames_.scene(); }
  Frame rewind() override { return watched(frames_.rewind()); }
  std::optional<Frame> next() override {
    const std::optional<Frame> frame = frames_.next();
    if (frame) watched(*frame);
    return frame;
  }

 private:
  Frame watched(const Frame& frame) {
    before_(frame.index);
    return frame;
  }

  WanderingBoxes frames_{50, kFrames, 1};
  std::function<void(std::uint32_t)> before_;
};

std::size_t filesIn(const TemporaryDirectory& directory) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(directory / ""), {}));
}

TEST(BackgroundSave, WhenCancelledLeavesNoFileAndCanFollowAgain) {
  const TemporaryDirectory directory;
  const fs::path file = directory / "a.aabbs";
  BackgroundSave save;
  for (const std::uint32_t last : {0U, 7U, kFrames}) {
    std::uint32_t reached = 0;
    startSave(save, std::make_unique<WatchedFrames>([&](std::uint32_t frame) {
                reached = frame;
                if (frame == last) save.cancel();
              }),
              file);
    save.wait();
    EXPECT_EQ(save.report().state, TaskState::cancelled);
    EXPECT_EQ(save.status().file, "");
    EXPECT_EQ(reached, last);
    EXPECT_EQ(filesIn(directory), 0U);
  }
  startSave(save, std::make_unique<WatchedFrames>([](std::uint32_t) {}), file);
  save.wait();
  EXPECT_EQ(save.report().state, TaskState::done) << save.report().failure;
  EXPECT_EQ(save.status().file, file);
  EXPECT_EQ(openRecordingFile(file)->scene().frames, kFrames);
}

TEST(BackgroundSave, WhenCancelledKeepsTheFormerFile) {
  const TemporaryDirectory directory;
  const fs::path file = directory / "a.aabbs";
  writeTextFile(file, "former");
  BackgroundSave save;
  startSave(save, std::make_unique<WatchedFrames>([&](std::uint32_t) { save.cancel(); }), file);
  save.wait();
  EXPECT_EQ(readTextFile(file), "former");
  EXPECT_EQ(filesIn(directory), 1U);
}

TEST(BackgroundSave, SaysAtOnceWhereItCannotWrite) {
  const TemporaryDirectory directory;
  BackgroundSave save;
  EXPECT_THROW(startSave(save, std::make_unique<WatchedFrames>([](std::uint32_t) {}),
                         directory / "no" / "a.aabbs"),
               InputError);
  EXPECT_EQ(save.report().state, TaskState::idle);
}

TEST_F(InspectorTest, TheStatusLineCancelsASave) {
  std::mutex mutex;
  std::condition_variable changed;
  bool reached = false;
  bool goes_on = false;
  BackgroundSave& save = inspector.session().jobs.get<BackgroundSave>();
  startSave(save, std::make_unique<WatchedFrames>([&](std::uint32_t frame) {
              if (frame != 10) return;
              std::unique_lock lock(mutex);
              reached = true;
              changed.notify_all();
              changed.wait(lock, [&] { return goes_on; });
            }),
            directory / "a.aabbs");
  {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return reached; });
  }
  draw(2);
  click("Status/Cancel");
  waitUntilIdle();
  EXPECT_TRUE(save.cancelled());
  {
    const std::lock_guard lock(mutex);
    goes_on = true;
  }
  changed.notify_all();
  save.wait();
  EXPECT_EQ(value("save.state"), "cancelled");
  draw(2);
  EXPECT_FALSE(isShown("Status/Cancel"));
  EXPECT_FALSE(fs::exists(directory / "a.aabbs"));
}

}  // namespace
}  // namespace broadmark::tests
