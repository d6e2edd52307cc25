#include "inspector/run_inspector.h"

#include <fmt/format.h>
#include <imgui.h>

#include <chrono>
#include <iostream>
#include <memory>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/render/framebuffer.h"
#include "broadmark/render/window.h"
#include "inspector/inspector.h"
#include "inspector/script.h"
#include "request/hosts.h"
#include "run/plan.h"
#include "run/recordings.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

/// Time per off-screen picture, fixed for reproducible results.
constexpr double kOffscreenSeconds = 1.0 / 60;
/// Longest wait for input while nothing moves.
constexpr double kIdleSeconds = 0.25;
/// Minimum time between two pictures.
constexpr double kPictureSeconds = 1.0 / 60;

/// A running script, which may be untrusted: only files below the current folder may be written.
struct Script {
  explicit Script(const fs::path& path)
      : player(parseScript(readTextFile(path), path.string()), path.string()) {}

  WriteSandbox sandbox{fs::current_path()};
  ScriptPlayer player;
};

std::unique_ptr<Script> scriptOf(const fs::path& path) {
  return path.empty() ? nullptr : std::make_unique<Script>(path);
}

/// Plays a step of a script. A failure also names the session's error, its likely cause.
void play(Script& script, Inspector& inspector, InputQueue& input) {
  try {
    script.player.update(inspector, input);
  } catch (const InputError& failure) {
    const auto& errors = inspector.session().notices.errors;
    if (errors.empty()) throw;
    throw InputError(fmt::format("{} (after the error: {})", failure.what(), errors.front()));
  }
}

/// Writes the pictures of a movie, one per shown frame.
class Movie {
 public:
  void capture(Inspector& inspector, const std::function<Picture()>& picture) {
    const fs::path& directory = inspector.movieDirectory();
    if (directory.empty()) {
      count_ = 0;
      return;
    }
    std::optional<std::string> frame = inspector.value("shown_frame");
    if (count_ > 0 && frame == last_) return;
    last_ = frame;
    inspector.session().notices.catchErrors([&] {
      makeDirectory(directory);
      writePng(directory / fmt::format("frame_{:05}.png", count_++), picture());
    });
  }

 private:
  int count_ = 0;
  std::optional<std::string> last_;
};

/// Writes a requested picture, and that of a movie.
void writePictures(Inspector& inspector, Movie& movie, const std::function<Picture()>& picture) {
  if (const auto write = inspector.takePictureRequest()) write(picture());
  movie.capture(inspector, picture);
}

void linkClipboard(Window& window) {
  ImGuiIO& io = ImGui::GetIO();
  io.ClipboardUserData = &window;
  io.SetClipboardTextFn = [](void* user, const char* text) {
    static_cast<Window*>(user)->setClipboard(text);
  };
  io.GetClipboardTextFn = [](void* user) {
    static std::string text;
    text = static_cast<Window*>(user)->clipboard();
    return text.c_str();
  };
}

SimulationHost hostOf(const RunRequest& request) {
  return request.hosts.in_process ? simulateInProcess : simulateInProcesses();
}

/// Opens the plan's source, and adds its algorithms.
void openPlan(Session& session, Plan plan) {
  const std::optional<std::uint32_t> frame = plan.request.frame;
  session.open(std::move(plan));
  if (frame) session.playback.goTo(*frame);
}

/// Calls `save`, and prints its error.
template <class Save>
void report(const Save& save) {
  try {
    save();
  } catch (const InputError& error) {
    std::cerr << fmt::format("broadmark: {}\n", error.what());
  }
}

void setWindowSize(Preferences& preferences, const Window& window) {
  preferences.window_width = static_cast<int>(static_cast<float>(window.width()) / window.scale());
  preferences.window_height =
      static_cast<int>(static_cast<float>(window.height()) / window.scale());
}

