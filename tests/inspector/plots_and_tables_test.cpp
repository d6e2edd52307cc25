// What the inspector gives away: plots as SVG and PNG, tables, links; and two results files
// compared.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <set>

#include "broadmark/files.h"
#include "inspector/inspector_test.h"
#include "inspector/ui/terms.h"
#include "request/inspector_options.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class PlotsAndTablesTest : public InspectorTest {
 protected:
  PlotsAndTablesTest() {
    width = 1440;
    height = 900;
    ImGuiIO& io = ImGui::GetIO();
    io.ClipboardUserData = &copied;
    io.SetClipboardTextFn = [](void* to, const char* text) {
      *static_cast<std::string*>(to) = text;
    };
    draw(2);
  }

  /// Draws pictures, and does with them what is asked for.
  void drawAndWrite() {
    for (int i = 0; i < 8; ++i) {  // a dialog finds its size in the first pictures
      const Picture drawn = picture();
      if (const auto write = inspector.takePictureRequest()) write(drawn);
    }
  }

  void pressRight(ImVec2 at) {
    input.push({.kind = InputEvent::Kind::move, .x = at.x, .y = at.y});
    for (const bool down : {true, false}) {
      input.push({.kind = InputEvent::Kind::button, .code = 1, .down = down});
      drawAndWrite();
    }
  }

  /// Answers the file dialog.
  void enterName(std::string_view name) {
    ASSERT_EQ(value("dialog"), "yes");
    type(name);
    key(GLFW_KEY_ENTER);
    drawAndWrite();
    EXPECT_EQ(value("dialog"), "no");
  }

  void savePlot(const std::string& plot, const std::string& file) {
    const WidgetPlace* const place = inspector.ui().find(plot);
    ASSERT_NE(place, nullptr) << plot;
    pressRight(centreOf(*place));
    click(plot.substr(0, plot.rfind('/')) + "/Save plot…");
    drawAndWrite();
    enterName(file);
  }

  void run(std::initializer_list<const char*> algorithms) {
    for (const char* algorithm : algorithms) inspector.session().tracks.add(algorithm);
    inspector.session().draft.simulate();
    inspector.session().play(true);
    waitUntilIdle();
    inspector.session().playback.goTo(20);
    waitUntilIdle();
  }

  static void writeResults(const char* file, std::vector<CaseResult> cases) {
    Results results;
    results.complete = true;
    results.environments.emplace_back();
    results.cases = std::move(cases);
    writeTextFile(file, resultWriters().front().format(results));
  }

  std::string copied;
};

TEST_F(PlotsAndTablesTest, APlotBecomesAnSvg) {
  run({"sap", "grid-bf"});
  inspector.session().notices.raisePanel("Timeline");
  drawAndWrite();
  savePlot("Timeline/plot", "times");  // ".svg" is added
  EXPECT_EQ(value("error"), "");
  EXPECT_THAT(value("status"), HasSubstr("times.svg"));
  const std::string svg = readTextFile("times.svg");
  EXPECT_THAT(svg, AllOf(StartsWith("<svg "), HasSubstr(">sap</text>"), HasSubstr(">grid-bf/"),
                         HasSubstr("</g>"), Not(HasSubstr("nan"))));
  // Each of the two curves, and that of the pairs, is a path with a segment from frame to frame.
  const std::regex path("<path d=\"([^\"]*)\"");
  std::vector<std::ptrdiff_t> segments;
  for (auto at = std::sregex_iterator(svg.begin(), svg.end(), path); at != std::sregex_iterator();
       ++at) {
    segments.push_back(std::ranges::count((*at)[1].str(), 'L'));
  }
  EXPECT_EQ(std::ranges::count_if(segments, [](auto count) { return count >= 18; }), 3) << svg;
}

TEST_F(PlotsAndTablesTest, APlotBecomesAPng) {
  run({"sap"});
  inspector.session().timeline.select(3, 12);
  inspector.session().notices.raisePanel("Timeline");
  drawAndWrite();
  for (const char* const plot : {"Timeline/plot", "Timeline/histogram"}) {
    const WidgetPlace place = *inspector.ui().find(plot);
    savePlot(plot, "plot.png");
    EXPECT_EQ(value("error"), "");
    const Picture saved = readPng("plot.png");
    EXPECT_NEAR(saved.width, place.max.x - place.min.x, 1);
    EXPECT_NEAR(saved.height, place.max.y - place.min.y, 1);
    EXPECT_GT(std::set<std::uint8_t>(saved.rgba.begin(), saved.rgba.end()).size(), 8U);
    std::filesystem::remove("plot.png");
  }
  savePlot("Timeline/plot", "plot.pdf");
  EXPECT_THAT(value("error"), HasSubstr("plot.pdf: a plot is saved as .svg or .png"));
  EXPECT_FALSE(std::filesystem::exists("plot.pdf"));
}

