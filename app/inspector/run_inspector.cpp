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

/// Off-screen, this much time passes from picture to picture, the same on every machine.
constexpr double kOffscreenSeconds = 1.0 / 60;
/// Between two looks when nothing moves.
constexpr double kIdleSeconds = 0.25;
/// At least this much time between two pictures.
constexpr double kPictureSeconds = 1.0 / 60;

/// A running script, which may be untrusted: meanwhile only files below the current folder are
/// written.
struct Script {
  explicit Script(const fs::path& path)
      : player(parseScript(readTextFile(path), path.string()), path.string()) {}

  WriteSandbox sandbox{fs::current_path()};
  ScriptPlayer player;
};

std::unique_ptr<Script> scriptOf(const fs::path& path) {
  return path.empty() ? nullptr : std::make_unique<Script>(path);
}

/// One step of a script. It may fail at what does not come as an error has come in its place.
void play(Script& script, Inspector& inspector, InputQueue& input) {
  try {
    script.player.update(inspector, input);
  } catch (const InputError& failure) {
    const auto& errors = inspector.session().notices.errors;
    if (errors.empty()) throw;
    throw InputError(fmt::format("{} (after the error: {})", failure.what(), errors.front()));
  }
}

/// The pictures of a movie, one for each frame that is shown.
class Movie {
 public:
  void take(Inspector& inspector, const std::function<Picture()>& picture) {
    const fs::path& directory = inspector.movieDirectory();
    if (directory.empty()) {
      count_ = 0;
      return;
    }
    std::optional<std::string> frame = inspector.value("shown_frame");
    if (count_ > 0 && frame == last_) return;
    last_ = frame;
    inspector.session().notices.attempt([&] {
      makeDirectory(directory);
      writePng(directory / fmt::format("frame_{:05}.png", count_++), picture());
    });
  }

 private:
  int count_ = 0;
  std::optional<std::string> last_;
};

/// Writes the pictures that the user has asked for.
void takePictures(Inspector& inspector, Movie& movie, const std::function<Picture()>& picture) {
  if (const auto path = inspector.takeScreenshotRequest()) {
    inspector.session().notices.attempt([&] { writePng(*path, picture()); });
  }
  movie.take(inspector, picture);
}

void linkClipboard(Window& window) {
  ImGuiIO& io = ImGui::GetIO();
  io.ClipboardUserData = &window;
  io.SetClipboardTextFn = [](void* user, const char* text) {
    static_cast<Window*>(user)->setClipboard(text);
  };
  io.GetClipboardTextFn = [](void* user) {
    static std::string held;
    held = static_cast<Window*>(user)->clipboard();
    return held.c_str();
  };
}

/// Opens the plan's source, and adds its algorithms.
void begin(Session& session, Plan plan) {
  const std::optional<std::uint32_t> frame = plan.request.frame;
  session.open(std::move(plan));
  if (frame) session.playback.goTo(*frame);
}

/// Opens a window and returns when it is closed. Throws RenderError where no window can be opened.
void inspectInWindow(Plan plan, const fs::path& script_file) {
  const fs::path remembered = preferencesPath();
  Preferences preferences = loadPreferences(remembered);
  Window window("Broadmark", preferences.window_width, preferences.window_height);
  const Gl gl{[](const char* name) { return Window::function(name); }};
  std::unique_ptr<Script> script = scriptOf(script_file);
  {
    Inspector inspector(gl, plan.algorithms, preferences, window.scale(),
                        hostMaker(plan.request.hosts));
    linkClipboard(window);
    begin(inspector.session(), std::move(plan));
    Movie movie;
    auto before = std::chrono::steady_clock::now();
    const auto bind = [&gl] { gl.BindFramebuffer(GL_FRAMEBUFFER, 0); };
    while (!inspector.closing()) {
      const auto now = std::chrono::steady_clock::now();
      const double seconds = std::chrono::duration<double>(now - before).count();
      const bool needsRedraw = inspector.needsRedraw() || script || !window.input().empty();
      window.poll(needsRedraw ? std::max(kPictureSeconds - seconds, 1e-4) : kIdleSeconds);
      for (const fs::path& file : window.takeDrops()) inspector.session().open(file);
      if (window.closing()) {
        window.stayOpen();  // until the user has decided about unsaved changes
        inspector.close();
      }
      if (script) {
        script->player.update(inspector, window.input());
        if (script->player.done()) script.reset();
      }
      if (window.width() < 1 || window.height() < 1) continue;  // minimised
      before = std::chrono::steady_clock::now();
      inspector.draw(window.input(), window.width(), window.height(),
                     std::chrono::duration<double>(before - now).count() + seconds, bind);
      takePictures(inspector, movie,
                   [&] { return readPicture(gl, window.width(), window.height()); });
      window.setCursor(ImGui::GetMouseCursor());
      window.swap();
    }
    preferences = inspector.preferences();
  }
  script.reset();  // the preferences lie elsewhere
  preferences.window_width = static_cast<int>(static_cast<float>(window.width()) / window.scale());
  preferences.window_height =
      static_cast<int>(static_cast<float>(window.height()) / window.scale());
  try {
    savePreferences(remembered, preferences);
  } catch (const InputError& error) {
    std::cerr << fmt::format("broadmark: {}\n", error.what());
  }
}

/// Draws into pictures only, until the script is done and all is computed. Preferences are neither
/// read nor written. Throws InputError when the script fails, RenderError.
void inspectOffscreen(Plan plan, const fs::path& script_file) {
  const RunRequest request = plan.request;
  const auto context = makeOffscreenContext(request.picture.gl);
  const Gl gl(*context);
  std::unique_ptr<Script> script = scriptOf(script_file);
  Inspector inspector(gl, plan.algorithms, {}, 1, hostMaker(request.hosts));
  begin(inspector.session(), std::move(plan));
  InputQueue input;
  Movie movie;
  int width = request.picture.width;
  int height = request.picture.height;
  auto target = std::make_unique<Framebuffer>(gl, width, height, 1);
  // Sizes are final only after the first pictures.
  for (int calm = 0; calm < 4 && !inspector.closing();) {
    if (script) play(*script, inspector, input);
    if (const auto size = script ? script->player.takeResize() : std::nullopt) {
      std::tie(width, height) = *size;
      target = std::make_unique<Framebuffer>(gl, width, height, 1);
    }
    inspector.draw(input, width, height, kOffscreenSeconds, [&] { target->bind(); });
    gl.Finish();  // otherwise unfinished pictures pile up in the driver, gigabytes of them
    const auto picture = [&] { return target->read(); };
    takePictures(inspector, movie, picture);
    if (const auto path = script ? script->player.takeScreenshot() : std::nullopt) {
      writePng(*path, picture());
    }
    const bool busy = (script && !script->player.done()) || inspector.needsRedraw();
    calm = busy ? 0 : calm + 1;
    if (busy && input.empty()) inspector.session().runs.waitUntilIdle(std::chrono::milliseconds(2));
  }
  script.reset();  // the last picture goes where the user wants it
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
