// Tracks, an export and a bake that use Bullet's tree margin at the same time. The scenes are
// small, because ThreadSanitizer runs this test, too.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "broadmark/algorithms.h"
#include "broadmark/exclusive_use.h"
#include "broadmark/recordings/recording.h"
#include "engine/helpers.h"
#include "inspector/helpers.h"
#include "inspector/session/session.h"

namespace broadmark::tests {
namespace {

/// Runs another algorithm, but reports no pairs.
class Silent final : public BroadPhase {
 public:
  explicit Silent(std::unique_ptr<BroadPhase> inner) : inner_(std::move(inner)) {}

  [[nodiscard]] float margin() const override { return inner_->margin(); }
  void visitParameters(const ParameterVisitor& visit) override { inner_->visitParameters(visit); }
  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    inner_->initialize(scene, first, execution);
  }
  void updateObjects(const Frame& frame) override { inner_->updateObjects(frame); }
  void cleanCache() override { inner_->cleanCache(); }
  void updateStructures() override { inner_->updateStructures(); }
  void searchOverlaps() override { inner_->searchOverlaps(); }
  [[nodiscard]] PairRuns overlaps() const override { return {}; }

 private:
  std::unique_ptr<BroadPhase> inner_;
};

/// A faulty algorithm that uses the margin as dbvt-d does.
Algorithm faultyTree() {
  const std::vector<Algorithm> all = builtinAlgorithms();
  const Algorithm tree = *std::ranges::find(all, "dbvt-d", &Algorithm::id);
  Algorithm faulty = tree;
  faulty.id = "faulty-dbvt";
  faulty.create = [tree] { return std::make_unique<Silent>(tree.create()); };
  return faulty;
}

std::unique_ptr<Simulation> bulletScene() {
  auto scene = makeSimulation("freefall", "bullet");
  setParameters(*scene, {{"objects", "60"}, {"frames", "60"}, {"density", "0.3"}});
  return scene;
}

TEST(Together, LanesAnExportAndABakeShareBulletsTreeMargin) {
  const TemporaryDirectory directory;
  BackgroundBake alone;
  startBake(alone, bulletScene(), directory / "alone.aabbs");
  alone.wait();
  ASSERT_EQ(alone.report().state, TaskState::done) << alone.report().failure;

  Session session(builtinAlgorithms());
  session.draft.choose("brownian");
  setParameters(session.draft.scene(), {{"engine", "kinematic"}});
  setParameters(session.draft.scene(), {{"objects", "150"}, {"frames", "30"}});
  session.draft.simulate();
  const Case faulty{.algorithm = faultyTree()};
  ASSERT_EQ(faulty.algorithm.traits.exclusive, kBulletTreeMargin);
  session.tracks.add(faulty);
  for (const char* margin : {"0.01", "0.7"}) {
    setParameters(*session.tracks.add("dbvt-d").parameters, {{"margin", margin}});
  }
  session.tracks.applyEdits();
  session.mismatches.stop_at_mismatch = false;
  session.playback.seek(10);
  const RunProgress seen = waitUntilIdle(session);
  ASSERT_TRUE(seen.snapshot->difference.isMismatch());

  startBake(session.jobs.get<BackgroundBake>(), bulletScene(), directory / "together.aabbs");
  session.exportCase(faulty, failingIn(seen), directory / "case.aabbs");
  RunProgress last;
  for (int round = 0; round < 50; ++round) {
    session.playback.seek(round % 2 == 0 ? 30 : 4);
    last = waitUntilIdle(session);
    if (round > 0 && !session.jobs.get<BackgroundBake>().running() &&
        !session.jobs.get<CaseExport>().running())
      break;
  }
  session.jobs.get<BackgroundBake>().wait();
  session.jobs.get<CaseExport>().wait();

  EXPECT_EQ(last.tracks[0].status, Status::mismatch);
  for (const std::size_t track : {1U, 2U}) {
    EXPECT_EQ(last.tracks[track].status, Status::ok) << last.tracks[track].reason;
  }
  const CaseExport::Report exported = session.jobs.get<CaseExport>().report();
  EXPECT_EQ(exported.state, TaskState::done) << exported.failure;
  EXPECT_EQ(exported.progress.bodies, 2U);
  ASSERT_EQ(session.jobs.get<BackgroundBake>().report().state, TaskState::done)
      << session.jobs.get<BackgroundBake>().report().failure;
  EXPECT_EQ(openRecordingFile(directory / "together.aabbs")->hash(),
            openRecordingFile(directory / "alone.aabbs")->hash());
}

}  // namespace
}  // namespace broadmark::tests
