#include "inspector/run_inspector.h"

#include <fmt/format.h>
#include <imgui.h>

#include <chrono>
#include <iostream>
#include <memory>
#include <optional>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/render/framebuffer.h"
#include "broadmark/render/window.h"
#include "inspector/inspector.h"
#include "inspector/script.h"
#include "request/hosts.h"
#include "run/plan.h"
#include "run/recordings.h"

#if defined(__EMSCRIPTEN__)
#include <emscripten.h>
#endif

namespace broadmark {
namespace {

namespace fs = std::filesystem;

/// Time per off-screen picture, fixed for reproducible results.
constexpr double kOffscreenSeconds = 1.0 / 60;
/// Longest wait for input while nothing moves.
constexpr double kIdleSeconds = 0.25;
/// Minimum time between two pictures.
constexpr double kPictureSeconds = 1.0 / 60;
constexpr std::chrono::milliseconds kWorkPerPicture{10};  ///< of the algorithms, without a thread

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

/// Throws InputError unless the plan's source has what is to be shown.
void requireShown(const Plan& plan, const InspectorOptions& options) {
  if (plan.entries.empty()) {
    if (options.camera) throw InputError("--camera: no recording to open");
    if (!options.selection.empty()) throw InputError("--select: no recording to open");
    return;
  }
  const SceneInfo& scene = plan.entries.front().source.reference.scene;
  for (const std::uint32_t body : options.selection) {
    if (body < scene.objects) continue;
    throw InputError(fmt::format("--select: there is no body {}: the last body of {} is {}", body,
                                 scene.name, std::int64_t{scene.objects} - 1));
  }
}

/// Opens the plan's source, and adds its algorithms.
void openPlan(Session& session, Plan plan, const InspectorOptions& options) {
  requireShown(plan, options);
  const std::optional<std::uint32_t> frame = plan.request.frame;
  session.open(std::move(plan));
  if (frame) session.playback.goTo(*frame);
  session.first_camera = options.camera;
  session.first_selection = options.selection;
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

/// The inspector in a window. Throws RenderError if none can be opened.
class InspectorWindow {
 public:
  InspectorWindow(Plan plan, const InspectorOptions& options)
      : preferences_(loadPreferences(preferencesPath())),
        stored_(preferencesPath(), preferences_),
        window_("Broadmark", preferences_.window_width, preferences_.window_height),
        script_(scriptOf(options.script)) {
    inspector_.emplace(gl_, plan.algorithms, preferences_, window_.scale(),
                       executorFactory(plan.request.hosts), hostOf(plan.request), autosaveFolder());
    linkClipboard(window_);
    openPlan(inspector_->session(), std::move(plan), options);
  }
  InspectorWindow(const InspectorWindow&) = delete;
  InspectorWindow& operator=(const InspectorWindow&) = delete;

  ~InspectorWindow() {
    preferences_ = inspector_->preferences();
    inspector_.reset();
    script_.reset();  // ends the sandbox: the preferences are outside of it
    setWindowSize(preferences_, window_);
    report([&] { stored_.save(preferences_); });
  }

  [[nodiscard]] bool closing() const { return inspector_->closing(); }
  [[nodiscard]] Inspector& inspector() { return *inspector_; }

  /// Waits for input for a while, and draws a picture.
  void step() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_draw_).count();
    const bool needs_redraw = inspector_->needsRedraw() || script_ || !window_.input().empty();
    const double idle_seconds =
        std::max(inspector_->animationSeconds().value_or(kIdleSeconds), kPictureSeconds);
    window_.poll(std::max((needs_redraw ? kPictureSeconds : idle_seconds) - seconds, 1e-4));
    for (const fs::path& file : window_.consumeDrops()) inspector_->session().open(file);
    if (window_.closing()) {
      window_.cancelClosing();  // until the user has decided about unsaved changes
      inspector_->close();
    }
    if (script_) {
      script_->player.update(*inspector_, window_.input());
      if (script_->player.done()) script_.reset();
    }
    inspector_->session().runs.proceed(kWorkPerPicture);
    if (window_.width() < 1 || window_.height() < 1) return;  // minimised
    last_draw_ = std::chrono::steady_clock::now();
    const double elapsed = std::chrono::duration<double>(last_draw_ - now).count() + seconds;
    inspector_->draw(window_.input(), window_.width(), window_.height(), elapsed,
                     [this] { gl_.BindFramebuffer(GL_FRAMEBUFFER, 0); });
    writePictures(*inspector_, movie_,
                  [&] { return readPicture(gl_, window_.width(), window_.height()); });
    preferences_ = inspector_->preferences();
    setWindowSize(preferences_, window_);
    if (!script_) report([&] { stored_.update(preferences_, elapsed); });
    window_.setCursor(ImGui::GetMouseCursor());
    window_.swap();
  }

