// A window on the screen, by GLFW.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "broadmark/render/input_queue.h"
#include "broadmark/render/picture.h"

struct GLFWwindow;
struct GLFWcursor;

namespace broadmark {

/// A window with an OpenGL 3.3 core context, current on the thread that made it. At most one lives
/// at a time.
class Window {
 public:
  /// `width` and `height` in screen units, or less where the screen is smaller. Throws RenderError
  /// where no window can be had (no display, no OpenGL 3.3).
  Window(const std::string& title, int width, int height);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Takes in what has happened; waits for it, at most `seconds`.
  void poll(double seconds);
  void swap();
  [[nodiscard]] bool closing() const;
  /// Takes back the wish to close.
  void stayOpen();
  void setTitle(const std::string& title);
  /// Shows the pointer for an ImGuiMouseCursor.
  void setCursor(int imgui_cursor);

  [[nodiscard]] int width() const;   ///< pixels
  [[nodiscard]] int height() const;  ///< pixels
  /// Pixels per unit at which text is of a readable size: 1, or 2 on a screen of double density.
  [[nodiscard]] float scale() const;

  InputQueue& input() { return input_; }
  /// Files dropped onto the window since the last call.
  std::vector<std::filesystem::path> takeDrops();

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
  std::array<GLFWcursor*, 16> cursors_{};  ///< made when first shown; GLFW ends them
};

}  // namespace broadmark
