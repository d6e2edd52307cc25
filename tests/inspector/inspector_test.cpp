// The window's contents, drawn off-screen, with events from the real input queue.
#include "inspector/inspector_test.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <set>
#include <sstream>

#include "broadmark/names.h"
#include "broadmark/render/colouring.h"
#include "inspector/views/view_content.h"
#include "support/pictures.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

TEST_F(InspectorTest, DrawsWithNothingOpen) {
  draw(3);
  EXPECT_NE(inspector.ui().find("Scene/Simulate"), nullptr);
  EXPECT_EQ(value("bodies"), "0");
}

TEST_F(InspectorTest, ClickingSimulatesAndKeysStep) {
  draw(3);
  click("Scene/Simulate");
  waitUntilIdle();
  EXPECT_EQ(value("bodies"), "40");
  key(GLFW_KEY_RIGHT);
  key(GLFW_KEY_RIGHT);
  waitUntilIdle();
  EXPECT_EQ(value("shown_frame"), "2");
  key(GLFW_KEY_END);
  waitUntilIdle();
  EXPECT_EQ(value("shown_frame"), "20");
}

TEST_F(InspectorTest, LettersTypedIntoAnInputAreNoShortcuts) {
  draw(3);
  click("Scene/Simulate");
  waitUntilIdle();
  click("Scene/objects");
  waitUntilIdle();
  key(GLFW_KEY_SPACE);
  key(GLFW_KEY_END);
  waitUntilIdle();
  EXPECT_EQ(value("playing"), "no");
  EXPECT_EQ(value("frame"), "0");
}

// At a zoom with several frames per pixel.
TEST_F(InspectorTest, AClickOnAMarkOfTheTimelineGoesToItsFrame) {
  Session& session = inspector.session();
  setParameters(session.draft.scene(), {{"objects", "200"}, {"frames", "300"}});
  session.draft.choose("brownian");
  session.draft.simulate();
  session.tracks.add("faulty");
  session.playback.seek(300);
  waitUntilIdle();
  const std::string wrong = value("stop_frame");
  ASSERT_NE(wrong, "") << "the fault did not show";
  inspector.session().notices.raisePanel("Timeline");
  draw(3);
  const WidgetPlace plot = *inspector.ui().find("Timeline/plot");
  int arrived = 0;
  for (float x = plot.min.x; x < plot.max.x && arrived < 3; x += 2) {
    session.playback.goTo(0);
    press({x, plot.min.y + 3});
    draw(4);
    if (value("frame") == wrong) ++arrived;
  }
  EXPECT_EQ(arrived, 3);
}

TEST_F(InspectorTest, AMissedPairIsSingledOutAndReplayed) {
  Session& session = inspector.session();
  session.draft.choose("brownian");
  setParameters(session.draft.scene(), {{"objects", "200"}, {"frames", "60"}});
  session.draft.simulate();
  setParameters(*session.tracks.add("faulty").parameters, {{"fat_margin", "0.5"}});
  session.tracks.applyEdits();
  session.display.colourBy(1);
  session.display.filter.hidden_classes = 2;
  waitUntilIdle();
  session.mismatches.goToNext({});
  waitUntilIdle();
  const std::string wrong = value("frame");
  const std::string pair = value("pair");
  ASSERT_EQ(value("stop_frame"), wrong) << "the fault did not show";
  EXPECT_EQ(value("examined"), pair);
  EXPECT_EQ(value("colours"), "correctness");
  draw(60);  // the flight
  ViewContent content;
  session.runs.readProgress([&](const RunProgress& progress) {
    content.update(progress.snapshot, nullptr, session, true);
  });
  const auto& bodies = session.selection.bodies();
  EXPECT_EQ(content.picture.colours[bodies[0]], kDarkPalette.first);
  EXPECT_EQ(content.picture.colours[bodies[1]], kDarkPalette.second);
  EXPECT_NE(value("view.glass"), "0");
  EXPECT_EQ(value("view.axis"), value("pair.axis"));

  click("View/Replay");
  std::vector<std::string> frames;
  for (int picture = 0; picture < 300; ++picture) {
    draw();
    session.runs.waitUntilIdle(kForever);
    if (frames.empty() || frames.back() != value("shown_frame")) {
      frames.push_back(value("shown_frame"));
    }
  }
  EXPECT_EQ(value("replaying"), "no");
  const int last = std::stoi(wrong);
  std::vector<std::string> expected = {wrong};
  for (int frame = std::max(last - 10, 0); frame <= last; ++frame) {
    expected.push_back(std::to_string(frame));
  }
  EXPECT_EQ(frames, expected);
  EXPECT_EQ(value("pair"), pair);

  key(GLFW_KEY_ESCAPE);
  waitUntilIdle();
  EXPECT_EQ(value("examined"), "");
  EXPECT_EQ(value("view.glass"), "0");
  EXPECT_EQ(session.display.colouring, 1U);
  EXPECT_EQ(session.display.filter.hidden_classes, 2U);
}

