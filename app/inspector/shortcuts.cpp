// The keyboard: shortcuts, and the navigation among widgets.

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <set>
#include <string>

#include "inspector/inspector.h"

namespace broadmark {
namespace {

bool isArrow(const UserCommand& command) {
  return command.key == GLFW_KEY_LEFT || command.key == GLFW_KEY_RIGHT;
}

/// Whether keyboard navigation uses the key of this command.
bool movesFocus(const UserCommand& command) {
  constexpr Key kKeys[] = {GLFW_KEY_SPACE, GLFW_KEY_HOME, GLFW_KEY_END};
  return !command.ctrl &&
         (isArrow(command) || std::ranges::find(kKeys, command.key) != std::end(kKeys));
}

}  // namespace

void Inspector::prepareNavigation() {
  ImGuiIO& io = ImGui::GetIO();
  const bool popup = !GImGui->OpenPopupStack.empty();
  for (const bool pressed : io.MouseDown) {
    if (!pressed) continue;
    keyboard_navigation_ = false;
    panel_to_focus_.clear();
  }
  const bool on = keyboard_navigation_ || popup;
  io.ConfigFlags = on ? io.ConfigFlags | ImGuiConfigFlags_NavEnableKeyboard
                      : io.ConfigFlags & ~ImGuiConfigFlags_NavEnableKeyboard;
  // Enter acts like Space, except in a dialog, which it confirms.
  const bool enter = io.KeysDown[GLFW_KEY_ENTER] && !io.WantTextInput;
  if (on && !ui_.inDialog() && enter) io.NavInputs[ImGuiNavInput_Activate] = 1;
  if (!on) GImGui->NavDisableHighlight = true;
}

void Inspector::focusNextArea(int step) {
  // The dock areas, then the playback.
  const auto count = static_cast<int>(drawn_areas_.size());
  int area = keyboard_navigation_ ? static_cast<int>(focused_) : step > 0 ? -1 : 0;
  for (int tried = 0; tried < count; ++tried) {
    area = (area + step + count) % count;
    if (!drawn_areas_[static_cast<std::size_t>(area)]) continue;
    focus_request_ = static_cast<std::size_t>(area);
    return;
  }
}

void Inspector::enterPanel(const PanelTab& panel) {
  session_.notices.raisePanel(panel.name);
  // A click in a menu leaves the keys to the view.
  if (!ImGui::IsMouseReleased(0)) panel_to_focus_ = panel.name;
}

void Inspector::focusIfRequested(std::size_t area) {
  if (focus_request_ != area) return;
  focus_request_.reset();
  navigateFrom(area);
  ImGui::NavInitWindow(ImGui::GetCurrentWindow(), true);
}

void Inspector::focusTab(DockArea area) {
  panel_to_focus_.clear();
  ImGui::SetFocusID(ImGui::GetItemID(), ImGui::GetCurrentWindow());
  navigateFrom(static_cast<std::size_t>(area));
}

void Inspector::navigateFrom(std::size_t area) {
  focused_ = area;
  keyboard_navigation_ = true;
  ImGui::FocusWindow(ImGui::GetCurrentWindow());
  GImGui->NavDisableHighlight = false;
}

void Inspector::escape() {
  if (!ui_.escaped()) return;
  if (keyboard_navigation_) {
    keyboard_navigation_ = false;
    return;
  }
  Tools& tools = session_.document.tools;
  if (help_open_) {
    help_open_ = false;
  } else if (start_page_.isShown(session_) && session_.playback.source()) {
    start_page_.close();
  } else if (maximised_ || view_alone_) {
    maximised_.reset();
    view_alone_ = false;
  } else if (views_.first().hands().cancel(session_)) {
    return;
  } else if (session_.document.shown() && tools.tool == Tool::brush) {
    tools.tool = Tool::none;
  } else if (session_.timeline.span()) {
    session_.timeline.clearSpan();
  } else {
    session_.selection.select({});
  }
}

void Inspector::handleShortcuts() {
  const ImGuiIO& io = ImGui::GetIO();
  const bool dialog = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId);
  if (io.WantTextInput || dialog || io.KeyAlt) return;
  // Arrows choose an example.
  const bool arrows_used = keyboard_navigation_ || start_page_.isShown(session_);
  std::set<Key> pressed;
  for (const UserCommand& command : commands_) {
    if (command.key != 0 && ImGui::IsKeyPressed(static_cast<ImGuiKey>(command.key))) {
      pressed.insert(command.key);
    }
  }
  for (const Key key : pressed) {
    const UserCommand* const command = commandOf(commands_, key, io.KeyCtrl, io.KeyShift);
    if (command == nullptr) continue;
    if (keyboard_navigation_ && movesFocus(*command)) continue;
    if (arrows_used && isArrow(*command)) continue;
    command->action();
  }
}

}  // namespace broadmark
