// Menus and the palette of commands.

#include "inspector/commands.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <ranges>
#include <set>
#include <sstream>

namespace broadmark {
namespace {

std::string lowered(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Where a command is in the menus: "File › Open…".
std::string placeOf(const UserCommand& command) {
  if (command.menu.empty()) return "";
  std::string place;
  for (const char c : command.menu) place += c == '/' ? std::string(" › ") : std::string(1, c);
  return fmt::format("{} › {}", place, command.label);
}

/// Whether the command contains all words of the search.
bool isFound(const UserCommand& command, const std::string& search) {
  const std::string text = lowered(fmt::format("{} {}", command.doc, placeOf(command)));
  std::istringstream words(lowered(search));
  for (std::string word; words >> word;) {
    if (text.find(word) == text.npos) return false;
  }
  return true;
}

}  // namespace

std::string UserCommand::keys() const {
  if (key == 0) return "";
  return fmt::format("{}{}{}", ctrl ? "Ctrl+" : "", shift ? "Shift+" : "", keyName(key));
}

const UserCommand* commandOf(const std::vector<UserCommand>& commands, Key key, bool ctrl,
                             bool shift) {
  const auto found = std::ranges::find_if(commands, [&](const UserCommand& command) {
    return command.key == key && command.ctrl == ctrl && command.shift == shift &&
           command.isEnabled();
  });
  return found == commands.end() ? nullptr : &*found;
}

void drawMenuItems(Ui& ui, const std::vector<UserCommand>& commands, const std::string& menu) {
  std::set<std::string> drawn;
  for (const UserCommand& command : commands) {
    if (command.menu == menu) {
      if (command.begins_section) ImGui::Separator();
      // Several commands may have the same keys, for different situations.
      const bool has_keys = command.key != 0 && commandOf(commands, command.key, command.ctrl,
                                                          command.shift) == &command;
      if (ui.menuItem(command.label.c_str(), has_keys ? command.keys().c_str() : nullptr,
                      command.checked && command.checked(), command.isEnabled())) {
        command.action();
      }
    } else if (command.menu.starts_with(menu + "/")) {
      const std::string rest = command.menu.substr(menu.size() + 1);
      const std::string name = rest.substr(0, rest.find('/'));
      if (!drawn.insert(name).second) continue;
      if (command.begins_section) ImGui::Separator();
      if (!ui.beginMenu(name.c_str())) continue;
      const auto scope = ui.scope(name);
      drawMenuItems(ui, commands, fmt::format("{}/{}", menu, name));
      ImGui::EndMenu();
    }
  }
}

void CommandPalette::draw(Ui& ui, const std::vector<UserCommand>& commands) {
  constexpr const char* kTitle = "Commands";
  if (opening_) {
    opening_ = false;
    search_.clear();
    selected_ = 0;
    ImGui::OpenPopup(kTitle);
  }
  bool keep = true;
  if (!ui.beginDialog(kTitle, {560, 420}, &keep)) return;
  const auto scope = ui.scope(kTitle);
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1);
  const std::string before = search_;
  // The callback keeps the arrow keys from leaving the input.
  ImGui::InputTextWithHint("##search", "type a part of a command", &search_,
                           ImGuiInputTextFlags_CallbackHistory,
                           [](ImGuiInputTextCallbackData*) { return 0; });
  ui.note("search");
  // Escape leaves the input, and closes the palette with it.
  const bool escaped = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
  if (search_ != before) selected_ = 0;
  std::vector<const UserCommand*> found;
  for (const UserCommand& command : commands) {
    if (isFound(command, search_)) found.push_back(&command);
  }
  std::ranges::stable_partition(found, &UserCommand::isEnabled);
  const auto pressed = [](ImGuiKey key) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key)); };
  const bool moved = pressed(ImGuiKey_DownArrow) || pressed(ImGuiKey_UpArrow);
  if (pressed(ImGuiKey_DownArrow)) ++selected_;
  if (pressed(ImGuiKey_UpArrow) && selected_ > 0) --selected_;
  selected_ = std::min(selected_, found.empty() ? 0 : found.size() - 1);

  const UserCommand* chosen = nullptr;
  ImGui::BeginChild("list");
  for (std::size_t i = 0; i < found.size(); ++i) {
    const UserCommand& command = *found[i];
    ImGui::PushID(static_cast<int>(i));
    ImGui::BeginDisabled(!command.isEnabled());
    const std::string keys = command.keys();
    const std::string right = keys.empty() ? placeOf(command) : keys;
    const bool clicked = ui.selectableLine(command.doc.c_str(), i == selected_, right,
                                           ui.theme.faint, placeOf(command).c_str());
    ImGui::EndDisabled();
    if (moved && i == selected_) ImGui::SetScrollHereY();
    if (clicked) chosen = &command;
    ImGui::PopID();
  }
  ImGui::EndChild();
  const bool entered = Ui::entered() && !found.empty() && found[selected_]->isEnabled();
  if (entered) chosen = found[selected_];
  if (chosen != nullptr || escaped || !keep) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
  if (chosen != nullptr) chosen->action();
}

}  // namespace broadmark