TEST_F(InspectorTest, EverySizeCanBeDrawn) {
  inspector.session().draft.simulate();
  inspector.session().tracks.add("kd");
  for (const auto& [w, h] : {std::pair{1, 1},
                             {3, 700},
                             {700, 3},
                             {64, 48},
                             {320, 240},
                             {640, 200},
                             {1920, 1080},
                             {960, 600}}) {
    width = w;
    height = h;
    draw(2);
  }
  waitUntilIdle();
  EXPECT_NE(inspector.ui().find("Scene/Simulate"), nullptr);
}

TEST_F(InspectorTest, APhoneHasItsPanelsBelowTheView) {
  inspector.session().draft.simulate();
  waitUntilIdle();
  const auto top_left_of = [&](const char* panel) {
    inspector.session().notices.raisePanel(panel);
    draw(3);
    const WidgetPlace* const place = inspector.ui().find(panel);
    return place == nullptr ? ImVec2{-1, -1} : place->min;
  };
  ASSERT_LT(top_left_of("Scene").y, 50);
  for (const bool narrow : {true, false}) {
    width = narrow ? 390 : 960;
    height = narrow ? 844 : 600;
    draw(3);
    for (const char* panel : {"Scene", "Mismatches"}) {
      const ImVec2 at = top_left_of(panel);
      EXPECT_EQ(at.y > 400, narrow) << panel;
      EXPECT_LT(at.x, width) << panel;
    }
  }
}

TEST_F(InspectorTest, LooksAsItDid) {
  if (!hasGoldenLetters()) GTEST_SKIP() << "the golden pictures have other letters";
  inspector.session().draft.choose("brownian");
  setParameters(inspector.session().draft.scene(), {{"engine", "kinematic"}});
  inspector.session().draft.simulate();
  waitUntilIdle();
  EXPECT_TRUE(looksLikeGolden(picture(), places::source("tests/inspector/golden/inspector.png")));
}

// In a small window the authoring tools leave no space for a long legend.
TEST_F(InspectorTest, AnAuthoredSceneLooksAsItDid) {
  if (!hasGoldenLetters()) GTEST_SKIP() << "the golden pictures have other letters";
  width = 800;
  height = 500;
  Session& session = inspector.session();
  session.document.load({});
  session.document.add([&] { return session.document.stroke(); });
  session.document.tools.tool = Tool::brush;
  colourBy("correctness");  // its four legend rows do not fit
  waitUntilIdle();
  EXPECT_TRUE(looksLikeGolden(picture(), places::source("tests/inspector/golden/authored.png")));
}

TEST_F(InspectorTest, ParametersOfASimulationThatIsNotOpenAreNotShownUnasked) {
  draw(3);
  EXPECT_NE(inspector.ui().find("Scene/objects"), nullptr);
  click("Scene/Simulate");
  waitUntilIdle();
  EXPECT_NE(inspector.ui().find("Scene/objects"), nullptr);
  inspector.session().open(vanishingBodies(directory, 40));
  waitUntilIdle();
  EXPECT_EQ(inspector.ui().find("Scene/objects"), nullptr);
  EXPECT_EQ(value("source"), "recording: vanishing.broadmark");
  click("Scene/draft");
  waitUntilIdle();
  EXPECT_NE(inspector.ui().find("Scene/objects"), nullptr);
}

