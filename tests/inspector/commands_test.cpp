// Commands, panels and dialogs, through the real event queue.
#include <gmock/gmock.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <tuple>

#include "broadmark/files.h"
#include "inspector/inspector_test.h"

namespace broadmark::tests {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class CommandsTest : public InspectorTest {
 protected:
  CommandsTest() {
    width = 1200;
    height = 800;
    draw(2);
  }

  /// Runs the command that the palette finds first.
  void command(std::string_view words) {
    ctrl(GLFW_KEY_P);
    waitUntilDrawn();
    type(words);
    key(GLFW_KEY_ENTER);
    waitUntilDrawn();
  }

  void waitUntilDrawn() {
    for (int i = 0; i < 4 || !input.empty(); ++i) draw();
  }

  void doubleClick(const std::string& widget) {
    click(widget);
    click(widget);
    waitUntilDrawn();
  }
};

TEST_F(CommandsTest, EachIsDescribedOnceAndHasItsKeysAlone) {
  inspector.session().document.load({});
  waitUntilIdle();
  std::set<std::string> docs;
  std::set<std::tuple<Key, bool, bool>> keys;
  for (const UserCommand& command : inspector.commands()) {
    EXPECT_TRUE(docs.insert(command.doc).second) << command.doc;
    if (command.key == 0 || command.key == GLFW_KEY_S) continue;  // S: what is shown
    EXPECT_TRUE(keys.emplace(command.key, command.ctrl, command.shift).second) << command.doc;
  }
  EXPECT_GT(docs.size(), 100U);
}

TEST_F(CommandsTest, ThePaletteFindsThemByTyping) {
  command("theme light");
  EXPECT_EQ(value("theme"), "light");
  EXPECT_EQ(value("popup"), "no");
  command("picture rate");
  EXPECT_EQ(inspector.animationSeconds(), 0);
  draw(60);
  EXPECT_THAT(value("picture_rate"), StartsWith("60 pictures/s, "));
}

TEST_F(CommandsTest, ThePaletteIsMovedThroughByArrowsAndLeftByEscape) {
  ctrl(GLFW_KEY_P);
  waitUntilDrawn();
  type("theme");
  waitUntilDrawn();
  EXPECT_TRUE(isShown("Commands/use the dark theme"));
  EXPECT_FALSE(isShown("Commands/quit"));
  key(GLFW_KEY_DOWN);
  key(GLFW_KEY_ESCAPE);
  waitUntilDrawn();
  EXPECT_EQ(value("popup"), "no");
  EXPECT_EQ(value("theme"), "dark");
  ctrl(GLFW_KEY_P);
  waitUntilDrawn();
  type("theme");
  key(GLFW_KEY_DOWN);
  key(GLFW_KEY_ENTER);
  waitUntilDrawn();
  EXPECT_EQ(value("theme"), "light");
}

TEST_F(CommandsTest, DisabledOnesDoNothing) {
  command("save the available frames");
  EXPECT_EQ(value("dialog"), "no");
  EXPECT_EQ(value("popup"), "yes") << "the palette waits for another";
}

TEST_F(CommandsTest, TheFocusStaysInThePanelThatAKeyOpened) {
  inspector.session().draft.simulate();
  inspector.session().tracks.add("sap");
  waitUntilIdle();
  for (std::size_t i = 0; i < inspector.panels().size(); ++i) {
    std::vector<Key> held = {GLFW_KEY_LEFT_CONTROL};
    if (i >= 10) held.push_back(GLFW_KEY_LEFT_SHIFT);
    key(static_cast<Key>(GLFW_KEY_0 + (i + 1) % 10), held);
    for (int picture = 0; picture < 30 || !input.empty(); ++picture) draw();
    EXPECT_EQ(value("focus"), inspector.panels()[i].name);
  }
}

TEST_F(CommandsTest, TablesInViewAreCopiedWithTabs) {
  inspector.session().draft.simulate();
  inspector.session().tracks.add("sap");
  inspector.session().tracks.add("bf");
  inspector.session().playback.goTo(1);
  waitUntilIdle();
  EXPECT_FALSE(inspector.ui().hasTables());
  command("panel Results");
  key(GLFW_KEY_C, {GLFW_KEY_LEFT_CONTROL, GLFW_KEY_LEFT_SHIFT});
  draw(2);
  waitUntilDrawn();
  std::istringstream copied(ImGui::GetClipboardText());
  std::vector<std::string> lines;
  for (std::string line; std::getline(copied, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 3U) << ImGui::GetClipboardText();
  EXPECT_THAT(lines[0], StartsWith("algorithm\tstatus\ttotal\tmean\tpairs\t"));
  EXPECT_THAT(lines[1], StartsWith("sap\tok\t"));
  EXPECT_THAT(lines[2], StartsWith("bf\tok\t"));
  for (const std::string& line : lines) {
    EXPECT_EQ(std::ranges::count(line, '\t'), std::ranges::count(lines[0], '\t')) << line;
  }
}

TEST_F(CommandsTest, AClickInAMenuLeavesTheKeysToTheView) {
  inspector.session().draft.simulate();
  waitUntilIdle();
  click("View");
  waitUntilDrawn();
  click("View menu/Results");
  waitUntilDrawn();
  EXPECT_EQ(value("panel.bottom"), "Results");
  key(GLFW_KEY_RIGHT);
  waitUntilIdle();
  EXPECT_EQ(value("frame"), "1");
}

TEST_F(CommandsTest, PanelsAreHiddenAndShownAgain) {
  const float before = inspector.ui().find("Start/A pile")->max.x;
  for (const char* panel : {"Display", "Bodies", "Mismatches"}) {
    command(std::string("hide panel ") + panel);
    EXPECT_FALSE(isShown(panel)) << panel;
  }
  EXPECT_EQ(value("hidden_panels"), "Display, Bodies, Mismatches");
  EXPECT_GT(inspector.ui().find("Start/Find the bug")->max.x, before);
  ctrl(GLFW_KEY_0);
  waitUntilDrawn();
  EXPECT_EQ(value("hidden_panels"), "Display, Mismatches");
  EXPECT_EQ(value("panel.right"), "Bodies");
  command("reset layout");
  EXPECT_EQ(value("hidden_panels"), "");
}

TEST_F(CommandsTest, PanelsAreMaximisedAndRestored) {
  inspector.session().draft.simulate();
  waitUntilIdle();
  const std::string layout = value("layout");
  const float normal = inspector.ui().find("Playback/frame")->max.x;
  doubleClick("Timeline");
  EXPECT_EQ(value("maximised"), "bottom");
  EXPECT_FALSE(isShown("View/scene"));
  EXPECT_GT(inspector.ui().find("Playback/frame")->max.x, normal);
  doubleClick("Timeline");
  EXPECT_EQ(value("maximised"), "");
  EXPECT_TRUE(isShown("View/scene"));
  // By keys, for the panel that has the focus.
  ctrl(GLFW_KEY_4);
  waitUntilDrawn();
  ctrl(GLFW_KEY_M);
  waitUntilDrawn();
  EXPECT_EQ(value("maximised"), "left");
  ctrl(GLFW_KEY_5);  // a panel elsewhere ends it
  waitUntilDrawn();
  EXPECT_EQ(value("maximised"), "");
  key(GLFW_KEY_F11);
  waitUntilDrawn();
  EXPECT_EQ(value("maximised"), "View");
  EXPECT_FALSE(isShown("Scene"));
  EXPECT_TRUE(isShown("View/scene"));
  key(GLFW_KEY_ESCAPE);
  key(GLFW_KEY_ESCAPE);
  waitUntilDrawn();
  EXPECT_EQ(value("maximised"), "");
  EXPECT_EQ(value("layout"), layout);
}

TEST_F(CommandsTest, PanelsAreMoved) {
  const auto left_of_tab = [this](const std::string& panel) {
    return inspector.ui().find(panel)->min.x;
  };
  EXPECT_GT(left_of_tab("Bodies"), 600);
  command("move panel bodies left");
  EXPECT_LT(left_of_tab("Bodies"), 400);
  EXPECT_EQ(value("panel.left"), "Bodies");
  EXPECT_EQ(inspector.preferences().areas.at("Bodies"), "left");
  command("reset layout");
  EXPECT_GT(left_of_tab("Bodies"), 600);
}

class MovedPanels : public InspectorTest {
 protected:
  MovedPanels()
      : InspectorTest({.tabs = {{"bottom", "Scene"}},
                       .areas = {{"Scene", "bottom"}, {"Batch", "nowhere"}, {"gone", "left"}},
                       .hidden = {"Algorithms", "gone"}}) {}
};

TEST_F(MovedPanels, ComeBackWithThePreferences) {
  inspector.session().draft.simulate();
  waitUntilIdle();
  EXPECT_EQ(value("panel.bottom"), "Scene");
  EXPECT_TRUE(isShown("Batch"));
  EXPECT_FALSE(isShown("Algorithms"));
}

TEST_F(CommandsTest, TheOpenDialogListsAllKindsAndRemembersItsFolder) {
  std::filesystem::create_directory("sub");
  for (const char* file : {"sub/mesh.ply", "sub/boxes.csv.gz", "sub/runs.jsonl", "sub/plugin.so",
                           "sub/bodies.npy", "sub/scene.aabbs", "sub/notes.txt"}) {
    writeTextFile(file, "");
  }
  ctrl(GLFW_KEY_O);
  waitUntilDrawn();
  click("File/sub/");
  waitUntilDrawn();
  for (const char* file :
       {"mesh.ply", "boxes.csv.gz", "runs.jsonl", "plugin.so", "bodies.npy", "scene.aabbs"}) {
    EXPECT_TRUE(isShown(std::string("File/") + file)) << file;
  }
  EXPECT_FALSE(isShown("File/notes.txt"));
  click("File/all files");
  waitUntilDrawn();
  EXPECT_TRUE(isShown("File/notes.txt"));
  click("File/notes.txt");
  click("File/Open");
  draw(8);  // a dialog finds its size in the first pictures
  EXPECT_THAT(value("error"), HasSubstr("notes.txt"));
  click("Error/OK");
  waitUntilDrawn();
  EXPECT_EQ(value("error"), "");
  EXPECT_EQ(value("popup"), "no");
  ctrl(GLFW_KEY_O);
  waitUntilDrawn();
  EXPECT_EQ(value("dialog"), "yes");
  EXPECT_TRUE(isShown("File/mesh.ply"));
  EXPECT_THAT(inspector.preferences().folders, testing::SizeIs(1));
}

TEST_F(CommandsTest, AFileToSaveIsNamedByTypingAtOnce) {
  inspector.session().document.load({.name = "Marbles"});
  waitUntilIdle();
  ctrl(GLFW_KEY_S);
  waitUntilDrawn();
  type("balls");
  key(GLFW_KEY_ENTER);
  waitUntilDrawn();
  EXPECT_EQ(value("dialog"), "no");
  EXPECT_THAT(value("author.path"), EndsWith("/balls.json"));
  EXPECT_TRUE(std::filesystem::exists("balls.json"));
  // A file that exists is asked about.
  command("authored scene to another file");
  type("balls.json");
  key(GLFW_KEY_ENTER);
  waitUntilDrawn();
  EXPECT_EQ(value("dialog"), "yes");
  key(GLFW_KEY_ESCAPE);
  waitUntilDrawn();
  EXPECT_EQ(value("dialog"), "no");
  EXPECT_THAT(value("error"), IsEmpty());
}

}  // namespace
}  // namespace broadmark::tests
