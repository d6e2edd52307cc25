// The list of panels, and what they share.

#include <algorithm>
#include <cmath>

#include "inspector/panels/panel.h"

namespace broadmark {

ButtonRow::ButtonRow(Ui& ui, int count) : ui_(ui), count_(count) {
  const float gaps = ImGui::GetStyle().ItemSpacing.x * static_cast<float>(count - 1);
  const float room = ImGui::GetContentRegionAvail().x - gaps;
  width_ = std::max(std::floor(room / static_cast<float>(count)), 1.0F);
}

bool ButtonRow::button(const char* label, const char* tooltip, bool enabled) {
  if (drawn_++ % count_ != 0) ImGui::SameLine();
  ImGui::BeginDisabled(!enabled);
  const bool pressed = ui_.button(label, tooltip, width_);
  ImGui::EndDisabled();
  return pressed;
}

#define PANEL(name)                   \
  namespace panels::name {            \
  std::unique_ptr<Panel> makePanel(); \
  }
#include "inspector_panels.inc"
#undef PANEL

std::vector<std::unique_ptr<Panel>> makePanels() {
  std::vector<std::unique_ptr<Panel>> made;
#define PANEL(name) made.push_back(panels::name::makePanel());
#include "inspector_panels.inc"
#undef PANEL
  return made;
}

}  // namespace broadmark