TEST_F(InspectorTest, ALogOfPairsIsLoadedFromTheMenuAndAgainOnceItHasChanged) {
  const std::filesystem::path recording = vanishingBodies(directory, 40);
  std::string log = "frame,a,b\n";
  const auto frames = openRecordingFile(recording);
  for (std::uint32_t frame = 1; frame <= frames->scene().frames; ++frame) {
    for (const Pair pair : bruteForcePairs(frames->at(frame).boxes)) {
      log += fmt::format("{},{},{}\n", frame, pair.a, pair.b);
    }
  }
  writeTextFile("pairs.csv", "frame,a,b\n");
  inspector.session().open(recording);
  waitUntilIdle();
  click("File");
  draw(3);
  click("File/Load algorithms…");
  draw(3);
  click("File/name");
  draw(2);
  for (const char letter : std::string("pairs.csv")) {
    input.push({.kind = InputEvent::Kind::character, .code = letter});
  }
  key(GLFW_KEY_ENTER);
  waitUntilIdle();
  EXPECT_EQ(value("algorithms"), "1");
  EXPECT_EQ(value("panel.left"), "Algorithms");
  key(GLFW_KEY_END);
  waitUntilIdle();
  draw(3);
  EXPECT_THAT(value("status"), testing::HasSubstr("logged is wrong in frame 1"));
  EXPECT_EQ(value("frame"), "1");

  writeTextFile("pairs.csv", log);
  waitUntilIdle();
  draw(3);
  EXPECT_EQ(value("status"), "logged: fixed: 0 of 20 frames wrong, 1 of 1 frame before");
  EXPECT_EQ(value("frame"), "20");
  EXPECT_EQ(value("algorithm.logged.status"), "ok");
  EXPECT_EQ(value("error"), "");

  std::filesystem::remove("pairs.csv");
  draw(3);
  EXPECT_EQ(value("algorithm.logged.status"), "ok");
  writeTextFile("pairs.csv", "no log\n");
  draw(3);
  EXPECT_THAT(value("status"), testing::HasSubstr("pairs.csv"));
}

TEST_F(InspectorTest, TheLegendCountsByTheOracleBesideAnAlgorithm) {
  inspector.session().draft.simulate();
  inspector.session().tracks.add("sap");
  waitUntilIdle();
  EXPECT_EQ(value("legend.oracle"), "") << "in frame 0 no algorithm answers";
  key(GLFW_KEY_RIGHT);
  waitUntilIdle();
  EXPECT_EQ(value("legend.oracle"), value("legend"));
  EXPECT_THAT(value("view.answer"), testing::HasSubstr("sap reports"));
  EXPECT_EQ(value("view.oracle"), "the oracle finds the same");
  colourBy("motion");  // a colour mode that is independent of the answer
  waitUntilIdle();
  EXPECT_EQ(value("legend.oracle"), "");
}

TEST_F(InspectorTest, ErrorsAreShownUntilAcknowledged) {
  draw(2);
  inspector.session().open("/nowhere/at all.aabbs");
  draw(3);
  EXPECT_THAT(value("error"), testing::HasSubstr("/nowhere/at all.aabbs"));
  click("Error/OK");
  waitUntilIdle();
  EXPECT_EQ(value("error"), "");
}

TEST_F(InspectorTest, ABodyIsPickedWhereItIsSeen) {
  inspector.session().draft.simulate();
  waitUntilIdle();
  ASSERT_NE(inspector.ui().find("View/scene"), nullptr);
  const WidgetPlace view = *inspector.ui().find("View/scene");
  // The view shows bodies at some pixel.
  for (int i = 0; i < 81 && value("selection") == "0"; ++i) {
    const float x = 0.3F + 0.05F * static_cast<float>(i % 9);
    const float y = 0.3F + 0.05F * static_cast<float>(i / 9);
    press({view.min.x + x * (view.max.x - view.min.x), view.min.y + y * (view.max.y - view.min.y)});
    waitUntilIdle();
  }
  EXPECT_EQ(value("selection"), "1");
  key(GLFW_KEY_ESCAPE);
  waitUntilIdle();
  EXPECT_EQ(value("selection"), "0");
}

TEST_F(InspectorTest, AbsentBodiesAreNeitherCountedNorPicked) {
  inspector.session().open(vanishingBodies(directory, 40));
  waitUntilIdle();
  EXPECT_EQ(value("bodies"), "40");
  key(GLFW_KEY_END);
  waitUntilIdle();
  ASSERT_EQ(value("shown_frame"), "20");
  EXPECT_EQ(value("bodies"), "20");
  const WidgetPlace view = *inspector.ui().find("View/scene");
  std::set<std::uint32_t> picked;
  for (int i = 0; i < 81; ++i) {
    const float x = 0.3F + 0.05F * static_cast<float>(i % 9);
    const float y = 0.3F + 0.05F * static_cast<float>(i / 9);
    press({view.min.x + x * (view.max.x - view.min.x), view.min.y + y * (view.max.y - view.min.y)});
    waitUntilIdle();
    const auto& bodies = inspector.session().selection.bodies();
    picked.insert(bodies.begin(), bodies.end());
  }
  ASSERT_FALSE(picked.empty());
  EXPECT_LT(*picked.rbegin(), 20U);
}

