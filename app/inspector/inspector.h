// The inspector: the session, and the window's contents. Draws into the bound framebuffer, of a
// window or off-screen. A "picture" is one drawn image; a "frame" always belongs to the scene.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/render/gl.h"
#include "broadmark/render/input_queue.h"
#include "broadmark/render/ui_renderer.h"
#include "inspector/panels/panel.h"
#include "inspector/session/session.h"
#include "inspector/ui/file_dialog.h"
#include "inspector/ui/preferences.h"
#include "inspector/ui/ui.h"
#include "inspector/views/view.h"

struct ImGuiContext;

namespace broadmark {

/// A keyboard shortcut.
struct Shortcut {
  Key key = 0;
  bool ctrl = false;
  bool shift = false;
  std::string doc = {};
  std::function<void()> action;

  /// The key combination as text: "Ctrl+O".
  [[nodiscard]] std::string keys() const;
};

/// Descriptions of the shortcuts that also appear in menus.
inline constexpr const char* kOpenFile = "open a file";
inline constexpr const char* kSave =
    "save the authored scene, or the available frames as a recording";
inline constexpr const char* kQuit = "quit";
inline constexpr const char* kSaveScreenshot = "save a screenshot";
inline constexpr const char* kShowHelp = "show this page";

class Inspector {
 public:
  /// `scale`: pixels per unit. The GL context must be current from construction to destruction; at
  /// most one instance may exist.
  Inspector(const Gl& gl, std::vector<Algorithm> algorithms, Preferences preferences, float scale,
            ExecutorFactory make_executor = makeInProcessExecutor,
            SimulationHost host = simulateInProcess);
  ~Inspector();
  Inspector(const Inspector&) = delete;
  Inspector& operator=(const Inspector&) = delete;

  /// Processes the input and draws a picture of `width` x `height` pixels. `bind` binds the target
  /// framebuffer. `seconds`: time since the last picture.
  void draw(InputQueue& input, int width, int height, double seconds,
            const std::function<void()>& bind);

  [[nodiscard]] Session& session() { return session_; }
  [[nodiscard]] Ui& ui() { return ui_; }
  [[nodiscard]] const Preferences& preferences() const { return preferences_; }
  [[nodiscard]] bool closing() const { return closing_; }
  /// Closes, after the user has decided about background work and unsaved changes.
  void close() {
    quit_requested_ = true;
    if (!session_.jobs.running()) closeDocument();
  }
  /// Whether the picture changes without input.
  [[nodiscard]] bool needsRedraw();
  /// Returns the file for a requested screenshot, and clears the request.
  std::optional<std::filesystem::path> takeScreenshotRequest();
  /// Directory of the numbered pictures of a movie; "": not recording.
  [[nodiscard]] const std::filesystem::path& movieDirectory() const { return movie_directory_; }
  /// Returns a value of the session's state as text, for scripts and tests: "frame", "pairs", …
  /// Nothing for an unknown name.
  [[nodiscard]] std::optional<std::string> value(const std::string& name);
  [[nodiscard]] const std::vector<PanelTab>& panels() const { return panels_; }
  [[nodiscard]] bool hasPanel(std::string_view name) const {
    return std::ranges::find(panels_, name, &PanelTab::name) != panels_.end();
  }

 private:
  void applyStyle();
  void loadFonts();
  void build(const RunProgress& progress, int width, int height);
  void drawMenus(const RunProgress& progress);
  void drawScaleMenu();
  void resetLayout();
  void drawDockArea(DockArea area, const RunProgress& progress, ImVec2 position, ImVec2 size);
  [[nodiscard]] float transportHeight(float width) const;
  void drawTransport(const RunProgress& progress);
  void drawButtons();
  void drawSpeed();
  void drawPosition(const RunProgress& progress);
  void drawStatus(const RunProgress& progress);
  void drawHelp();
  void drawErrors();
  /// While `quit_requested_`: asks whether to cancel the background work.
  void drawQuitDialog();
  /// Closes, after the user has decided about unsaved changes.
  void closeDocument();
  void splitter(const char* id, ImVec2 position, ImVec2 size, double& extent, float sign);
  void makeShortcuts();
  void handleShortcuts();
  /// Returns the keys of the shortcut with this description, for menus.
  [[nodiscard]] std::string keysFor(std::string_view doc) const;
  /// Enables or disables keyboard navigation for the next picture.
  void prepareNavigation();
  void focusNextArea(int step);
  void enterPanel(const PanelTab& panel);
  /// Call inside the window of an area: focuses it if requested.
  void focusIfRequested(std::size_t area);
  void escape();
  void toggleTool(Tool tool);
  void editAuthored(const std::function<void(scenes::SceneEditor&)>& change);
  void askOpen();
  void askLoadAlgorithms();
  void askSaveRecording();
  void askExportTimings(const std::string& table);
  void askMovie();

  Preferences preferences_;
  ImGuiContext* context_;
  UiRenderer renderer_;
  const Gl* gl_;
  Ui ui_;
  FileDialog files_;
  Session session_;
  Views views_;
  std::vector<PanelTab> panels_;
  std::vector<Shortcut> shortcuts_;
  bool help_open_ = false;
  bool keyboard_navigation_ = false;          ///< keys move the focus among widgets
  std::optional<std::size_t> focus_request_;  ///< area to focus in the next picture
  std::size_t focused_ = 0;
  bool quit_requested_ = false;  ///< the quit dialog is open
  bool closing_ = false;
  float screen_scale_;          ///< suggested by the screen
  bool style_changed_ = false;  ///< theme or scale has changed since the last picture
  bool screenshot_requested_ = false;
  int screenshots_ = 0;
  std::filesystem::path movie_directory_;
};

}  // namespace broadmark
