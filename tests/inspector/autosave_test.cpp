// Unsaved scenes that survive the end of their process.
#include "inspector/authoring/autosave.h"

#include <gmock/gmock.h>

#include "inspector/inspector_test.h"

namespace broadmark::tests {
namespace {

using scenes::SceneEditor;

constexpr double kLongSeconds = 100;

void addBody(Document& document) {
  document.edit([](SceneEditor& editor) { editor.add({scenes::AuthoredBody{}}); });
}

std::size_t filesIn(const std::filesystem::path& folder) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".json") ++count;
  }
  return count;
}

class AutosaveTest : public testing::Test {
 protected:
  TemporaryDirectory directory;
  std::filesystem::path folder = directory / "state/scenes";
  Session session{builtinAlgorithms()};
  Document& document = session.document;
};

TEST_F(AutosaveTest, KeepsWhatIsNotSavedUntilItIs) {
  Autosave autosave(folder);
  document.load({.name = "Marbles"});
  autosave.update(document, kLongSeconds);
  EXPECT_FALSE(std::filesystem::exists(folder)) << "nothing has changed";
  addBody(document);
  autosave.update(document, 0.1);
  EXPECT_FALSE(std::filesystem::exists(folder)) << "not at every key";
  autosave.update(document, kLongSeconds);
  ASSERT_EQ(filesIn(folder), 1U);
  ASSERT_TRUE(document.save(directory / "marbles.json"));
  autosave.update(document, 0);
  EXPECT_EQ(filesIn(folder), 0U);
}

TEST_F(AutosaveTest, IsDiscardedOnDemand) {
  Autosave autosave(folder);
  document.load({});
  addBody(document);
  autosave.update(document, kLongSeconds);
  ASSERT_EQ(filesIn(folder), 1U);
  autosave.discard();
  EXPECT_EQ(filesIn(folder), 0U);
}

TEST_F(AutosaveTest, IsRecoveredWithItsFileOnceItsProcessHasEnded) {
  ASSERT_TRUE(document.save(directory / "marbles.json"));
  addBody(document);
  {
    Autosave autosave(folder);
    autosave.update(document, kLongSeconds);
    EXPECT_TRUE(Autosave(folder).left().empty()) << "its process lives";
    // Another process keeps its scene beside it.
    Session other(builtinAlgorithms());
    other.document.load({.name = "Other"}, {}, true);
    Autosave beside(folder);
    beside.update(other.document, kLongSeconds);
    EXPECT_EQ(filesIn(folder), 2U);
  }
  Session next(builtinAlgorithms());
  Autosave autosave(folder);
  ASSERT_EQ(autosave.left().size(), 2U);
  EXPECT_EQ(autosave.left()[0].title, "marbles.json");
  EXPECT_EQ(autosave.left()[1].title, "Other");
  autosave.recover(autosave.left()[0], next.document);
  EXPECT_EQ(next.document.path(), directory / "marbles.json");
  EXPECT_EQ(next.document.editor.scene(), document.editor.scene());
  EXPECT_TRUE(next.document.isModified());
  EXPECT_EQ(autosave.left().size(), 1U);
  EXPECT_EQ(filesIn(folder), 2U) << "kept until it is saved";
  ASSERT_TRUE(next.document.save(next.document.path()));
  autosave.update(next.document, 0);
  EXPECT_EQ(filesIn(folder), 1U);
}

TEST_F(AutosaveTest, AFolderThatCannotBeWrittenIsReportedOnce) {
  writeTextFile(directory / "state", "a file");
  Autosave autosave(folder);
  document.load({}, {}, true);
  EXPECT_THROW(autosave.update(document, kLongSeconds), InputError);
  EXPECT_NO_THROW(autosave.update(document, kLongSeconds));
}

class RecoveryTest : public InspectorTest {
 protected:
  RecoveryTest() : InspectorTest({}, leaveScene()) {}

  static std::filesystem::path leaveScene() {
    static const TemporaryDirectory directory;
    Session session(builtinAlgorithms());
    session.document.load({.name = "Marbles"});
    addBody(session.document);
    Autosave(directory / "scenes").update(session.document, kLongSeconds);
    return directory / "scenes";
  }
};

TEST_F(RecoveryTest, IsOfferedByTheStartPage) {
  draw(2);
  EXPECT_EQ(value("recoverable"), "1");
  click("Start/Not saved/Marbles");
  waitUntilIdle();
  EXPECT_EQ(value("error"), "");
  EXPECT_EQ(value("author.bodies"), "1");
  EXPECT_EQ(value("author.modified"), "yes");
  EXPECT_EQ(value("recoverable"), "0");
}

}  // namespace
}  // namespace broadmark::tests
