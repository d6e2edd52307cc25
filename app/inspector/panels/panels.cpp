// The list of panels, and what they share.

#include <algorithm>
#include <cmath>

#include "inspector/panels/panel.h"

namespace broadmark {

std::vector<Rgb> PanelContext::trackColours() const {
  std::vector<std::string_view> families;
  for (const TrackReport& track : progress->tracks) {
    families.emplace_back(track.spec.test_case.algorithm.family);
  }
  return curveColours(families, ui.theme);
}

PlotResult PanelContext::plotFrames(const char* name, const std::vector<PlotCurve>& curves,
                                    PlotOptions options, Timeline& zoom, bool plays) const {
  options.first = zoom.first();
  options.last = zoom.last();
  if (plays) options.playhead = session.playback.frame();
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const PlotResult done = drawPlot(name, curves, options, room.x, room.y);
  ui.note(name);
  if (done.zoom != 0) zoom.zoom(done.zoom, done.zoom_at);
  if (done.moved != 0) zoom.move(done.moved);
  if (done.clicked_frame && plays) session.playback.goTo(std::llround(*done.clicked_frame));
  return done;
}

bool PanelContext::wideButton(const char* label, const char* tooltip, bool enabled) const {
  return ButtonRow(ui, 1).button(label, tooltip, enabled);
}

ButtonRow::ButtonRow(Ui& ui, int count) : ui_(ui), count_(count) {
  const float gaps = ImGui::GetStyle().ItemSpacing.x * static_cast<float>(count - 1);
  const float room = ImGui::GetContentRegionAvail().x - gaps;
  width_ = std::max(std::floor(room / static_cast<float>(count)), 1.0F);
}

bool ButtonRow::button(const char* label, const char* tooltip, bool enabled) {
  if (drawn_++ % count_ != 0) ImGui::SameLine();
  return ui_.button(label, tooltip, width_, enabled);
}

#define PANEL(name)            \
  namespace panels::name {     \
  extern const PanelKind kind; \
  }
#include "inspector_panels.inc"
#undef PANEL

std::vector<PanelTab> makePanels(const PanelContext& context) {
  std::vector<PanelTab> made;
#define PANEL(name) made.push_back({panels::name::kind, panels::name::kind.make(context)});
#include "inspector_panels.inc"
#undef PANEL
  return made;
}

}  // namespace broadmark