TEST_F(InspectorTest, ASelectedBodyThatVanishesSaysSo) {
  inspector.session().open(vanishingBodies(directory, 40));
  waitUntilIdle();
  inspector.session().notices.raisePanel("Bodies");
  inspector.session().selection.select({37});
  waitUntilIdle();
  EXPECT_EQ(value("selected_body"), "present");
  for (int frame = 0; frame < 5; ++frame) key(GLFW_KEY_RIGHT);
  waitUntilIdle();
  EXPECT_EQ(value("selected_body"), "absent: vanished in frame 3");
  const std::string camera = value("camera.distance");
  key(GLFW_KEY_F);  // the camera has no target
  waitUntilIdle();
  EXPECT_EQ(value("camera.distance"), camera);
}

TEST_F(InspectorTest, EveryColourModeCountsThoseThatAreThere) {
  inspector.session().open(vanishingBodies(directory, 40));
  waitUntilIdle();
  key(GLFW_KEY_END);
  waitUntilIdle();
  for (const ColourMode& mode : colourModes()) {
    std::istringstream words(value("legend"));
    int bodies = 0;
    for (std::string entry; std::getline(words, entry, ',');) {
      bodies += std::stoi(entry.substr(entry.rfind(' ')));
    }
    EXPECT_EQ(bodies, 20) << mode.id << ": " << value("legend");
    key(GLFW_KEY_C);
    waitUntilIdle();
  }
}

// Presses every widget of every panel once, and closes what it opens.
TEST_F(InspectorTest, EveryWidgetCanBePressed) {
  inspector.session().draft.simulate();
  inspector.session().tracks.add("grid-bf-mt");
  waitUntilIdle();
  std::set<std::string> pressed;
  for (const auto& panel : inspector.panels()) {
    inspector.session().notices.raisePanel(panel.name);
    waitUntilIdle();
    for (int round = 0; round < 60; ++round) {
      std::string next;
      for (const auto& [name, place] : inspector.ui().places()) {
        if (place.visible && place.enabled && name.starts_with(panel.name) &&
            pressed.insert(name).second) {
          next = name;
          break;
        }
      }
      if (next.empty()) break;
      click(next);
      waitUntilIdle();
      key(GLFW_KEY_ESCAPE);
      waitUntilIdle();
      inspector.session().notices.errors.clear();
      inspector.session().notices.raisePanel(panel.name);
      waitUntilIdle();
    }
  }
  EXPECT_GT(pressed.size(), 30U);
  EXPECT_FALSE(inspector.closing());
}

// Ctrl and a number (for the last panels also Shift) raise a panel, and the arrow keys reach all of
// its widgets.
TEST_F(InspectorTest, EveryWidgetIsReachedByKeys) {
  width = 1000;
  height = 700;
  inspector.session().draft.simulate();
  inspector.session().tracks.add("grid-bf-mt");
  waitUntilIdle();
  const auto press = [&](Key which, const std::vector<Key>& held = {}) {
    key(which, held);
    for (int i = 0; i < 8 && (i < 2 || !input.empty()); ++i) draw();
  };
  const std::vector<PanelTab>& panels = inspector.panels();
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const std::string prefix = std::string(panels[i].name) + "/";
    std::vector<Key> held = {GLFW_KEY_LEFT_CONTROL};
    if (i >= 10) held.push_back(GLFW_KEY_LEFT_SHIFT);
    press(static_cast<Key>(GLFW_KEY_0 + (i + 1) % 10), held);
    draw(3);
    const std::string where(kDockAreas.nameOf(panels[i].area));
    EXPECT_EQ(inspector.preferences().tabs.at(where), panels[i].name);
    std::set<std::string> unreached;
    for (const auto& [name, place] : inspector.ui().places()) {
      const std::string last = name.substr(name.rfind('/') + 1);
      const bool is_shown_only = last == "plot" || last == "open" || last == "over";
      if (name.starts_with(prefix) && place.enabled && !is_shown_only) unreached.insert(name);
    }
    const auto arrive = [&](Key arrow) {
      press(arrow);
      unreached.erase(value("focus"));
    };
    unreached.erase(value("focus"));
    for (int row = 0; row < 70 && !unreached.empty(); ++row) {
      arrive(GLFW_KEY_DOWN);
      // A scrolling table is a child window that must be entered.
      if (row == 0 && prefix == "Results/") arrive(GLFW_KEY_ENTER);
    }
    // Widgets beside others: the last of a row, the second, and those to the left of the focus.
    for (const auto& [sideways, steps] :
         {std::pair{GLFW_KEY_RIGHT, 3}, {GLFW_KEY_RIGHT, 1}, {GLFW_KEY_LEFT, 3}}) {
      // Move the focus to the last row.
      std::string before;
      for (int row = 0; row < 70 && !unreached.empty() && value("focus") != before; ++row) {
        before = value("focus");
        press(GLFW_KEY_DOWN);
      }
      for (int row = 0; row < 70 && !unreached.empty(); ++row) {
        arrive(GLFW_KEY_UP);
        for (int step = 0; step < steps; ++step) arrive(sideways);
      }
    }
    EXPECT_THAT(unreached, testing::IsEmpty()) << prefix;
    press(GLFW_KEY_ESCAPE);
  }
}

