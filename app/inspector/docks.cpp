// The docked panels: where they are, which are hidden, which fill the window.

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <string>
#include <utility>

#include "inspector/inspector.h"

namespace broadmark {
namespace {

constexpr float kMinAreaExtent = 110;  // units: of a visible dock area
constexpr float kNarrow = 560;         // units: a window of this width has no room at the sides

}  // namespace

bool Inspector::isNarrow() const {
  const float width = ImGui::GetIO().DisplaySize.x;
  return width > 0 && width < kNarrow * ui_.scale;  // unknown before the first picture
}

DockArea Inspector::areaOf(const PanelTab& panel) const {
  if (isNarrow()) return DockArea::bottom;
  const auto moved = preferences_.areas.find(panel.name);
  if (moved == preferences_.areas.end()) return panel.area;
  return kDockAreas.find(moved->second).value_or(panel.area);
}

bool Inspector::isHidden(const PanelTab& panel) const {
  return std::ranges::find(preferences_.hidden, panel.name) != preferences_.hidden.end();
}

void Inspector::setHidden(const PanelTab& panel, bool hidden) {
  std::erase(preferences_.hidden, panel.name);
  if (hidden) {
    preferences_.hidden.emplace_back(panel.name);
  } else {
    session_.notices.raisePanel(panel.name);
  }
}

void Inspector::movePanel(const PanelTab& panel, DockArea to) {
  preferences_.areas[panel.name] = kDockAreas.nameOf(to);
  session_.notices.raisePanel(panel.name);
}

void Inspector::maximise(std::optional<DockArea> area) {
  const bool restore = area ? maximised_ == area : view_alone_;
  maximised_.reset();
  view_alone_ = false;
  if (restore) return;
  maximised_ = area;
  view_alone_ = !area;
}

DockArea Inspector::areaInUse() const {
  const ImGuiWindow* window = GImGui->NavWindow;
  while (window != nullptr && window->ParentWindow != nullptr) window = window->ParentWindow;
  return window == nullptr ? DockArea::bottom
                           : kDockAreas.find(window->Name).value_or(DockArea::bottom);
}

bool Inspector::hasVisiblePanel(DockArea area) const {
  return std::ranges::any_of(
      panels_, [&](const PanelTab& panel) { return areaOf(panel) == area && !isHidden(panel); });
}

void Inspector::resetLayout() {
  maximised_.reset();
  view_alone_ = false;
  preferences_.resetLayout();
  for (const auto& [area, name] : kDockAreas.entries) {
    const auto first = std::ranges::find(panels_, area, &PanelTab::area);
    if (first != panels_.end()) session_.notices.raisePanel(first->name);
  }
}

void Inspector::showRaisedPanels() {
  raised_ = std::exchange(session_.notices.panels_to_raise, {});
  for (const PanelTab& panel : panels_) {
    if (!isRaised(panel)) continue;
    if (areaOf(panel) == DockArea::bottom) bottom_wanted_ = true;
    std::erase(preferences_.hidden, panel.name);
    if (view_alone_ || maximised_ != areaOf(panel)) {
      maximised_.reset();
      view_alone_ = false;
    }
  }
  for (const std::string& panel : std::exchange(in_front_, {})) raised_.push_back(panel);
}

bool Inspector::isRaised(const PanelTab& panel) const {
  return std::ranges::find(raised_, panel.name) != raised_.end();
}

Inspector::Layout Inspector::layout(float width, float top, float bottom) const {
  const float unit = ui_.scale;
  // In a small window the dock areas shrink, then vanish, to make room for the view.
  const auto extent = [&](DockArea area, double preferred, float max) {
    if (view_alone_ || !hasVisiblePanel(area)) return 0.0F;
    const float actual = std::min(static_cast<float>(preferred) * unit, max);
    return actual < kMinAreaExtent * unit ? 0.0F : actual;
  };
  return {.left = extent(DockArea::left, preferences_.left, 0.30F * width),
          .right = extent(DockArea::right, preferences_.right, 0.30F * width),
          .bottom = extent(DockArea::bottom, preferences_.bottom,
                           (isNarrow() ? 0.60F : 0.40F) * (bottom - top))};
}

void Inspector::splitter(const char* id, ImVec2 position, ImVec2 size, double& extent, float sign) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  beginAt(id, position, size, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoBackground);
  ImGui::InvisibleButton(id, {std::max(size.x, 1.0F), std::max(size.y, 1.0F)});
  ui_.note(id);
  const bool vertical = size.y > size.x;
  if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
    ImGui::SetMouseCursor(vertical ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
    ImGui::GetWindowDrawList()->AddRectFilled(position, {position.x + size.x, position.y + size.y},
                                              colour(ui_.theme.accent, 0.5F));
  }
  if (ImGui::IsItemActive()) {
    const ImVec2 moved = ImGui::GetIO().MouseDelta;
    extent += static_cast<double>(sign * (vertical ? moved.x : moved.y) / ui_.scale);
    extent = std::max(extent, static_cast<double>(kMinAreaExtent));
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

void Inspector::drawDockArea(DockArea area, const RunProgress& progress, ImVec2 position,
                             ImVec2 size) {
  const std::string name(kDockAreas.nameOf(area));
  beginAt(name.c_str(), position, size);
  drawn_areas_[static_cast<std::size_t>(area)] = true;
  focusIfRequested(static_cast<std::size_t>(area));
  if (ImGui::BeginTabBar(name.c_str(), ImGuiTabBarFlags_FittingPolicyScroll)) {
    for (const PanelTab& panel : panels_) {
      if (areaOf(panel) == area && !isHidden(panel)) drawTab(panel, name, progress);
    }
    ImGui::EndTabBar();
  }
  ImGui::End();
}

void Inspector::drawTab(const PanelTab& panel, const std::string& area,
                        const RunProgress& progress) {
  const bool open =
      ImGui::BeginTabItem(panel.name, nullptr, isRaised(panel) ? ImGuiTabItemFlags_SetSelected : 0);
  ui_.note(panel.name);
  ui_.tooltip(panel.tooltip);
  if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0)) maximise(areaOf(panel));
  // A raised tab is open in the next picture.
  if (open && panel.name == panel_to_focus_ && !isRaised(panel)) focusTab(areaOf(panel));
  drawTabMenu(panel);
  if (!open) return;
  preferences_.tabs[area] = panel.name;
  const auto scope = ui_.scope(panel.name);
  ImGui::BeginChild(panel.name, {0, 0}, false, ImGuiWindowFlags_NavFlattened);
  panel.panel->drawOf(progress);
  ImGui::EndChild();
  ImGui::EndTabItem();
}

void Inspector::drawTabMenu(const PanelTab& panel) {
  if (!ImGui::BeginPopupContextItem(panel.name)) return;
  const auto scope = ui_.scope("Panel");
  if (ui_.menuItem("Maximise", nullptr, maximised_ == areaOf(panel))) {
    const DockArea area = areaOf(panel);
    if (maximised_ != area) session_.notices.raisePanel(panel.name);
    maximise(area);
  }
  if (ui_.menuItem("Hide")) setHidden(panel, true);
  for (const auto& [area, name] : kDockAreas.entries) {
    const std::string label = "Move to the " + std::string(name);
    const bool movable = !isNarrow() && areaOf(panel) != area;
    if (ui_.menuItem(label.c_str(), nullptr, false, movable)) movePanel(panel, area);
  }
  ImGui::EndPopup();
}

}  // namespace broadmark
