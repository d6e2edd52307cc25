// The help page: keys and mouse.

#include <fmt/format.h>
#include <imgui.h>

#include <utility>

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
    {"Drag a handle", "move, rotate or scale the selected bodies (with Ctrl: snap to steps)"},
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

}  // namespace

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
    for (const UserCommand& command : commands_) {
      if (command.key != 0) row(command.keys().c_str(), command.doc.c_str());
    }
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
