// The whole recording over its frames: times of all algorithms as curves, live, with pairs, bodies
// and marks at what to look at.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "broadmark/render/plot.h"
#include "inspector/curve_colours.h"
#include "inspector/panel.h"

namespace broadmark::panels::timeline {
namespace {

Rgb rgbOf(ImGuiCol_ which) {
  const ImU32 packed = ImGui::GetColorU32(which);
  const auto channel = [&](int shift) { return (packed >> shift) & 0xFFU; };
  return channel(IM_COL32_R_SHIFT) << 16 | channel(IM_COL32_G_SHIFT) << 8 |
         channel(IM_COL32_B_SHIFT);
}

class TimelinePanel final : public Panel {
 public:
  TimelinePanel()
      : Panel("Timeline", Place::bottom,
              "The whole recording: times of all algorithms as curves, pairs and bodies, and marks "
              "at wrong and disturbed frames") {}

  void draw(PanelContext& context) override {
    if (context.progress.lanes.empty()) {
      context.ui.faintParagraph(
          "Add algorithms in the panel Algorithms to see the times of their frames as curves.");
    }
    if (!context.progress.footage) return;
    drawControls(context);
    const ImVec2 room = ImGui::GetContentRegionAvail();
    act(context, drawCurves(context, room));
  }

 private:
  void drawControls(PanelContext& context) {
    Ui& ui = context.ui;
    Timeline& timeline = context.session.timeline;
    std::vector<std::string> names = {"pairs"};
    for (const std::string& phase : kPhases.names()) names.push_back(phase);
    ui.combo("##quantity", quantity_, names, "What of the algorithms is plotted", 150 * ui.scale);
    besideIfRoom(110 * ui.scale);
    ui.checkbox("logarithmic", logarithmic_);
    besideIfRoom(65 * ui.scale);
    ui.checkbox("pairs", shows_pairs_,
                "How many pairs overlap, as a thin line whose scale stands at the right");
    if (context.progress.population.size() > 0) {
      besideIfRoom(75 * ui.scale);
      ui.checkbox("bodies", shows_bodies_, "How many bodies are present, as an area");
    }
    besideIfRoom(90 * ui.scale);
    ImGui::BeginDisabled(!timeline.zoomed());
    if (ui.button("All frames", "Undoes zooming with the wheel")) timeline.showAll();
    ImGui::EndDisabled();
    besideIfRoom(240 * ui.scale);
    drawBudget(context);
  }

  /// Puts what is `width` wide beside the last item, or, without room for it, into the next line.
  static void besideIfRoom(float width) {
    const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    if (ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x + width <= right) {
      ImGui::SameLine();
    }
  }

  static void drawBudget(PanelContext& context) {
    Ui& ui = context.ui;
    ImGui::AlignTextToFramePadding();
    ui.faint("budget");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(60 * ui.scale);
    ui.entry("budget", context.session.budget_ms, 0, 1e5,
             "What a frame may take, in milliseconds: a line in the plot; 0: none");
    ImGui::SameLine();
    std::uint64_t over = 0;
    for (const LaneReport& lane : context.progress.lanes) {
      if (context.session.budget_ms > 0) over += framesOver(lane, context.session.budget_ms);
    }
    ui.faint(fmt::format("ms: {} over", counted(over, "frame")));
    ui.note("over");
  }

  PlotResult drawCurves(PanelContext& context, ImVec2 room) const {
    const RunProgress& progress = context.progress;
    const Theme& theme = context.ui.theme;
    const Timeline& timeline = context.session.timeline;
    std::vector<PlotCurve> curves;
    PlotMarks wrong{.label = "wrong", .colour = theme.bad, .frames = {}};
    PlotMarks disturbed{.label = "disturbed", .colour = theme.warning, .frames = {}};
    for (const LaneReport& lane : progress.lanes) {
      curves.push_back(
          {.label = caseName(lane.spec.run),
           .colour = curveColour(lane.spec.number, theme.dark),
           .values = quantity_ == 0 ? &lane.curves.pairs : &lane.curves.seconds[quantity_ - 1],
           .circled = &lane.curves.disturbed,
           .hidden = hidden_.contains(lane.spec.number)});
      wrong.frames.push_back(&lane.curves.mismatches);
      disturbed.frames.push_back(&lane.curves.disturbed);
    }
    const PlotCurve pairs{
        .label = "pairs", .colour = rgbOf(ImGuiCol_Text), .values = &progress.pairs};
    const PlotCurve bodies{
        .label = "bodies", .colour = theme.faint, .values = &progress.population};
    const PlotOptions options{
        .logarithmic = logarithmic_,
        .unit = quantity_ == 0 ? "" : "s",
        .first = timeline.first(),
        .last = timeline.last(),
        .playhead = context.session.playback.frame(),
        .limit = quantity_ == 0 ? 0 : context.session.budget_ms * 1e-3,
        .limit_colour = theme.warning,
        .area = shows_bodies_ && bodies.values->size() > 0 ? &bodies : nullptr,
        .thin = shows_pairs_ ? &pairs : nullptr,
        .marks = {wrong, disturbed}};
    const PlotResult done = drawPlot("plot", curves, options, room.x, room.y);
    context.ui.note("plot");
    return done;
  }

  void act(PanelContext& context, const PlotResult& done) {
    Timeline& timeline = context.session.timeline;
    if (done.clicked_frame) context.session.playback.goTo(std::llround(*done.clicked_frame));
    if (done.toggled) toggle(context.progress.lanes[*done.toggled].spec.number);
    if (done.zoom != 0) timeline.zoom(done.zoom, done.zoom_at);
    if (done.moved != 0) timeline.move(done.moved);
  }

  void toggle(int lane) {
    if (hidden_.erase(lane) == 0) hidden_.insert(lane);
  }

  std::size_t quantity_ = kPhases.entries.size();  ///< 0: pairs; then the phases; the last: total
  bool logarithmic_ = true;
  bool shows_pairs_ = true;
  bool shows_bodies_ = true;
  std::set<int> hidden_;
};

}  // namespace

std::unique_ptr<Panel> makePanel() { return std::make_unique<TimelinePanel>(); }

}  // namespace broadmark::panels::timeline
