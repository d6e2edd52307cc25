// Authoring in the session, without drawing.
#include "inspector/session/document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadmark/algorithms.h"
#include "broadmark/files.h"
#include "engine/helpers.h"
#include "inspector/helpers.h"
#include "inspector/session/session.h"

namespace broadmark::tests {
namespace {

using scenes::AuthoredBody;
using scenes::AuthoredScene;
using scenes::SceneEditor;

AuthoredScene threeBodies() {
  AuthoredScene scene{.name = "Three", .parameters = {{"frames", "12"}}};
  for (int i = 0; i < 3; ++i) {
    AuthoredBody body;
    body.pose.position = {2.0F * static_cast<float>(i), 1, 0};
    body.linear_velocity = {0, 0, static_cast<float>(i)};
    scene.bodies.push_back(body);
  }
  scene.bodies[2].shape = scenes::SphereShape{0.4F};
  return scene;
}

class AuthoringTest : public testing::Test {
 protected:
  RunProgress waitUntilIdle() { return tests::waitUntilIdle(session); }

  Session session{builtinAlgorithms()};
  TemporaryDirectory directory;
};

TEST_F(AuthoringTest, AnEmptySceneIsShownAndRunByEveryAlgorithm) {
  for (const Algorithm& algorithm : builtinAlgorithms()) {
    if (algorithm.family != "GPU") session.tracks.add(algorithm.id);
  }
  session.document.load({});
  const RunProgress seen = waitUntilIdle();
  ASSERT_TRUE(seen.snapshot);
  EXPECT_TRUE(seen.snapshot->boxes->empty());
  EXPECT_TRUE(session.document.atRest());
  EXPECT_FALSE(session.document.isModified());
  EXPECT_TRUE(session.notices.errors.empty());
}

TEST_F(AuthoringTest, EveryEditIsShownAndUndoneAndTheSceneStaysTheSame) {
  session.document.load(threeBodies());
  const RunProgress first = waitUntilIdle();
  ASSERT_EQ(first.snapshot->boxes->size(), 3U);
  const std::uint64_t scene = first.source->scene;
  EXPECT_NE(scene, 0U);
  session.selection.select({1});
  session.document.edit([](SceneEditor& editor) { editor.duplicate({0, 5, 0}); });
  RunProgress seen = waitUntilIdle();
  EXPECT_EQ(seen.source->scene, scene);
  EXPECT_EQ(*seen.snapshot->boxes, boxesOf(session.document.editor.scene()));
  EXPECT_EQ(session.selection.bodies(), std::vector<std::uint32_t>{3});
  EXPECT_TRUE(session.document.isModified());
  session.document.edit(&SceneEditor::undo);
  seen = waitUntilIdle();
  EXPECT_EQ(*seen.snapshot->boxes, *first.snapshot->boxes);
  EXPECT_EQ(session.selection.bodies(), std::vector<std::uint32_t>{1});
  EXPECT_FALSE(session.document.isModified());
}

TEST_F(AuthoringTest, SelectionOfViewAndEditorAreTheSame) {
  session.document.load(threeBodies());
  waitUntilIdle();
  session.selection.select({2, 0, 7});
  EXPECT_THAT(session.document.editor.selection(), testing::ElementsAre(0, 2));
  session.selection.toggle({1});
  session.selection.toggle({0});
  EXPECT_THAT(session.document.editor.selection(), testing::ElementsAre(1, 2));
  session.selection.toggle({0, 1});
  EXPECT_THAT(session.selection.bodies(), testing::ElementsAre(0, 1, 2)) << "not all of them were";
  session.selection.toggle({0, 1});
  EXPECT_THAT(session.selection.bodies(), testing::ElementsAre(2));
  session.document.edit(&SceneEditor::selectAll);
  EXPECT_THAT(session.selection.bodies(), testing::ElementsAre(0, 1, 2));
  // The document ignores the selection in other recordings.
  setParameters(session.draft.scene(), {{"objects", "40"}, {"frames", "5"}});
  session.draft.simulate();
  waitUntilIdle();
  session.selection.select({30});
  EXPECT_EQ(session.document.editor.selection().size(), 3U);
}

TEST_F(AuthoringTest, GroupsOfTheDocumentAreSelectedAsOne) {
  session.document.load(threeBodies());
  waitUntilIdle();
  session.selection.select({0, 2});
  session.document.edit(&SceneEditor::group);
  EXPECT_THAT(session.selection.withGroups({2}), testing::ElementsAre(0, 2));
  EXPECT_THAT(session.selection.withGroups({1}), testing::ElementsAre(1));
  session.draft.simulate();
  waitUntilIdle();
  EXPECT_THAT(session.selection.withGroups({2}), testing::ElementsAre(2)) << "of another scene";
}

TEST_F(AuthoringTest, AnotherWorldIsAnotherSceneToLookAt) {
  session.document.load(threeBodies());
  const std::uint64_t before = waitUntilIdle().source->scene;
  session.document.edit([](SceneEditor& e) { e.setWorld({{-99, -99, -99, 0}, {99, 99, 99, 0}}); });
  EXPECT_NE(waitUntilIdle().source->scene, before);
}

TEST_F(AuthoringTest, ABadEditIsAnErrorAndChangesNothing) {
  session.document.load(threeBodies());
  waitUntilIdle();
  session.document.edit([](SceneEditor& editor) { editor.setName("a/b"); });
  EXPECT_EQ(session.notices.errors.size(), 1U);
  EXPECT_EQ(session.document.editor.scene(), threeBodies());
}

TEST_F(AuthoringTest, SavedAndOpenedAgainItIsTheSame) {
  session.document.load(threeBodies());
  session.document.edit([](SceneEditor& editor) {
    editor.selectAll();
    editor.transform("turn", {.centre = editor.selectionCentre(), .turn = {0, 0.6F, 0, 0.8F}});
  });
  const AuthoredScene scene = session.document.editor.scene();
  EXPECT_TRUE(session.document.save(directory / "three"));  // the document appends the extension
  EXPECT_EQ(session.document.path(), directory / "three.json");
  EXPECT_FALSE(session.document.isModified());
  session.document.load({});
  session.open(directory / "three.json");
  waitUntilIdle();
  EXPECT_TRUE(session.notices.errors.empty());
  EXPECT_TRUE(session.document.shown());
  EXPECT_EQ(session.document.editor.scene(), scene);
  EXPECT_TRUE(session.document.save(directory / "again.json"));
  EXPECT_EQ(readTextFile(directory / "again.json"), readTextFile(directory / "three.json"));
}

TEST_F(AuthoringTest, BadFilesAreErrorsAndTheDocumentStays) {
  session.document.load(threeBodies());
  waitUntilIdle();
  writeTextFile(directory / "bad.json", R"({"schema": "broadmark-scene/1", "bodies": 3})");
  session.open(directory / "bad.json");
  session.open(directory / "missing.json");
  EXPECT_FALSE(session.document.save(directory / "no such" / "directory.json"));
  ASSERT_EQ(session.notices.errors.size(), 3U);
  EXPECT_THAT(session.notices.errors[0], testing::HasSubstr("bad.json"));
  EXPECT_THAT(session.notices.errors[1], testing::HasSubstr("missing.json"));
  EXPECT_THAT(session.notices.errors[2], testing::HasSubstr("no such"));
  EXPECT_EQ(session.document.editor.scene(), threeBodies());
}

TEST_F(AuthoringTest, UnsavedChangesWaitForADecision) {
  session.document.load(threeBodies());
  int left = 0;
  session.document.closeThen([&] { ++left; });
  EXPECT_EQ(left, 1);
  session.document.edit([](SceneEditor& editor) { editor.setName("Other"); });
  session.document.closeThen([&] { ++left; });
  EXPECT_EQ(left, 1);
  ASSERT_TRUE(session.document.pending_close);
  session.document.pending_close();
  EXPECT_EQ(left, 2);
}

TEST_F(AuthoringTest, PlayingSimulatesAndAnEditReturnsToTheStart) {
  session.document.load(threeBodies());
  waitUntilIdle();
  session.play(true);
  EXPECT_TRUE(session.document.shown());
  EXPECT_FALSE(session.document.atRest());
  session.playback.seek(12);
  RunProgress seen = waitUntilIdle();
  EXPECT_EQ(seen.scene.frames, 12U);
  EXPECT_EQ(seen.snapshot->frame, 12U);
  EXPECT_NE(*seen.snapshot->boxes, boxesOf(session.document.editor.scene()));
  session.document.edit([](SceneEditor& editor) { editor.setName("Other"); });
  seen = waitUntilIdle();
  EXPECT_TRUE(session.document.atRest());
  EXPECT_EQ(*seen.snapshot->boxes, boxesOf(session.document.editor.scene()));
}

TEST_F(AuthoringTest, AFrameOfASimulationBecomesADocumentWithVelocities) {
  setParameters(session.draft.scene(), {{"objects", "30"}, {"frames", "20"}});
  session.draft.simulate();
  session.playback.seek(9);
  const RunProgress live = waitUntilIdle();
  session.document.loadCurrentFrame();
  const RunProgress seen = waitUntilIdle();
  EXPECT_TRUE(session.notices.errors.empty());
  EXPECT_TRUE(session.document.atRest());
  EXPECT_TRUE(session.document.isModified());
  EXPECT_EQ(*seen.snapshot->boxes, *live.snapshot->boxes);
  const auto& bodies = session.document.editor.scene().bodies;
  ASSERT_EQ(bodies.size(), 30U);
  EXPECT_TRUE(std::ranges::any_of(
      bodies, [](const AuthoredBody& body) { return body.linear_velocity[1] < 0; }));
}

TEST_F(AuthoringTest, AFrameOfARecordingBecomesADocument) {
  setParameters(session.draft.scene(), {{"objects", "30"}, {"frames", "20"}});
  session.draft.simulate();
  session.playback.seek(9);
  waitUntilIdle();
  saveRecording(session, directory / "some.aabbs");
  waitUntilIdle();
  session.open(directory / "some.aabbs");
  waitUntilIdle();
  session.playback.seek(4);
  const RunProgress recorded = waitUntilIdle();
  session.document.loadCurrentFrame();
  const RunProgress seen = waitUntilIdle();
  EXPECT_TRUE(session.notices.errors.empty());
  EXPECT_EQ(seen.snapshot->boxes->size(), recorded.snapshot->boxes->size());
  EXPECT_TRUE(session.document.atRest());
}

TEST_F(AuthoringTest, BrushesPaintWhereTheyAreTold) {
  session.document.load({});
  Document& document = session.document;
  for (std::size_t brush = 0; brush < document.brushes.size(); ++brush) {
    document.chooseBrush(brush);
    document.paint_at = {100.0F * static_cast<float>(brush), 0, 0};
    const std::size_t before = document.editor.scene().bodies.size();
    document.add([&] { return document.stroke(); });
    EXPECT_GT(document.editor.scene().bodies.size(), before) << document.brushes[brush].listing.id;
    EXPECT_NEAR(document.editor.selectionCentre()[0], document.paint_at[0], 12);
  }
  EXPECT_EQ(waitUntilIdle().snapshot->boxes->size(), document.editor.scene().bodies.size());
}

TEST_F(AuthoringTest, BakesTheWholeScene) {
  session.document.load(threeBodies());
  session.document.bake(directory / "three");
  session.jobs.get<BackgroundBake>().wait();
  waitUntilIdle();
  EXPECT_TRUE(session.notices.errors.empty());
  EXPECT_EQ(session.jobs.get<BackgroundBake>().report().state, TaskState::done);
  session.open(directory / "three.aabbs");
  const RunProgress seen = waitUntilIdle();
  EXPECT_EQ(seen.scene.frames, 12U);
  EXPECT_EQ(seen.scene.objects, 3U);
  EXPECT_EQ(seen.scene.name, "Three");
}

}  // namespace
}  // namespace broadmark::tests