/// BROADMARK_RANDOM_EVENTS, or 100.
int randomEvents() {
  const char* stated = std::getenv("BROADMARK_RANDOM_EVENTS");
  return stated != nullptr ? static_cast<int>(parseInteger(stated, "events", 1, 1'000'000)) : 100;
}

class RandomEvents : public InspectorTest, public testing::WithParamInterface<unsigned> {};

TEST_P(RandomEvents, DoNoHarm) {
  const int events = randomEvents();
  std::mt19937 random(GetParam());
  const auto below = [&](int count) {
    return static_cast<int>(random() % static_cast<unsigned>(count));
  };
  constexpr Key kKeys[] = {GLFW_KEY_SPACE,
                           GLFW_KEY_LEFT,
                           GLFW_KEY_RIGHT,
                           GLFW_KEY_HOME,
                           GLFW_KEY_END,
                           GLFW_KEY_F,
                           GLFW_KEY_H,
                           GLFW_KEY_C,
                           GLFW_KEY_TAB,
                           GLFW_KEY_ENTER,
                           GLFW_KEY_ESCAPE,
                           GLFW_KEY_F1,
                           GLFW_KEY_LEFT_CONTROL,
                           GLFW_KEY_LEFT_SHIFT,
                           GLFW_KEY_DELETE,
                           GLFW_KEY_Z,
                           GLFW_KEY_LEFT_ALT,
                           GLFW_KEY_G,
                           GLFW_KEY_M,
                           GLFW_KEY_B,
                           GLFW_KEY_A,
                           GLFW_KEY_D,
                           GLFW_KEY_F6,
                           GLFW_KEY_S};
  inspector.session().draft.simulate();
  inspector.session().tracks.add("sap");
  waitUntilIdle();
  for (int event = 0; event < events; ++event) {
    const auto& places = inspector.ui().places();
    if (const auto cancel = places.find("File/Cancel"); cancel != places.end()) {
      press(centreOf(cancel->second));  // files would be written anywhere
      draw();
      continue;
    }
    switch (below(7)) {
      case 0:
      case 1: {
        // Mostly press a widget: an arbitrary point rarely hits one.
        auto place = places.begin();
        std::advance(place, below(static_cast<int>(places.size())));
        if (place->first.find("Quit") != std::string::npos) break;
        if (place->first.find("million") != std::string::npos) break;  // it would take hours
        press(centreOf(place->second));
        break;
      }
      case 2:
        press({static_cast<float>(below(width)), static_cast<float>(below(height))});
        break;
      case 3:
        input.push({.kind = InputEvent::Kind::key,
                    .code = kKeys[static_cast<std::size_t>(below(std::size(kKeys)))],
                    .down = below(3) > 0});
        break;
      case 4:
        input.push({.kind = InputEvent::Kind::character, .code = ' ' + below(95)});
        break;
      case 5:
        input.push({.kind = InputEvent::Kind::wheel, .y = static_cast<float>(below(7) - 3)});
        break;
      case 6:
        width = 300 + below(900);
        height = 200 + below(600);
        break;
      default:
        break;
    }
    draw();
    // Repeated duplication puts bodies at the same position, and the engine would take hours.
    constexpr std::size_t kMaxBodies = 20'000;
    Document& document = inspector.session().document;
    if (document.editor.scene().bodies.size() > kMaxBodies) {
      document.edit([](scenes::SceneEditor& editor) { editor.undo(); });
    }
  }
  waitUntilIdle();
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomEvents, testing::Range(1U, 21U));

}  // namespace
}  // namespace broadmark::tests
