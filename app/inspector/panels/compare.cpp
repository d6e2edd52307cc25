// The differences between the two views: pairs that only one of them shows, and frame times.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

#include "inspector/panels/panel.h"
#include "inspector/session/track_statistics.h"
#include "inspector/session/wrong_pair.h"
#include "support/words.h"

namespace broadmark::panels::compare {
namespace {

constexpr float kPairsShare = 0.42F;     // of the width; the rest is the plot's
constexpr float kMinWidthForBoth = 560;  // units; a narrower panel shows one of both

class ComparePanel final : public Panel {
 public:
  using Panel::Panel;

  void draw() override {
    if (!session.second) {
      ui.paragraph(
          "A second view beside the first one shows another algorithm's answer, another frame or "
          "another recording. This panel then compares their pairs and times.");
      if (ui.button("Second view", "Toggle the second view (V)")) {
        session.showSecond(true);
      }
      return;
    }
    const SplitPane parts{
        .share = kPairsShare, .min_width = kMinWidthForBoth * ui.scale, .second_only = times_only_};
    if (!parts.both()) {
      ui.toggle("Times", times_only_, "Compare frame times instead of pairs");
    }
    parts.draw([&] { drawPairs(); }, [&] { drawTimes(); });
  }

 private:
  void drawPairs() {
    const PairComparison* const comparison = progress->comparison.get();
    if (comparison == nullptr) {
      ui.faintParagraph("Waiting for both answers.");
      return;
    }
    ui.plain(fmt::format("{} in both", counted(comparison->both, "pair")));
    ui.coloured(ui.theme.first_only, fmt::format("{} first only", comparison->first_only.size()));
    ImGui::SameLine();
    ui.coloured(ui.theme.second_only,
                fmt::format("{} second only", comparison->second_only.size()));
    ui.tooltip("The panel Display colours the bodies of these pairs: First and second view");
    ImGui::BeginChild("list", {0, 0}, true, ImGuiWindowFlags_NavFlattened);
    const std::size_t first_count = comparison->first_only.size();
    clipped(first_count + comparison->second_only.size(), [&](std::size_t row) {
      const bool of_first = row < first_count;
      drawPair(of_first ? comparison->first_only[row] : comparison->second_only[row - first_count],
               of_first);
      if (row == 0) ui.note("first pair");
    });
    ImGui::EndChild();
  }

  void drawPair(Pair pair, bool of_first) {
    const auto& selected = session.selection.bodies();
    const bool is_selected = selected.size() == 2 && selected[0] == pair.a && selected[1] == pair.b;
    ImGui::PushID(of_first ? 0 : 1);
    if (ui.selectableLine(pairName(pair).c_str(), is_selected,
                          of_first ? "first only" : "second only",
                          of_first ? ui.theme.first_only : ui.theme.second_only,
                          "Select both bodies and move the camera to them")) {
      session.selection.flyToPair(pair);
    }
    ImGui::PopID();
  }

  void drawTimes() {
    const TrackReport* const first = findTrack(progress->tracks, session.tracks.shown());
    const TrackReport* const second = findTrack(progress->tracks, session.second->track);
    if (first == nullptr || second == nullptr || first == second || session.second->source) {
      ui.faintParagraph(
          "Times are compared if the views show two algorithms on the same recording.");
      return;
    }
    summarise(*first, *second);
    if (!ratios_.highest) {
      ui.faintParagraph("Play some frames to compare their times.");
      return;
    }
    ui.plain(
        fittingText(fmt::format("{} takes {:.3g} times as long as {} (median); slower in {} of {}",
                                first->spec.test_case.algorithm.id, ratios_.median,
                                second->spec.test_case.algorithm.id, ratios_.first_slower,
                                counted(ratios_.first_slower + ratios_.second_slower, "frame")),
                    ImGui::GetContentRegionAvail().x));
    ui.note("median");
    drawExtreme("most", "max", *ratios_.highest);
    Ui::sameLineIfFits(150 * ui.scale);
    drawExtreme("least", "min", *ratios_.lowest);
    drawRatios();
  }

  /// Draws a button that goes to the frame.
  void drawExtreme(const char* name, const char* text, TimeRatios::Extreme extreme) {
    const std::string label =
        fmt::format("{} {:.3g} in frame {}###{}", text, extreme.ratio, extreme.frame, name);
    if (ui.button(label.c_str(), "Go to this frame")) {
      session.playback.goTo(extreme.frame);
    }
  }

  void drawRatios() const {
    const PlotCurve curve{.label = "ratio", .colour = ui.theme.accent, .values = &ratios_.ratios};
    plotFrames("ratios", {curve},
               {.logarithmic = true,
                .unit = "",
                .limit = 1,
                .limit_colour = ui.theme.warning,
                .span = {},
                .marks = {}},
               session.timeline);
  }

  /// Throttled, because long recordings take a while.
  void summarise(const TrackReport& first, const TrackReport& second) {
    if (!throttle_.isDue({first.spec.number, second.spec.number})) return;
    ratios_ = ratiosOf(first, second);
  }

  bool times_only_ = false;
  TimeRatios ratios_;
  SummaryThrottle<std::array<int, 2>> throttle_;  ///< by the tracks' numbers
};

}  // namespace

extern const PanelSpec spec = {
    "Compare", DockArea::bottom,
    "Compare the two views: pairs that only one of them shows, and frame times",
    make<ComparePanel>};

}  // namespace broadmark::panels::compare
