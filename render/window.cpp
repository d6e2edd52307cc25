#include "broadmark/render/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>
#include <utility>

namespace broadmark {
namespace {

constexpr int kSmallestWidth = 320;
constexpr int kSmallestHeight = 240;

std::string lastError() {
  const char* description = nullptr;
  glfwGetError(&description);
  return description != nullptr ? description : "unknown reason";
}

Window& windowOf(GLFWwindow* window) {
  return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

struct CursorShape {
  ImGuiMouseCursor_ imgui;
  int glfw;
};
static_assert(ImGuiMouseCursor_COUNT <= 16);
constexpr CursorShape kCursors[] = {
    {ImGuiMouseCursor_Arrow, GLFW_ARROW_CURSOR},
    {ImGuiMouseCursor_TextInput, GLFW_IBEAM_CURSOR},
    {ImGuiMouseCursor_ResizeNS, GLFW_VRESIZE_CURSOR},
    {ImGuiMouseCursor_ResizeEW, GLFW_HRESIZE_CURSOR},
    {ImGuiMouseCursor_Hand, GLFW_HAND_CURSOR},
};

}  // namespace

/// Without them Wayland's client library prints a line of its own.
static bool hasDisplay() {
  return std::ranges::any_of(std::array{"DISPLAY", "WAYLAND_DISPLAY"}, [](const char* name) {
    const char* const value = std::getenv(name);
    return value != nullptr && *value != '\0';
  });
}

Window::Window(const std::string& title, int width, int height) {
  if (!hasDisplay()) {
    throw RenderError("cannot open a window: neither DISPLAY nor WAYLAND_DISPLAY is set");
  }
  if (glfwInit() != GLFW_TRUE) {
    throw RenderError(fmt::format("cannot open a window: {}", lastError()));
  }
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
#if defined(__EMSCRIPTEN__)
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);  // a pixel of the canvas is one of the screen
#endif
  if (GLFWmonitor* monitor = glfwGetPrimaryMonitor()) {
    int free_width = width;
    int free_height = height;
    glfwGetMonitorWorkarea(monitor, nullptr, nullptr, &free_width, &free_height);
    width = std::min(width, free_width);
    height = std::min(height, free_height);
  }
  window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (window_ == nullptr) {
    const std::string reason = lastError();
    glfwTerminate();
    throw RenderError(fmt::format("cannot open a window with OpenGL 3.3: {}", reason));
  }
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(1);
  glfwSetWindowSizeLimits(window_, kSmallestWidth, kSmallestHeight, GLFW_DONT_CARE, GLFW_DONT_CARE);
  glfwSetWindowUserPointer(window_, this);
  installCallbacks();
}

Window::~Window() {
  glfwDestroyWindow(window_);
  glfwTerminate();
}

void Window::installCallbacks() {
  glfwSetCursorPosCallback(
      window_, [](GLFWwindow* window, double x, double y) { windowOf(window).pushMove(x, y); });
  glfwSetCursorEnterCallback(window_, [](GLFWwindow* window, int entered) {
    if (entered == 0) windowOf(window).input().push({.kind = InputEvent::Kind::leave});
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* window, int button, int action, int) {
#if defined(__EMSCRIPTEN__)  // a finger has not moved there
    double x = 0;
    double y = 0;
    glfwGetCursorPos(window, &x, &y);
    windowOf(window).pushMove(x, y);
#endif
    windowOf(window).input().push(
        {.kind = InputEvent::Kind::button, .code = button, .down = action == GLFW_PRESS});
  });
  glfwSetScrollCallback(window_, [](GLFWwindow* window, double x, double y) {
    windowOf(window).input().push(
        {.kind = InputEvent::Kind::wheel, .x = static_cast<float>(x), .y = static_cast<float>(y)});
  });
  glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int) {
    if (action == GLFW_REPEAT) return;  // Dear ImGui repeats keys itself
    windowOf(window).input().push(
        {.kind = InputEvent::Kind::key, .code = key, .down = action == GLFW_PRESS});
  });
  glfwSetCharCallback(window_, [](GLFWwindow* window, unsigned character) {
    windowOf(window).input().push(
        {.kind = InputEvent::Kind::character, .code = static_cast<int>(character)});
  });
  glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** paths) {
    std::vector<std::filesystem::path>& drops = windowOf(window).drops_;
    drops.insert(drops.end(), paths, paths + count);
  });
}

void Window::pushMove(double x, double y) {
  // GLFW reports screen units, which may differ from pixels.
  int units = 1;
  glfwGetWindowSize(window_, &units, nullptr);
  const double pixels_per_unit = static_cast<double>(width()) / std::max(units, 1);
  input_.push({.kind = InputEvent::Kind::move,
               .x = static_cast<float>(x * pixels_per_unit),
               .y = static_cast<float>(y * pixels_per_unit)});
}

void Window::poll(double seconds) {
  if (seconds > 0) {
    glfwWaitEventsTimeout(seconds);
  } else {
    glfwPollEvents();
  }
}

void Window::swap() { glfwSwapBuffers(window_); }
bool Window::closing() const { return glfwWindowShouldClose(window_) != 0; }
void Window::cancelClosing() { glfwSetWindowShouldClose(window_, GLFW_FALSE); }
void Window::setTitle(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

void Window::setCursor(int imgui_cursor) {
  for (const CursorShape& shape : kCursors) {
    if (shape.imgui != imgui_cursor) continue;
    GLFWcursor*& cursor = cursors_[static_cast<std::size_t>(imgui_cursor)];
    if (cursor == nullptr) cursor = glfwCreateStandardCursor(shape.glfw);
    glfwSetCursor(window_, cursor);
    return;
  }
  glfwSetCursor(window_, nullptr);
}

int Window::width() const {
  int width = 0;
  glfwGetFramebufferSize(window_, &width, nullptr);
  return width;
}

int Window::height() const {
  int height = 0;
  glfwGetFramebufferSize(window_, nullptr, &height);
  return height;
}

float Window::scale() const {
  float scale = 1;
  glfwGetWindowContentScale(window_, &scale, nullptr);
  return scale > 0 ? scale : 1;
}

std::vector<std::filesystem::path> Window::consumeDrops() { return std::exchange(drops_, {}); }

std::string Window::clipboard() const {
  const char* text = glfwGetClipboardString(window_);
  return text != nullptr ? text : "";
}

void Window::setClipboard(const std::string& text) {
  glfwSetClipboardString(window_, text.c_str());
}

void* Window::function(const char* name) {
#if defined(__EMSCRIPTEN__)  // WebGL has it for floats alone
  constexpr auto kDepthRange = [](double near, double far) {
    reinterpret_cast<void (*)(float, float)>(glfwGetProcAddress("glDepthRangef"))(
        static_cast<float>(near), static_cast<float>(far));
  };
  if (std::string_view(name) == "glDepthRange") {
    return reinterpret_cast<void*>(+kDepthRange);
  }
#endif
  return reinterpret_cast<void*>(glfwGetProcAddress(name));
}

}  // namespace broadmark
