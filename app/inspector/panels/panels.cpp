// The list of panels, and their shared helpers.

#include <algorithm>
#include <cmath>

#include "inspector/panels/panel.h"

namespace broadmark {

std::vector<Rgb> PanelContext::trackColours() const {
  std::vector<std::string_view> algorithms;
  for (const TrackReport& track : progress->tracks) {
    algorithms.emplace_back(track.spec.test_case.algorithm.id);
  }
  return curveColours(algorithms, ui.theme);
}

PlotResult PanelContext::plotFrames(const char* name, const std::vector<PlotCurve>& curves,
                                    PlotOptions options, Timeline& zoom, bool is_playback) const {
  options.first = zoom.first();
  options.last = zoom.last();
  if (is_playback) options.playhead = session.playback.frame();
  const ImVec2 size = ImGui::GetContentRegionAvail();
  options.shapes = ui.beginPlot(name);
  const PlotResult result = drawPlot(name, curves, options, size.x, size.y);
  ui.endPlot(name);
  if (result.zoom != 0) zoom.zoom(result.zoom, result.zoom_at);
  if (result.moved != 0) zoom.scroll(result.moved);
  if (result.clicked_frame && is_playback) {
    session.playback.goTo(std::llround(*result.clicked_frame));
  }
  return result;
}

bool PanelContext::wideButton(const char* label, const char* tooltip, bool enabled) const {
  return ButtonRow(ui, 1).button(label, tooltip, enabled);
}

ButtonRow::ButtonRow(Ui& ui, int count) : ui_(ui), count_(count) {
  const float gaps = ImGui::GetStyle().ItemSpacing.x * static_cast<float>(count - 1);
  const float width = ImGui::GetContentRegionAvail().x - gaps;
  width_ = std::max(std::floor(width / static_cast<float>(count)), 1.0F);
}

bool ButtonRow::button(const char* label, const char* tooltip, bool enabled) {
  const float width = std::max(width_, Ui::buttonWidth(label));
  // A long label may need a line of its own.
  if (drawn_++ % count_ != 0) Ui::sameLineIfFits(width);
  return ui_.button(label, tooltip, width, enabled);
}

#define PANEL(name)            \
  namespace panels::name {     \
  extern const PanelSpec spec; \
  }
#include "inspector_panels.inc"
#undef PANEL

std::vector<PanelTab> makePanels(const PanelContext& context) {
  std::vector<PanelTab> tabs;
#define PANEL(name) tabs.push_back({panels::name::spec, panels::name::spec.make(context)});
#include "inspector_panels.inc"
#undef PANEL
  return tabs;
}

}  // namespace broadmark
