// The keyboard shortcuts, and the help page.

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>

#include "inspector/authoring/author_dialogs.h"
#include "inspector/inspector.h"

namespace broadmark {
namespace {

/// Mouse actions, for the help page.
constexpr std::pair<const char*, const char*> kMouse[] = {
    {"Left drag", "orbit the camera"},
    {"Right or middle drag", "pan the camera"},
    {"Wheel", "zoom towards the pointer, or away"},
    {"Click", "select a body or its group (with Ctrl: add or remove it)"},
    {"Alt + click", "select a single body of a group"},
    {"Drag a handle", "move, turn or scale the selected bodies (with Ctrl: snap to steps)"},
    {"Click, drag with brush", "paint bodies on the ground or on other bodies"},
    {"Shift + drag", "select all bodies in a rectangle"},
    {"Double click", "fly to a body"},
    {"Drop a file", "open it"},
};

/// Keys of the keyboard navigation, which Dear ImGui handles; for the help page.
constexpr std::pair<const char*, const char*> kNavigation[] = {
    {"Arrows", "after F6, or in a list: focus the next widget"},
    {"Enter, Space", "press the focused widget, or edit its text"},
    {"Alt", "after F6: focus the menus, or return"},
    {"Escape", "after F6: back, and finally to the view"},
};

/// Whether keyboard navigation uses the key of this shortcut.
bool movesFocus(const Shortcut& shortcut) {
  constexpr Key kKeys[] = {GLFW_KEY_SPACE, GLFW_KEY_LEFT, GLFW_KEY_RIGHT, GLFW_KEY_HOME,
                           GLFW_KEY_END};
  return !shortcut.ctrl && std::ranges::find(kKeys, shortcut.key) != std::end(kKeys);
}

}  // namespace

void Inspector::makeShortcuts() {
  shortcuts_ = {
      {GLFW_KEY_SPACE, false, false, "play or pause",
       [this] { session_.play(!session_.playback.playing()); }},
      {GLFW_KEY_LEFT, false, false, "previous frame", [this] { session_.playback.step(-1); }},
      {GLFW_KEY_RIGHT, false, false, "next frame", [this] { session_.playback.step(1); }},
      {GLFW_KEY_HOME, false, false, "go to the first frame", [this] { session_.playback.goTo(0); }},
      {GLFW_KEY_END, false, false, "go to the last frame",
       [this] { session_.playback.goTo(session_.playback.lastFrame()); }},
      {GLFW_KEY_F, false, false, "fly to the selection, or to all",
       [this] { session_.selection.flyToSelection(); }},
      {GLFW_KEY_H, false, false, "hide or show bodies without overlaps",
       [this] { session_.display.hide_free = !session_.display.hide_free; }},
      {GLFW_KEY_C, false, false, "next colouring",
       [this] { session_.display.colourBy(session_.display.colouring + 1); }},
      {GLFW_KEY_V, false, false, "open or close the second view",
       [this] { session_.showSecond(!session_.second); }},
      {GLFW_KEY_M, false, false, "authored scene: move gizmo on or off",
       [this] { toggleTool(Tool::move); }},
      {GLFW_KEY_T, false, false, "authored scene: rotation gizmo on or off",
       [this] { toggleTool(Tool::turn); }},
      {GLFW_KEY_R, false, false, "authored scene: scale gizmo on or off",
       [this] { toggleTool(Tool::scale); }},
      {GLFW_KEY_L, false, false,
       "authored scene: align the gizmo with the first body or with the world",
       [this] { session_.document.tools.local = !session_.document.tools.local; }},
      {GLFW_KEY_B, false, false, "authored scene: brush on or off",
       [this] { toggleTool(Tool::brush); }},
      {GLFW_KEY_ESCAPE, false, false,
       "close a list, a dialog or this page; cancel a drag; clear the brush, span or selection",
       [this] { escape(); }},
      {GLFW_KEY_O, true, false, kOpenFile, [this] { askOpen(); }},
      {GLFW_KEY_S, true, false, kSave,
       [this] {
         if (session_.document.shown()) {
           saveScene(files_, session_);
         } else if (session_.playback.source()) {
           askSaveRecording();
         }
       }},
      {GLFW_KEY_Z, true, false, "undo an edit",
       [this] { editAuthored(&scenes::SceneEditor::undo); }},
      {GLFW_KEY_Z, true, true, "redo an edit",
       [this] { editAuthored(&scenes::SceneEditor::redo); }},
      {GLFW_KEY_A, true, false, "select all bodies of the authored scene",
       [this] { editAuthored(&scenes::SceneEditor::selectAll); }},
      {GLFW_KEY_D, true, false, "duplicate the selected bodies in place",
       [this] { editAuthored([](scenes::SceneEditor& editor) { editor.duplicate({}); }); }},
      {GLFW_KEY_G, true, false, "group the selected bodies: a click selects all of them",
       [this] { editAuthored(&scenes::SceneEditor::group); }},
      {GLFW_KEY_G, true, true, "ungroup the selected bodies",
       [this] { editAuthored(&scenes::SceneEditor::ungroup); }},
      {GLFW_KEY_DELETE, false, false, "delete the selected bodies",
       [this] { editAuthored(&scenes::SceneEditor::erase); }},
      {GLFW_KEY_F6, false, false, "focus the next area; then arrows move among its widgets",
       [this] { focusNextArea(1); }},
      {GLFW_KEY_F6, false, true, "focus the previous area", [this] { focusNextArea(-1); }},
      {GLFW_KEY_F1, false, false, kShowHelp, [this] { help_open_ = !help_open_; }},
      {GLFW_KEY_F12, false, false, kSaveScreenshot, [this] { screenshot_requested_ = true; }},
      {GLFW_KEY_Q, true, false, kQuit, [this] { close(); }},
  };
  // Ctrl+1 to Ctrl+9 and Ctrl+0, then the same with Shift.
  constexpr std::size_t kDigits = 10;
  for (std::size_t i = 0; i < std::min(panels_.size(), 2 * kDigits); ++i) {
    shortcuts_.push_back({static_cast<Key>(GLFW_KEY_0 + (i + 1) % kDigits), true, i >= kDigits,
                          fmt::format("show the panel {}", panels_[i].name),
                          [this, i] { enterPanel(panels_[i]); }});
  }
}

std::string Shortcut::keys() const {
  return fmt::format("{}{}{}", ctrl ? "Ctrl+" : "", shift ? "Shift+" : "", keyName(key));
}

std::string Inspector::keysFor(std::string_view doc) const {
  const auto found = std::ranges::find(shortcuts_, doc, &Shortcut::doc);
  return found == shortcuts_.end() ? "" : found->keys();
}

void Inspector::prepareNavigation() {
  ImGuiIO& io = ImGui::GetIO();
  const bool popup = !GImGui->OpenPopupStack.empty();
  for (const bool pressed : io.MouseDown) {
    if (pressed) keyboard_navigation_ = false;
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
  const auto count = static_cast<int>(kDockAreas.entries.size() + 1);
  const int from = keyboard_navigation_ ? static_cast<int>(focused_) : step > 0 ? -1 : 0;
  focus_request_ = static_cast<std::size_t>((from + step + count) % count);
}

void Inspector::enterPanel(const PanelTab& panel) {
  session_.notices.raisePanel(panel.name);
  for (std::size_t i = 0; i < kDockAreas.entries.size(); ++i) {
    if (kDockAreas.entries[i].value == panel.area) focus_request_ = i;
  }
}

void Inspector::focusIfRequested(std::size_t area) {
  if (focus_request_ != area) return;
  focus_request_.reset();
  focused_ = area;
  keyboard_navigation_ = true;
  ImGuiWindow* const window = ImGui::GetCurrentWindow();
  ImGui::FocusWindow(window);
  ImGui::NavInitWindow(window, true);
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
  } else if (views_.first().hands().cancel()) {
    return;
  } else if (session_.document.shown() && tools.tool == Tool::brush) {
    tools.tool = Tool::none;
  } else if (session_.timeline.span()) {
    session_.timeline.clearSpan();
  } else {
    session_.selection.select({});
  }
}

void Inspector::toggleTool(Tool tool) {
  if (session_.document.shown()) session_.document.tools.toggle(tool);
}

void Inspector::editAuthored(const std::function<void(scenes::SceneEditor&)>& change) {
  if (session_.document.shown()) session_.document.edit(change);
}

void Inspector::handleShortcuts() {
  const ImGuiIO& io = ImGui::GetIO();
  const bool dialog = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId);
  if (io.WantTextInput || dialog) return;
  for (const Shortcut& shortcut : shortcuts_) {
    if (keyboard_navigation_ && movesFocus(shortcut)) continue;
    if (io.KeyCtrl == shortcut.ctrl && io.KeyShift == shortcut.shift && !io.KeyAlt &&
        ImGui::IsKeyPressed(static_cast<ImGuiKey>(shortcut.key))) {
      shortcut.action();
    }
  }
}

void Inspector::drawHelp() {
  if (!help_open_) return;
  const auto scope = ui_.scope("Keys and mouse");
  ui_.placeInMiddle({600, 660});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
  ImGui::Begin("Keys and mouse", &help_open_,
               ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                   ImGuiWindowFlags_NoSavedSettings);
  if (ImGui::BeginTable("keys", 2)) {
    ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, 170 * ui_.scale);
    const auto row = [&](const char* what, const char* doc) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ui_.coloured(ui_.theme.accent, what);
      ImGui::TableNextColumn();
      ui_.paragraph(doc);
    };
    for (const Shortcut& shortcut : shortcuts_) row(shortcut.keys().c_str(), shortcut.doc.c_str());
    row("", "");
    for (const auto& [what, doc] : kMouse) row(what, doc);
    for (const FlyKey& fly : flyKeys()) {
      row(keyName(fly.key).c_str(), fmt::format("fly {}, over the view", fly.doc).c_str());
    }
    row("", "");
    for (const auto& [what, doc] : kNavigation) row(what, doc);
    ImGui::EndTable();
  }
  if (ui_.button("Close")) help_open_ = false;
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace broadmark
