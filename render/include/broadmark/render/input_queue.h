// Mouse and keyboard events in order, from a window or from a script.
//
// Dear ImGui 1.86 reads the state of keys and buttons once per frame, and would lose a press and
// a release between two frames. Therefore events are queued, and each frame applies only as
// many events as Dear ImGui can distinguish.
#pragma once

#include <deque>
#include <string>

struct ImGuiIO;

namespace broadmark {

/// A key code of GLFW.
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

/// The name of a key for keyNamed(); "" if it has none.
std::string keyName(Key key);

class InputQueue {
 public:
  void push(const InputEvent& event) { events_.push_back(event); }
  [[nodiscard]] bool empty() const { return events_.empty(); }

  /// Applies events to the next frame, up to an event that Dear ImGui could not distinguish from
  /// the applied events: a second change of a key or button, a move or turn of the wheel after a
  /// button, a key after a character, or a modifier after another key.
  void applyTo(ImGuiIO& io);

 private:
  std::deque<InputEvent> events_;
};

/// Sets Dear ImGui's map to our key codes.
void setKeyMap(ImGuiIO& io);

}  // namespace broadmark
