// Events of mouse and keyboard in their order, from a window or from a script.
//
// Dear ImGui 1.86 reads the state of keys and buttons once per picture: a press and a release
// between two pictures would be lost. So events wait here, and each picture takes only as many as
// it can tell apart.
#pragma once

#include <deque>
#include <string>

struct ImGuiIO;

namespace broadmark {

/// Keys are numbered as GLFW numbers them.
using Key = int;

struct InputEvent {
  enum class Kind { move, button, wheel, key, character, leave };
  Kind kind = Kind::move;
  float x = 0;   ///< move: position in pixels from the upper left corner; wheel: to the right
  float y = 0;   ///< move: position; wheel: upwards
  int code = 0;  ///< the button (0 left, 1 right, 2 middle), the key, or the character
  bool down = false;
};

/// The key named "Escape", "F12", "Left", "A", …; 0 if there is none.
Key keyNamed(const std::string& name);

/// The name of a key, which keyNamed() knows; "" if it has none.
std::string keyName(Key key);

class InputQueue {
 public:
  void push(const InputEvent& event) { events_.push_back(event); }
  [[nodiscard]] bool empty() const { return events_.empty(); }

  /// Hands events over to the next picture. Stops before an event that the picture could not tell
  /// from those already handed over: a key or button changes a second time, the mouse moves or its
  /// wheel turns after a button, a key follows a character, a modifier follows another key.
  void applyTo(ImGuiIO& io);

 private:
  std::deque<InputEvent> events_;
};

/// Tells Dear ImGui our numbers of its keys.
void setKeyMap(ImGuiIO& io);

}  // namespace broadmark
