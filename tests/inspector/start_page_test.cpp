// The start page: examples, recent files, what is dropped.
#include <gmock/gmock.h>

#include "inspector/inspector_test.h"
#include "inspector/session/examples.h"
#include "request/plugins.h"

namespace broadmark::tests {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class StartPageTest : public InspectorTest {
 protected:
  StartPageTest() {
    width = 1440;
    height = 900;
    draw(2);
  }

  /// Draws until playback has stopped.
  void waitForStop() {
    for (int i = 0; i < 600 && value("stop_frame").empty(); ++i) {
      draw();
      inspector.session().runs.waitUntilIdle(kForever);
    }
    waitUntilIdle();
  }
};

TEST_F(StartPageTest, EveryExampleMoves) {
  ASSERT_EQ(examples().size(), 6U);
  const Picture first = picture();
  draw(12);
  const Picture later = picture();
  for (const Example& example : examples()) {
    const WidgetPlace* const place = inspector.ui().find(std::string("Start/") + example.name);
    ASSERT_NE(place, nullptr) << example.name;
    int changed = 0;
    for (int y = static_cast<int>(place->min.y); y < static_cast<int>(place->max.y); ++y) {
      for (int x = static_cast<int>(place->min.x); x < static_cast<int>(place->max.x); ++x) {
        const auto at = 4 * (static_cast<std::size_t>(y) * 1440 + static_cast<std::size_t>(x));
        if (!std::equal(&first.rgba[at], &first.rgba[at + 4], &later.rgba[at])) ++changed;
      }
    }
    EXPECT_GT(changed, 100) << example.name;
  }
}

TEST_F(StartPageTest, EveryExampleOpensByAClick) {
  for (const Example& example : examples()) {
    if (example.objects > 10'000) continue;  // it is like others
    click("Help");
    draw(3);
    click("Help/Start page");
    draw(3);
    EXPECT_EQ(value("start_page"), "yes");
    click(std::string("Start/") + example.name);
    waitUntilIdle();
    EXPECT_EQ(value("start_page"), "no");
    EXPECT_EQ(value("error"), "");
    EXPECT_GT(std::stoi(value("bodies")), 50) << example.name;
    EXPECT_EQ(value("algorithms"), example.beside ? "2" : "1") << example.name;
    EXPECT_EQ(value("second"), example.beside ? "yes" : "no") << example.name;
    EXPECT_EQ(value("playing"), "yes") << example.name;
  }
}

TEST_F(StartPageTest, AnUncheckedExampleEndsWithItsScene) {
  Example unchecked = examples().front();
  unchecked.check = false;
  openExample(inspector.session(), unchecked);
  waitUntilIdle();
  EXPECT_EQ(value("check"), "no");
  inspector.session().draft.simulate();
  EXPECT_EQ(value("check"), "yes");
}

TEST_F(StartPageTest, TheBugIsFoundByReturn) {
  for (int i = 0; i < 4; ++i) key(GLFW_KEY_RIGHT);
  key(GLFW_KEY_ENTER);
  waitForStop();
  EXPECT_EQ(value("error"), "");
  EXPECT_THAT(value("status"), HasSubstr("c-sweep is wrong"));
  EXPECT_EQ(value("missed"), "1");
  EXPECT_EQ(value("pair.gap.x"), "0") << "the boxes touch";
  EXPECT_EQ(value("panel.right"), "Mismatches");
  EXPECT_EQ(value("author.modified"), "no");
  // The mistake loses pairs while boxes touch, and only then.
  key(GLFW_KEY_RIGHT);
  waitUntilIdle();
  EXPECT_EQ(value("missed"), "0");
  EXPECT_EQ(value("pairs"), "1");
}

TEST_F(StartPageTest, TheBugAsksBeforeUnsavedChangesAreLost) {
  Session& session = inspector.session();
  session.document.load({}, {}, true);
  waitUntilIdle();
  click("Help");
  draw(3);
  click("Help/Start page");
  draw(3);
  click("Start/Find the bug");
  draw(8);  // a dialog finds its size in the first pictures
  EXPECT_EQ(value("author.leaving"), "yes");
  click("Unsaved/Cancel");
  waitUntilIdle();
  EXPECT_EQ(value("author.name"), "Untitled");
  EXPECT_EQ(value("algorithms"), "0");
  EXPECT_EQ(value("author.leaving"), "no");
  EXPECT_EQ(value("popup"), "no");
  key(GLFW_KEY_ESCAPE);
  draw(2);
  EXPECT_EQ(value("start_page"), "no");
}

TEST_F(StartPageTest, ThePanelsAtTheBottomAppearOnRequest) {
  EXPECT_FALSE(isShown("Timeline"));
  EXPECT_FALSE(isShown("Playback/Play"));
  ctrl(GLFW_KEY_5);
  draw(4);
  EXPECT_TRUE(isShown("Timeline"));
  EXPECT_TRUE(isShown("Playback/Play"));
  EXPECT_EQ(value("start_page"), "yes");
}

TEST_F(StartPageTest, ADroppedLibraryAddsItsAlgorithms) {
  inspector.session().open(shippedPlugin("find-the-bug"));
  draw(3);
  EXPECT_EQ(value("error"), "");
  EXPECT_EQ(value("shown_algorithm"), "c-sweep");
  EXPECT_EQ(value("start_page"), "yes") << "there is no scene yet";
}

TEST_F(StartPageTest, RecentFilesAreListed) {
  const std::filesystem::path file = vanishingBodies(directory, 40);
  inspector.session().open(file);
  waitUntilIdle();
  click("Help");
  draw(3);
  click("Help/Start page");
  draw(3);
  inspector.session().draft.simulate();
  waitUntilIdle();
  click("Help");
  draw(3);
  click("Help/Start page");
  draw(3);
  click("Start/Recent files/vanishing.broadmark");
  waitUntilIdle();
  EXPECT_THAT(value("source"), StartsWith("recording: vanishing"));
}

TEST_F(StartPageTest, RareParametersAreFolded) {
  EXPECT_TRUE(isShown("Scene/objects"));
  EXPECT_FALSE(isShown("Scene/solver_iterations"));
  click("Scene/Solver");
  draw(3);
  EXPECT_TRUE(isShown("Scene/solver_iterations"));
  EXPECT_FALSE(isShown("Scene/friction"));
}

}  // namespace
}  // namespace broadmark::tests