/// Opens a window and returns when it is closed. Throws RenderError if no window can be opened.
void inspectInWindow(Plan plan, const fs::path& script_file) {
  Preferences preferences = loadPreferences(preferencesPath());
  PreferencesFile stored(preferencesPath(), preferences);
  Window window("Broadmark", preferences.window_width, preferences.window_height);
  const Gl gl{[](const char* name) { return Window::function(name); }};
  std::unique_ptr<Script> script = scriptOf(script_file);
  {
    Inspector inspector(gl, plan.algorithms, preferences, window.scale(),
                        executorFactory(plan.request.hosts), hostOf(plan.request),
                        autosaveFolder());
    linkClipboard(window);
    openPlan(inspector.session(), std::move(plan));
    Movie movie;
    auto last_draw = std::chrono::steady_clock::now();
    const auto bind = [&gl] { gl.BindFramebuffer(GL_FRAMEBUFFER, 0); };
    while (!inspector.closing()) {
      const auto now = std::chrono::steady_clock::now();
      const double seconds = std::chrono::duration<double>(now - last_draw).count();
      const bool needs_redraw = inspector.needsRedraw() || script || !window.input().empty();
      const double idle_seconds =
          std::max(inspector.animationSeconds().value_or(kIdleSeconds), kPictureSeconds);
      window.poll(std::max((needs_redraw ? kPictureSeconds : idle_seconds) - seconds, 1e-4));
      for (const fs::path& file : window.consumeDrops()) inspector.session().open(file);
      if (window.closing()) {
        window.cancelClosing();  // until the user has decided about unsaved changes
        inspector.close();
      }
      if (script) {
        script->player.update(inspector, window.input());
        if (script->player.done()) script.reset();
      }
      if (window.width() < 1 || window.height() < 1) continue;  // minimised
      last_draw = std::chrono::steady_clock::now();
      const double elapsed = std::chrono::duration<double>(last_draw - now).count() + seconds;
      inspector.draw(window.input(), window.width(), window.height(), elapsed, bind);
      writePictures(inspector, movie,
                    [&] { return readPicture(gl, window.width(), window.height()); });
      preferences = inspector.preferences();
      setWindowSize(preferences, window);
      if (!script) report([&] { stored.update(preferences, elapsed); });
      window.setCursor(ImGui::GetMouseCursor());
      window.swap();
    }
    preferences = inspector.preferences();
  }
  script.reset();  // ends the sandbox: the preferences are outside of it
  setWindowSize(preferences, window);
  report([&] { stored.save(preferences); });
}

/// Draws off-screen until the script is done and the session is idle. Preferences are neither read
/// nor written. Throws RenderError, and InputError if the script fails.
void inspectOffscreen(Plan plan, const fs::path& script_file) {
  const RunRequest request = plan.request;
  const auto context = makeOffscreenContext(request.picture.gl);
  const Gl gl(*context);
  std::unique_ptr<Script> script = scriptOf(script_file);
  Inspector inspector(gl, plan.algorithms, {}, 1, executorFactory(request.hosts), hostOf(request));
  openPlan(inspector.session(), std::move(plan));
  InputQueue input;
  Movie movie;
  int width = request.picture.width;
  int height = request.picture.height;
  auto target = std::make_unique<Framebuffer>(gl, width, height, 1);
  // Layout sizes are final only after the first pictures.
  for (int idle_pictures = 0; idle_pictures < 4 && !inspector.closing();) {
    if (script) play(*script, inspector, input);
    if (script && script->player.done()) inspector.session().playback.pause();
    if (const auto size = script ? script->player.takeResize() : std::nullopt) {
      std::tie(width, height) = *size;
      target = std::make_unique<Framebuffer>(gl, width, height, 1);
    }
    inspector.draw(input, width, height, kOffscreenSeconds, [&] { target->bind(); });
    gl.Finish();  // otherwise the driver queues gigabytes of unfinished pictures
    const auto picture = [&] { return target->read(); };
    writePictures(inspector, movie, picture);
    if (const auto path = script ? script->player.takeScreenshot() : std::nullopt) {
      writePng(*path, picture());
    }
    const bool busy = (script && !script->player.done()) || inspector.needsRedraw();
    idle_pictures = busy ? 0 : idle_pictures + 1;
    if (busy && input.empty()) inspector.session().runs.waitUntilIdle(std::chrono::milliseconds(2));
  }
  script.reset();  // ends the sandbox: the screenshot may be outside of it
  if (!request.screenshot.empty()) writePng(request.screenshot, target->read());
  if (!inspector.session().notices.errors.empty()) {
    throw InputError(inspector.session().notices.errors.front());
  }
}

}  // namespace

int runInspector(Plan plan, bool in_window, const fs::path& script) {
  try {
    if (in_window) {
      inspectInWindow(std::move(plan), script);
    } else {
      inspectOffscreen(std::move(plan), script);
    }
  } catch (const RenderError& error) {
    throw InputError(in_window ? fmt::format("{} (--headless runs without a window)", error.what())
                               : error.what());
  }
  return 0;
}

}  // namespace broadmark
