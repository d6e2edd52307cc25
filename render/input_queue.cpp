#include "broadmark/render/input_queue.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <bitset>
#include <cctype>
#include <utility>

namespace broadmark {
namespace {

#if IMGUI_VERSION_NUM < 18700
constexpr ImGuiKey_ ImGuiKey_KeypadEnter = ImGuiKey_KeyPadEnter;  // NOLINT: ImGui's later name
#endif

constexpr std::size_t kKeys = GLFW_KEY_LAST + 1;
constexpr std::size_t kButtons = IM_ARRAYSIZE(ImGuiIO::MouseDown);

struct NamedKey {
  const char* name;
  Key key;
};
constexpr NamedKey kNamedKeys[] = {
    {"Escape", GLFW_KEY_ESCAPE},
    {"Enter", GLFW_KEY_ENTER},
    {"Tab", GLFW_KEY_TAB},
    {"Backspace", GLFW_KEY_BACKSPACE},
    {"Delete", GLFW_KEY_DELETE},
    {"Space", GLFW_KEY_SPACE},
    {"Left", GLFW_KEY_LEFT},
    {"Right", GLFW_KEY_RIGHT},
    {"Up", GLFW_KEY_UP},
    {"Down", GLFW_KEY_DOWN},
    {"Home", GLFW_KEY_HOME},
    {"End", GLFW_KEY_END},
    {"PageUp", GLFW_KEY_PAGE_UP},
    {"PageDown", GLFW_KEY_PAGE_DOWN},
    {"Ctrl", GLFW_KEY_LEFT_CONTROL},
    {"Shift", GLFW_KEY_LEFT_SHIFT},
    {"Alt", GLFW_KEY_LEFT_ALT},
    {"Comma", GLFW_KEY_COMMA},
    {"Period", GLFW_KEY_PERIOD},
    {"Slash", GLFW_KEY_SLASH},
    {"Minus", GLFW_KEY_MINUS},
    {"Equal", GLFW_KEY_EQUAL},
    {"[", GLFW_KEY_LEFT_BRACKET},
    {"]", GLFW_KEY_RIGHT_BRACKET},
};

constexpr std::pair<int, Key> kImGuiKeys[] = {
    {ImGuiKey_Tab, GLFW_KEY_TAB},
    {ImGuiKey_LeftArrow, GLFW_KEY_LEFT},
    {ImGuiKey_RightArrow, GLFW_KEY_RIGHT},
    {ImGuiKey_UpArrow, GLFW_KEY_UP},
    {ImGuiKey_DownArrow, GLFW_KEY_DOWN},
    {ImGuiKey_PageUp, GLFW_KEY_PAGE_UP},
    {ImGuiKey_PageDown, GLFW_KEY_PAGE_DOWN},
    {ImGuiKey_Home, GLFW_KEY_HOME},
    {ImGuiKey_End, GLFW_KEY_END},
    {ImGuiKey_Insert, GLFW_KEY_INSERT},
    {ImGuiKey_Delete, GLFW_KEY_DELETE},
    {ImGuiKey_Backspace, GLFW_KEY_BACKSPACE},
    {ImGuiKey_Space, GLFW_KEY_SPACE},
    {ImGuiKey_Enter, GLFW_KEY_ENTER},
    {ImGuiKey_Escape, GLFW_KEY_ESCAPE},
    {ImGuiKey_KeypadEnter, GLFW_KEY_KP_ENTER},
    {ImGuiKey_A, GLFW_KEY_A},
    {ImGuiKey_C, GLFW_KEY_C},
    {ImGuiKey_V, GLFW_KEY_V},
    {ImGuiKey_X, GLFW_KEY_X},
    {ImGuiKey_Y, GLFW_KEY_Y},
    {ImGuiKey_Z, GLFW_KEY_Z},
};

bool isModifier(Key key) { return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER; }

/// The inputs changed by the events already applied to a frame.
struct ChangedInputs {
  std::bitset<kKeys> keys;
  std::bitset<kButtons> buttons;
  bool mouse_moved = false;
  bool wheel = false;
  bool plain_key = false;  ///< other than a modifier
  bool character = false;
};

bool inRange(int code, std::size_t count) {
  return code >= 0 && static_cast<std::size_t>(code) < count;
}

/// Whether Dear ImGui can distinguish `event` from the events applied before.
bool separable(const InputEvent& event, const ChangedInputs& changed) {
  const auto code = static_cast<std::size_t>(event.code);
  switch (event.kind) {
    case InputEvent::Kind::move:
    case InputEvent::Kind::leave:
      return changed.buttons.none() && !changed.wheel;
    case InputEvent::Kind::wheel:
      return changed.buttons.none();
    case InputEvent::Kind::button:
      // Items that may be overlapped, such as tabs, react to a press only if the mouse was over
      // them in the previous frame, and a dragged item must receive the last move before the
      // release.
      return !changed.mouse_moved && !changed.buttons[code] && !changed.plain_key;
    case InputEvent::Kind::character:
      return true;
    case InputEvent::Kind::key:
      if (changed.character || changed.keys[code] || changed.buttons.any()) return false;
      return !(isModifier(event.code) && changed.plain_key);
  }
  return true;
}

void apply(const InputEvent& event, ChangedInputs& changed, ImGuiIO& io) {
  const auto code = static_cast<std::size_t>(event.code);
  switch (event.kind) {
    case InputEvent::Kind::move:
      changed.mouse_moved |= io.MousePos.x != event.x || io.MousePos.y != event.y;
      io.MousePos = {event.x, event.y};
      break;
    case InputEvent::Kind::leave:
      io.MousePos = {-FLT_MAX, -FLT_MAX};
      break;
    case InputEvent::Kind::wheel:
      io.MouseWheelH += event.x;
      io.MouseWheel += event.y;
      changed.wheel = true;
      break;
    case InputEvent::Kind::button:
      io.MouseDown[code] = event.down;
      changed.buttons.set(code);
      break;
    case InputEvent::Kind::character:
      io.AddInputCharacter(static_cast<unsigned>(event.code));
      changed.character = true;
      break;
    case InputEvent::Kind::key:
      io.KeysDown[code] = event.down;
      changed.keys.set(code);
      changed.plain_key |= !isModifier(event.code);
      break;
  }
}

bool isKnown(const InputEvent& event) {
  if (event.kind == InputEvent::Kind::key) return inRange(event.code, kKeys);
  if (event.kind == InputEvent::Kind::button) return inRange(event.code, kButtons);
  return true;
}

}  // namespace

Key keyNamed(const std::string& name) {
  for (const NamedKey& named : kNamedKeys) {
    if (name == named.name) return named.key;
  }
  if (name.size() == 1 && std::isalnum(static_cast<unsigned char>(name[0])) != 0) {
    return std::toupper(static_cast<unsigned char>(name[0]));
  }
  if (name.size() >= 2 && name.size() <= 3 && name[0] == 'F' && std::isdigit(name[1]) != 0) {
    const int number = std::atoi(name.c_str() + 1);
    if (number >= 1 && number <= 12) return GLFW_KEY_F1 + number - 1;
  }
  return 0;
}

std::string keyName(Key key) {
  for (const NamedKey& named : kNamedKeys) {
    if (key == named.key) return named.name;
  }
  if (key >= GLFW_KEY_F1 && key <= GLFW_KEY_F12)
    return std::string("F").append(std::to_string(key - GLFW_KEY_F1 + 1));
  if (key < 128 && std::isalnum(key) != 0) return std::string(1, static_cast<char>(key));
  return "";
}

void InputQueue::applyTo(ImGuiIO& io) {
  ChangedInputs changed;
  while (!events_.empty()) {
    const InputEvent event = events_.front();
    if (isKnown(event)) {
      if (!separable(event, changed)) break;
      apply(event, changed, io);
    }
    events_.pop_front();
  }
  io.KeyCtrl = io.KeysDown[GLFW_KEY_LEFT_CONTROL] || io.KeysDown[GLFW_KEY_RIGHT_CONTROL];
  io.KeyShift = io.KeysDown[GLFW_KEY_LEFT_SHIFT] || io.KeysDown[GLFW_KEY_RIGHT_SHIFT];
  io.KeyAlt = io.KeysDown[GLFW_KEY_LEFT_ALT] || io.KeysDown[GLFW_KEY_RIGHT_ALT];
  io.KeySuper = io.KeysDown[GLFW_KEY_LEFT_SUPER] || io.KeysDown[GLFW_KEY_RIGHT_SUPER];
}

void setKeyMap(ImGuiIO& io) {
  for (const auto& [theirs, ours] : kImGuiKeys) io.KeyMap[theirs] = ours;
}

}  // namespace broadmark
