// What keys do, and the page that lists it.

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include "inspector/author_dialogs.h"
#include "inspector/inspector.h"

namespace broadmark {
namespace {

/// What the mouse does, for the help page.
constexpr std::pair<const char*, const char*> kMouse[] = {
    {"Left drag", "turn the camera about the middle"},
    {"Right or middle drag", "move the camera sideways"},
    {"Wheel", "towards the pointer, or away"},
    {"Click", "select a body (with Ctrl: add or remove it)"},
    {"Shift + drag", "select all bodies in a rectangle"},
    {"Double click", "fly to a body"},
    {"W A S D Q E", "fly, while the mouse is over the view"},
    {"Drop a file", "open it"},
};

}  // namespace

void Inspector::makeShortcuts() {
  shortcuts_ = {
      {GLFW_KEY_SPACE, false, false, "Space", "play or pause",
       [this] { session_.play(!session_.playback.playing()); }},
      {GLFW_KEY_LEFT, false, false, "Left", "one frame back",
       [this] { session_.playback.step(-1); }},
      {GLFW_KEY_RIGHT, false, false, "Right", "one frame on",
       [this] { session_.playback.step(1); }},
      {GLFW_KEY_HOME, false, false, "Home", "to the first frame",
       [this] { session_.playback.goTo(0); }},
      {GLFW_KEY_END, false, false, "End", "to the last frame",
       [this] { session_.playback.goTo(session_.playback.lastFrame()); }},
      {GLFW_KEY_F, false, false, "F", "fly to the selection, or to all",
       [this] { session_.selection.flyThere(); }},
      {GLFW_KEY_H, false, false, "H", "hide what overlaps nothing, or show it",
       [this] { session_.view.hide_free = !session_.view.hide_free; }},
      {GLFW_KEY_C, false, false, "C", "the next colouring", [this] { ++session_.view.colouring; }},
      {GLFW_KEY_ESCAPE, false, false, "Escape", "select nothing",
       [this] { session_.selection.select({}); }},
      {GLFW_KEY_O, true, false, "Ctrl+O", "open a file", [this] { askOpen(); }},
      {GLFW_KEY_S, true, false, "Ctrl+S",
       "save the authored scene, or the frames known so far as a recording",
       [this] {
         if (session_.document.shown()) {
           saveScene(files_, session_);
         } else if (session_.playback.footage()) {
           askSaveRecording();
         }
       }},
      {GLFW_KEY_Z, true, false, "Ctrl+Z", "undo an edit of the scene",
       [this] { editAuthored(&scenes::SceneEditor::undo); }},
      {GLFW_KEY_Z, true, true, "Ctrl+Shift+Z", "redo it",
       [this] { editAuthored(&scenes::SceneEditor::redo); }},
      {GLFW_KEY_A, true, false, "Ctrl+A", "select all bodies of the authored scene",
       [this] { editAuthored(&scenes::SceneEditor::selectAll); }},
      {GLFW_KEY_DELETE, false, false, "Delete", "delete the selected bodies",
       [this] { editAuthored(&scenes::SceneEditor::erase); }},
      {GLFW_KEY_F1, false, false, "F1", "this page", [this] { help_ = !help_; }},
      {GLFW_KEY_F12, false, false, "F12", "save a picture of the window",
       [this] { screenshot_asked_ = true; }},
      {GLFW_KEY_Q, true, false, "Ctrl+Q", "quit", [this] { close(); }},
  };
}

void Inspector::editAuthored(void (scenes::SceneEditor::*change)()) {
  if (session_.document.shown()) session_.document.edit(change);
}

void Inspector::handleShortcuts() {
  const ImGuiIO& io = ImGui::GetIO();
  const bool dialog = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId);
  if (io.WantTextInput || dialog) return;
  for (const Shortcut& shortcut : shortcuts_) {
    if (io.KeyCtrl == shortcut.ctrl && io.KeyShift == shortcut.shift && !io.KeyAlt &&
        ImGui::IsKeyPressed(shortcut.key)) {
      shortcut.act();
    }
  }
}

void Inspector::drawHelp() {
  if (!help_) return;
  const auto scope = ui_.scope("Keys and mouse");
  ui_.placeInMiddle({560, 640});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
  ImGui::Begin("Keys and mouse", &help_,
               ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                   ImGuiWindowFlags_NoSavedSettings);
  if (ImGui::BeginTable("keys", 2)) {
    ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, 170 * ui_.scale);
    const auto row = [&](const char* what, const char* doc) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ui_.coloured(ui_.theme.accent, what);
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(doc);
    };
    for (const Shortcut& shortcut : shortcuts_) row(shortcut.keys, shortcut.doc);
    row("", "");
    for (const auto& [what, doc] : kMouse) row(what, doc);
    ImGui::EndTable();
  }
  if (ui_.button("Close")) help_ = false;
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace broadmark
