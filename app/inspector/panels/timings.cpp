// The times of all frames as curves, live.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "broadmark/render/plot.h"
#include "inspector/curve_colours.h"
#include "inspector/panel.h"
#include "words.h"

namespace broadmark::panels::timings {
namespace {

/// Shown of a simulation that has just begun.
constexpr std::uint32_t kFewestFrames = 20;
constexpr float kOneRowWidth = 600;  // units: narrower, the controls have two rows

class TimingsPanel final : public Panel {
 public:
  TimingsPanel()
      : Panel("Timings", Place::bottom,
              "Times of all frames as curves; behind them, where bodies come and go, how many are "
              "present") {}

  void draw(PanelContext& context) override {
    if (context.progress.lanes.empty()) {
      context.ui.paragraph(
          "Add algorithms in the panel Algorithms to see the times of their frames as curves.");
      if (context.progress.population.empty()) return;
    }
    drawControls(context);
    const std::vector<PlotCurve> curves = makeCurves(context);
    const auto last = static_cast<double>(std::max(kFewestFrames, context.progress.known_frames));
    if (!zoomed_) {
      first_ = 0;
      last_ = last;
    }
    const PlotCurve population{
        .label = "bodies", .colour = context.ui.theme.faint, .values = context.progress.population};
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const PlotResult done =
        drawPlot("plot", curves,
                 {.logarithmic = logarithmic_,
                  .unit = quantity_ == 0 ? "" : "s",
                  .marked_frame = static_cast<double>(context.session.playback.frame()),
                  .first = first_,
                  .last = last_,
                  .dark = context.ui.theme.dark,
                  .limit = quantity_ == 0 ? 0 : context.session.budget_ms * 1e-3,
                  .backdrop = population.values.empty() ? nullptr : &population},
                 room.x, room.y);
    context.ui.note("plot");
    if (done.clicked_frame) {
      context.session.playback.goTo(std::llround(*done.clicked_frame));
    }
    if (done.toggled) toggle(context.progress.lanes[*done.toggled].spec.number);
    if (done.zoom != 0) zoom(done, last);
  }

 private:
  void drawControls(PanelContext& context) {
    Ui& ui = context.ui;
    const bool roomy = ImGui::GetContentRegionAvail().x > kOneRowWidth * ui.scale;
    std::vector<std::string> names = {"pairs"};
    for (const std::string& phase : kPhases.names()) names.push_back(phase);
    const float width = 150 * ui.scale;
    ui.combo("##quantity", quantity_, names, "What is plotted", width);
    ImGui::SameLine();
    ui.checkbox("logarithmic", logarithmic_);
    ImGui::SameLine();
    ImGui::BeginDisabled(!zoomed_);
    if (ui.button("All frames", "Undoes zooming with the wheel")) zoomed_ = false;
    ImGui::EndDisabled();
    if (roomy) ImGui::SameLine();
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

  std::vector<PlotCurve> makeCurves(const PanelContext& context) const {
    std::vector<PlotCurve> curves;
    for (const LaneReport& lane : context.progress.lanes) {
      PlotCurve& curve = curves.emplace_back();
      curve.label = caseName(lane.spec.run);
      curve.colour = curveColour(lane.spec.number, context.ui.theme.dark);
      curve.hidden = hidden_.contains(lane.spec.number);
      curve.values.assign(lane.frames.size() + 1, std::numeric_limits<double>::quiet_NaN());
      for (std::uint32_t frame = 1; frame <= lane.frames.size(); ++frame) {
        const FrameRecord* record = lane.record(frame);
        if (record == nullptr) continue;
        curve.values[frame] = quantityOf(*record);
        if (record->disturbed) curve.disturbed.push_back(frame);
      }
    }
    return curves;
  }

  [[nodiscard]] double quantityOf(const FrameRecord& record) const {
    if (quantity_ == 0) return static_cast<double>(record.pairs);
    return static_cast<double>(record.times.ns[quantity_ - 1]) * 1e-9;
  }

  void toggle(int lane) {
    if (hidden_.erase(lane) == 0) hidden_.insert(lane);
  }

  void zoom(const PlotResult& done, double last) {
    const double factor = std::pow(0.8, done.zoom);
    const double span = std::clamp((last_ - first_) * factor, 4.0, last);
    const double share = (done.zoom_at - first_) / (last_ - first_);
    first_ = std::clamp(done.zoom_at - share * span, 0.0, std::max(last - span, 0.0));
    last_ = first_ + span;
    zoomed_ = span < last;
  }

  std::size_t quantity_ = kPhases.entries.size();  ///< 0: pairs; then the phases; the last: total
  bool logarithmic_ = true;
  bool zoomed_ = false;
  double first_ = 0;
  double last_ = 1;
  std::set<int> hidden_;
};

}  // namespace

std::unique_ptr<Panel> makePanel() { return std::make_unique<TimingsPanel>(); }

}  // namespace broadmark::panels::timings