TEST_F(PlotsAndTablesTest, ALinkHoldsTheSession) {
  setParameters(inspector.session().draft.scene(), {{"seed", "9"}});
  run({"sap"});
  inspector.session().selection.select({7, 3});
  const auto command = std::ranges::find(inspector.commands(), "Copy link", &UserCommand::label);
  ::unsetenv("BROADMARK_PAGE");
  EXPECT_FALSE(command->isEnabled());
  ::setenv("BROADMARK_PAGE", "https://example.org/page.html", 1);
  ASSERT_TRUE(command->isEnabled());
  command->action();
  ::unsetenv("BROADMARK_PAGE");
  const std::string session =
      "https://example.org/page.html#freefall&--engine=bullet&--param=frames=20"
      "&--param=objects=40&--param=seed=9&--algorithm=sap&--frame=20&--select=3,7&--camera=";
  ASSERT_THAT(copied, testing::StartsWith(session));
  EXPECT_NO_THROW(static_cast<void>(parseCamera(copied.substr(session.size()))));
}

TEST_F(PlotsAndTablesTest, CasesAreCopiedBeyondTheVisibleRows) {
  std::vector<CaseResult> cases;
  for (std::uint32_t i = 0; i < 200; ++i) cases.push_back(caseOf("sap", 100 + i, {{10, 20}}));
  writeResults("many.json", std::move(cases));
  inspector.session().open("many.json");
  waitUntilIdle();
  key(GLFW_KEY_C, {GLFW_KEY_LEFT_CONTROL, GLFW_KEY_LEFT_SHIFT});
  draw(4);
  EXPECT_THAT(copied, StartsWith("algorithm\trecording\tstatus"));
  EXPECT_EQ(std::ranges::count(copied, '\n'), 201) << copied.substr(0, 400);
  EXPECT_THAT(copied, HasSubstr("\nsap/margin=0.5\tBrownian/Cubes/N299/F3\tok"));
}

TEST_F(PlotsAndTablesTest, TwoResultsFilesAreCompared) {
  const auto times = [](std::int64_t ns) {
    return std::vector(3, std::vector<std::int64_t>(40, ns));
  };
  writeResults("before.json", {caseOf("sap", 100, times(1000)), caseOf("kd", 100, times(1000)),
                               caseOf("bf", 100, times(1000)), caseOf("cgal", 100, times(1000)),
                               caseOf("tracy", 100, times(1000))});
  writeResults("after.json", {caseOf("sap", 100, times(1000)), caseOf("kd", 100, times(2000)),
                              caseOf("bf", 100, times(500)), caseOf("cgal", 100, times(1000))});
  inspector.session().open("after.json");
  waitUntilIdle();
  click("Cases/Compare with…");
  drawAndWrite();
  click("File/name");
  drawAndWrite();
  enterName("before.json");
  EXPECT_EQ(value("error"), "");
  EXPECT_THAT(value("cases.compared"),
              AllOf(StartsWith("5 cases:"), HasSubstr("2 same"), HasSubstr("1 faster"),
                    HasSubstr("1 REGRESSED"), HasSubstr("1 missing")));
  click("Cases/by/B/A");
  drawAndWrite();
  key(GLFW_KEY_C, {GLFW_KEY_LEFT_CONTROL, GLFW_KEY_LEFT_SHIFT});
  draw(4);
  std::vector<std::string> order;
  const std::regex row("\n[^\t]*/(sap|kd|bf|cgal|tracy)/");
  for (auto at = std::sregex_iterator(copied.begin(), copied.end(), row);
       at != std::sregex_iterator(); ++at) {
    order.push_back((*at)[1]);
  }
  EXPECT_THAT(order, ElementsAre("tracy", "bf", "sap", "cgal", "kd")) << copied;
  EXPECT_THAT(copied, HasSubstr("REGRESSED +100.0 %"));
  for (const auto& [name, at] : inspector.ui().places()) {
    if (!name.starts_with("Cases/by/")) continue;
    EXPECT_STRNE(termDoc(name.substr(9)), "") << name;
  }
  click("Cases/End comparison");
  draw(5);
  EXPECT_EQ(value("cases.compared"), "");
  EXPECT_TRUE(isShown("Cases/by/algorithm"));

  writeTextFile("other.json", "{}");
  click("Cases/Compare with…");
  drawAndWrite();
  click("File/name");
  drawAndWrite();
  enterName("other.json");
  EXPECT_THAT(value("error"), HasSubstr("other.json"));
  EXPECT_EQ(value("cases.compared"), "");
}

}  // namespace
}  // namespace broadmark::tests
