// Golden pictures of every panel with all kinds of contents: in a large window, and in a small one,
// with the other theme, for panels with another width there.
#include <gtest/gtest.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "broadmark/render/framebuffer.h"
#include "inspector/helpers.h"
#include "inspector/inspector.h"
#include "support/pictures.h"
#include "support/places.h"
#include "support/wrapped_host.h"

namespace broadmark::tests {
namespace {

using scenes::SceneEditor;

/// Panels are flat: a moved or recoloured part changes fewer pixels than in a scene.
constexpr double kMaxOfPanel = 0.3;

/// Reports frame times computed from the frame's number and the length of the algorithm's name, so
/// that pictures of times are reproducible.
std::unique_ptr<CaseExecutor> ruledHost(const Case& test_case, const CancelQuery&) {
  const auto length = static_cast<std::int64_t>(test_case.algorithm.id.size());
  const auto rule = [length](std::uint32_t frame) {
    FrameTimes times;
    times[Phase::update_objects] = 3'000 * length;
    times[Phase::search_overlaps] =
        (4'000 + frame * 7'919 % 5'000) * length + 100 * (frame * length % 13);
    times[Phase::total] = times[Phase::update_objects] + times[Phase::search_overlaps];
    return times;
  };
  return std::make_unique<HostOfTimes>(
      test_case, HostOfTimes::Times{.initialize_ns = 1'000'000, .of_frame = rule});
}

/// Three cases: a correct one, a wrong one, and one without times.
Results threeCases() {
  Results results;
  results.complete = true;
  results.cases = {caseOf("sap", 1000, {{30'000, 45'000, 32'000}}),
                   caseOf("kd", 1000, {{52'000, 47'000, 60'000}}), caseOf("bf", 1000, {})};
  CaseResult& wrong = results.cases[1];
  wrong.checked = true;
  wrong.differences.resize(1);
  wrong.differences[0].frame = 2;
  results.cases[2].status = Status::timeout;
  return results;
}

/// Widgets with contents that depend on the machine or the date.
constexpr const char* kVaries[] = {"Batch/threads", "Duel/rounds"};

/// Blanks a widget and the area beside it up to `right`, because its width may vary.
void blank(Picture& picture, const WidgetPlace& place, float right) {
  for (int y = static_cast<int>(place.min.y);
       y < std::min(static_cast<int>(place.max.y), picture.height); ++y) {
    const auto row = picture.rgba.begin() + std::ptrdiff_t{4} * y * picture.width;
    std::fill(row + 4 * static_cast<int>(place.min.x), row + 4 * static_cast<int>(right),
              std::uint8_t{0});
  }
}

/// Crops a picture to a rectangle.
Picture cropped(const Picture& whole, const ImRect& at) {
  const auto left = static_cast<std::size_t>(at.Min.x);
  const auto top = static_cast<std::size_t>(at.Min.y);
  Picture part{.width = static_cast<int>(at.GetWidth()),
               .height = static_cast<int>(at.GetHeight())};
  const std::size_t row = 4 * static_cast<std::size_t>(part.width);
  part.rgba.resize(row * static_cast<std::size_t>(part.height));
  for (std::size_t y = 0; y < static_cast<std::size_t>(part.height); ++y) {
    const std::size_t from = 4 * ((top + y) * static_cast<std::size_t>(whole.width) + left);
    std::memcpy(&part.rgba[y * row], &whole.rgba[from], row);
  }
  return part;
}

using Size = std::pair<int, int>;

class AllPanels : public testing::Test {
 protected:
  AllPanels(Size window, bool dark, float scale)
      : size(std::move(window)),
        context(makeOffscreenContext(GlSource::automatic)),
        gl(*context),
        inspector(gl, algorithmsAndFaultyOnes(), {.dark = dark}, scale, ruledHost),
        session(inspector.session()) {}

  /// Gives every panel contents. Draws nothing, because drawing would advance the playback.
  void prepare() {
    session.document.load({});
    for (const float x : {0.0F, 3.0F}) {
      session.document.paint_at = {x, 1, 0};
      session.document.add([this] { return session.document.stroke(); });
    }
    session.document.edit(&SceneEditor::selectAll);
    waitUntilIdle(session);

    session.draft.choose("brownian");
    setParameters(session.draft.scene(), {{"engine", "kinematic"}});
    setParameters(session.draft.scene(), {{"objects", "100"}, {"frames", "40"}});
    session.draft.simulate();
    session.tracks.add("sap");
    TrackEdit& parallel = session.tracks.add("bf-simd-mt");
    parallel.test_case.isa = Isa::scalar;
    parallel.test_case.threads = 2;
    session.tracks.applyEdits();
    session.playback.goTo(40);
    waitUntilIdle(session);
    session.startDuel(20);
    session.postRequest();
    session.jobs.get<BackgroundDuel>().wait();

    setParameters(*session.tracks.add("faulty").parameters, {{"fat_margin", "0.5"}});
    session.tracks.applyEdits();
    waitUntilIdle(session);
    session.showSecond(true);
    session.timeline.select(5, 30);
    session.results.emplace("results.json", threeCases(), session.tracks.algorithms());
    waitUntilIdle(session);
    session.notices.panels_to_raise.clear();
  }

  Picture pictureOf(const PanelTab& panel) {
    const auto [width, height] = size;
    const Framebuffer target(gl, width, height, 1);
    inspector.session().notices.raisePanel(panel.name);
    // The first frames raise the tab and compute the widths of its tables.
    for (int i = 0; i < 4; ++i) {
      inspector.draw(input, width, height, 1.0 / 60, [&] { target.bind(); });
    }
    const std::string place(kDockAreas.nameOf(panel.area));
    const ImRect at = ImGui::FindWindowByName(place.c_str())->Rect();
    Picture whole = target.read();
    for (const std::string name : kVaries) {
      if (!name.starts_with(panel.name)) continue;
      const WidgetPlace* const widget = inspector.ui().find(name);
      if (widget != nullptr && widget->visible) blank(whole, *widget, at.Max.x);
    }
    return cropped(whole, at);
  }

  Size size;
  std::unique_ptr<OffscreenContext> context;
  Gl gl;
  Inspector inspector;
  Session& session;
  InputQueue input;
};

class PanelsLook : public AllPanels, public testing::WithParamInterface<std::tuple<Size, bool>> {
 protected:
  PanelsLook() : AllPanels(std::get<Size>(GetParam()), std::get<bool>(GetParam()), 1) {}
};

TEST_P(PanelsLook, AsTheyDid) {
  if (!hasGoldenLetters()) GTEST_SKIP() << "the golden pictures have other letters";
  prepare();
  const bool dark = std::get<bool>(GetParam());
  for (const auto& panel : inspector.panels()) {
    // Side panels have the same width in both windows, except for 3 pixels.
    if (!dark && panel.area != DockArea::bottom) continue;
    const std::string name = fmt::format("{}-{}x{}-{}.png", panel.name, size.first, size.second,
                                         dark ? "dark" : "light");
    EXPECT_TRUE(looksLikeGolden(
        pictureOf(panel), places::source("tests/inspector/golden/panels/" + name), kMaxOfPanel));
  }
}

INSTANTIATE_TEST_SUITE_P(SizesAndThemes, PanelsLook,
                         testing::Values(std::tuple(Size{1920, 1080}, true),
                                         std::tuple(Size{1024, 700}, false)));

class PanelsFit : public AllPanels, public testing::WithParamInterface<std::tuple<Size, float>> {
 protected:
  PanelsFit() : AllPanels(std::get<Size>(GetParam()), true, std::get<float>(GetParam())) {}
};

TEST_P(PanelsFit, NoWidgetIsCutOff) {
  prepare();
  const auto expect_whole = [this](const PanelTab& panel) {
    pictureOf(panel);
    for (const auto& [name, place] : inspector.ui().places()) {
      if (!name.starts_with(panel.name)) continue;
      EXPECT_FALSE(place.cut) << name;
    }
  };
  for (const auto& panel : inspector.panels()) expect_whole(panel);
  const auto scene = std::ranges::find(inspector.panels(), std::string_view("Scene"),
                                       [](const PanelTab& panel) { return panel.name; });
  for (const SceneListing& listing : builtinScenes()) {
    session.draft.choose(listing.id);
    expect_whole(*scene);
  }
}

INSTANTIATE_TEST_SUITE_P(SizesAndScales, PanelsFit,
                         testing::Values(std::tuple(Size{1440, 900}, 2.0F),
                                         std::tuple(Size{1024, 700}, 1.5F)));

}  // namespace
}  // namespace broadmark::tests
