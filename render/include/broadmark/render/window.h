// A GLFW window.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "broadmark/render/input_queue.h"
#include "broadmark/render/picture.h"

struct GLFWwindow;
struct GLFWcursor;

namespace broadmark {

/// A window with an OpenGL 3.3 core context, current on the thread that created it. At most one
/// exists at a time.
class Window {
 public:
  /// `width` and `height` are in screen units, limited to the screen's size. Throws RenderError
  /// without a display or without OpenGL 3.3.
  Window(const std::string& title, int width, int height);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Polls events; waits for an event for up to `seconds`.
  void poll(double seconds);
  void swap();
  [[nodiscard]] bool closing() const;
  void cancelClosing();
  void setTitle(const std::string& title);
  /// Sets the cursor shape for an ImGuiMouseCursor.
  void setCursor(int imgui_cursor);

  [[nodiscard]] int width() const;   ///< pixels
  [[nodiscard]] int height() const;  ///< pixels
  /// The scale for text of readable size: 1, or 2 on a screen of double density.
  [[nodiscard]] float scale() const;

  InputQueue& input() { return input_; }
  /// Returns the files dropped onto the window since the last call.
  std::vector<std::filesystem::path> consumeDrops();

  [[nodiscard]] std::string clipboard() const;
  void setClipboard(const std::string& text);

  /// Address of a GL function, or null.
  static void* function(const char* name);

 private:
  void installCallbacks();
  void pushMove(double x, double y);

  GLFWwindow* window_ = nullptr;
  InputQueue input_;
  std::vector<std::filesystem::path> drops_;
  std::array<GLFWcursor*, 16> cursors_{};  ///< created when first shown; GLFW frees them
};

}  // namespace broadmark