 private:
  Preferences preferences_;
  PreferencesFile stored_;
  Window window_;
  Gl gl_{[](const char* name) { return Window::function(name); }};
  std::unique_ptr<Script> script_;
  std::optional<Inspector> inspector_;
  Movie movie_;
  std::chrono::steady_clock::time_point last_draw_ = std::chrono::steady_clock::now();
};

#if defined(__EMSCRIPTEN__)
InspectorWindow* the_window = nullptr;  ///< until the page is left
#endif

/// Opens a window and returns when it is closed; in a browser at once, which then calls for each
/// picture.
void inspectInWindow(Plan plan, const InspectorOptions& options) {
  auto opened = std::make_unique<InspectorWindow>(std::move(plan), options);
#if defined(__EMSCRIPTEN__)
  the_window = opened.release();
  emscripten_set_main_loop([] { the_window->step(); }, /*fps=*/0, /*simulate_infinite_loop=*/false);
#else
  while (!opened->closing()) opened->step();
#endif
}

/// Draws off-screen until the script is done and the session is idle. Preferences are neither read
/// nor written. Throws RenderError, and InputError if the script fails.
void inspectOffscreen(Plan plan, const InspectorOptions& options) {
  const RunRequest request = plan.request;
  const auto context = makeOffscreenContext(request.picture.gl);
  const Gl gl(*context);
  std::unique_ptr<Script> script = scriptOf(options.script);
  Inspector inspector(gl, plan.algorithms, {}, 1, executorFactory(request.hosts), hostOf(request));
  openPlan(inspector.session(), std::move(plan), options);
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

#if defined(__EMSCRIPTEN__)
// For the page, and for its tests.
extern "C" {

/// Inspector::value(); "": unknown. Valid until the next call, as all texts here.
EMSCRIPTEN_KEEPALIVE const char* broadmarkValue(const char* name) {
  static std::string text;
  text = the_window == nullptr ? "" : the_window->inspector().value(name).value_or("");
  return text.c_str();
}

/// The middle of a widget, "x y" in pixels; "": it is not in view.
EMSCRIPTEN_KEEPALIVE const char* broadmarkPlace(const char* name) {
  static std::string text;
  const WidgetPlace* const place =
      the_window == nullptr ? nullptr : the_window->inspector().ui().find(name);
  text = place == nullptr ? ""
                          : fmt::format("{} {}", (place->min.x + place->max.x) / 2,
                                        (place->min.y + place->max.y) / 2);
  return text.c_str();
}
}
#endif

int runInspector(Plan plan, bool in_window, const InspectorOptions& options) {
  try {
    if (in_window) {
      inspectInWindow(std::move(plan), options);
    } else {
      inspectOffscreen(std::move(plan), options);
    }
  } catch (const RenderError& error) {
    throw InputError(in_window ? fmt::format("{} (--headless runs without a window)", error.what())
                               : error.what());
  }
  return 0;
}

}  // namespace broadmark
