// The panel Phases, with times that are known, through the real event queue.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "inspector/inspector_test.h"
#include "inspector/ui/terms.h"
#include "support/wrapped_host.h"

namespace broadmark::tests {
namespace {

constexpr std::uint32_t kFrames = 400;
constexpr std::uint32_t kPeak = 137;

/// `sap` has a peak in one frame, in the search; `grid-bf` is slower in all others.
std::unique_ptr<CaseExecutor> hostWithPeak(const Case& test_case, const CancelQuery&) {
  const bool is_sap = test_case.algorithm.id == "sap";
  const auto rule = [is_sap](std::uint32_t frame) {
    FrameTimes times;
    times[Phase::update_structures] = is_sap ? 20'000 : 400'000;
    times[Phase::search_overlaps] = is_sap && frame == kPeak ? 5'000'000 : 30'000;
    times[Phase::total] = times[Phase::update_structures] + times[Phase::search_overlaps];
    return times;
  };
  return std::make_unique<HostOfTimes>(
      test_case, HostOfTimes::Times{.initialize_ns = 1'000'000, .of_frame = rule});
}

class PhasesPanelTest : public InspectorTest {
 protected:
  PhasesPanelTest() : InspectorTest({}, {}, hostWithPeak) {
    width = 1440;
    height = 900;
    Session& session = inspector.session();
    session.draft.choose("brownian");
    setParameters(session.draft.scene(), {{"engine", "kinematic"}});
    setParameters(session.draft.scene(), {{"objects", "60"}, {"frames", std::to_string(kFrames)}});
    session.draft.simulate();
    for (const char* id : {"grid-bf", "sap"}) session.tracks.add(id);
    session.playback.goTo(kFrames);
    waitUntilIdle();
    session.notices.raisePanel("Phases");
    waitUntilIdle();
  }

  WidgetPlace place(const std::string& widget) {
    const WidgetPlace* found = inspector.ui().find(widget);
    EXPECT_NE(found, nullptr) << widget;
    return found != nullptr ? *found : WidgetPlace{};
  }

  void pressAndWait(float x, float y) {
    press({x, y});
    waitUntilIdle();
  }
  void clickAndWait(const std::string& widget) {
    click(widget);
    waitUntilIdle();
  }
};

TEST_F(PhasesPanelTest, AClickNearAPeakShowsItsFrameWithCellsAndHeatMap) {
  const WidgetPlace plot = place("Phases/sap/plot");
  // Several frames share a pixel, and the peak is found on one of the pixels around.
  int arrived = 0;
  for (float x = plot.min.x; x < plot.max.x && arrived == 0; x += 6) {
    inspector.session().playback.goTo(0);
    pressAndWait(x, plot.min.y + 20);
    if (value("frame") == std::to_string(kPeak)) ++arrived;
  }
  EXPECT_EQ(arrived, 1);
  EXPECT_EQ(value("shown_algorithm"), "sap");
  EXPECT_NE(value("structure"), "0");
  EXPECT_EQ(value("colours"), "tests");
}

TEST_F(PhasesPanelTest, ARowGoesToTheSlowestFrameOfTheSpan) {
  clickAndWait("Phases/mean of sap");
  EXPECT_EQ(value("frame"), std::to_string(kPeak));
  inspector.session().timeline.select(200, 300);
  waitUntilIdle();
  clickAndWait("Phases/mean of sap");
  EXPECT_EQ(value("frame"), "200");
}

TEST_F(PhasesPanelTest, HeadingsSortTableAndStacks) {
  const auto sap_is_first = [&] {
    const bool in_table = place("Phases/mean of sap").min.y < place("Phases/mean of grid-bf").min.y;
    EXPECT_EQ(in_table, place("Phases/sap/plot").min.y < place("Phases/grid-bf/plot").min.y);
    return in_table;
  };
  EXPECT_FALSE(sap_is_first());
  clickAndWait("Phases/by/total");
  EXPECT_TRUE(sap_is_first()) << "ascending";
  clickAndWait("Phases/by/total");
  EXPECT_FALSE(sap_is_first()) << "descending";
  clickAndWait("Phases/by/search_overlaps");
  EXPECT_FALSE(sap_is_first());
}

TEST_F(PhasesPanelTest, EveryHeadingIsExplained) {
  inspector.session().timeline.select(200, 300);
  Results results;
  results.cases = {caseOf("sap", 9, {})};
  inspector.session().results.emplace("results.json", std::move(results),
                                      inspector.session().tracks.algorithms());
  inspector.session().startDuel(1);
  inspector.session().postRequest();
  inspector.session().jobs.get<BackgroundDuel>().wait();
  std::size_t headings = 0;
  for (const char* panel : {"Phases", "Results", "Timeline", "Cases", "Duel"}) {
    inspector.session().notices.raisePanel(panel);
    waitUntilIdle();
    for (const auto& [name, at] : inspector.ui().places()) {
      const std::string prefix = std::string(panel) + "/by/";
      if (!name.starts_with(prefix)) continue;
      EXPECT_STRNE(termDoc(name.substr(prefix.size())), "") << name;
      ++headings;
    }
  }
  EXPECT_GT(headings, 30U);
}

}  // namespace
}  // namespace broadmark::tests
