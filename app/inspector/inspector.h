// The inspector: the session, and the window's contents around it. Draws into whatever is bound: a
// window, or an off-screen picture.
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

/// A key, or several, that does something.
struct Shortcut {
  Key key = 0;
  bool ctrl = false;
  bool shift = false;
  std::string doc = {};
  std::function<void()> act;

  /// As people read it: "Ctrl+O".
  [[nodiscard]] std::string keys() const;
};

/// What some shortcuts do, for the menus that say so, too.
inline constexpr const char* kOpenFile = "open a file";
inline constexpr const char* kSave =
    "save the authored scene, or the frames known so far as a recording";
inline constexpr const char* kQuit = "quit";
inline constexpr const char* kTakePicture = "save a picture of the window";
inline constexpr const char* kShowKeys = "this page";

class Inspector {
 public:
  /// `scale`: pixels per unit. Needs its context current from construction to destruction; at most
  /// one lives at a time.
  Inspector(const Gl& gl, std::vector<Algorithm> algorithms, Preferences preferences, float scale,
            ExecutorFactory make_host = makeLocalHost);
  ~Inspector();
  Inspector(const Inspector&) = delete;
  Inspector& operator=(const Inspector&) = delete;

  /// Takes in what has happened and draws one picture of `width` x `height` pixels. `bind` makes
  /// the target current. `seconds` since the last picture.
  void draw(InputQueue& input, int width, int height, double seconds,
            const std::function<void()>& bind);

  [[nodiscard]] Session& session() { return session_; }
  [[nodiscard]] Ui& ui() { return ui_; }
  [[nodiscard]] const Preferences& preferences() const { return preferences_; }
  [[nodiscard]] bool closing() const { return closing_; }
  /// Closes, once it is decided what becomes of unsaved changes and of work in the background.
  void close() {
    quit_asked_ = true;
    if (!session_.jobs.running()) leave();
  }
  /// Whether pictures change without input.
  [[nodiscard]] bool needsRedraw();
  /// Where to write the screenshot that the user has asked for; once.
  std::optional<std::filesystem::path> takeScreenshotRequest();
  /// Where the numbered pictures of a movie go; "": none is being made.
  [[nodiscard]] const std::filesystem::path& movieDirectory() const { return movie_directory_; }
  /// The session's state by name, as text, for scripts and tests: "frame", "pairs", … Nothing for
  /// an unknown name.
  [[nodiscard]] std::optional<std::string> value(const std::string& name);
  [[nodiscard]] const std::vector<PanelTab>& panels() const { return panels_; }
  [[nodiscard]] bool hasPanel(std::string_view name) const {
    return std::ranges::find(panels_, name, &PanelTab::name) != panels_.end();
  }

 private:
  void restyle();
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
  /// While `quit_asked_`: whether to end the work in the background, or to stay.
  void drawQuitDialog();
  /// Closes, once it is decided what becomes of unsaved changes.
  void leave();
  void splitter(const char* id, ImVec2 position, ImVec2 size, double& extent, float sign);
  void makeShortcuts();
  void handleShortcuts();
  /// The keys that do what is explained so, for menus.
  [[nodiscard]] std::string keysFor(std::string_view doc) const;
  /// Before a picture: lets keys move among widgets, or not.
  void prepareNavigation();
  void focusPlace(int step);
  void enterPanel(const PanelTab& panel);
  /// To be called inside the window of a place: gives it the keys if they are to go there.
  void takeFocus(std::size_t place);
  void escape();
  void takeTool(Tool tool);
  void editAuthored(const std::function<void(scenes::SceneEditor&)>& change);
  void askOpen();
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
  bool help_ = false;
  bool navigates_ = false;               ///< keys move among the widgets
  std::optional<std::size_t> to_focus_;  ///< which of the places, in the next picture
  std::size_t focused_ = 0;
  bool quit_asked_ = false;  ///< the quit dialog is open
  bool closing_ = false;
  float screen_scale_;    ///< that the screen suggests
  bool restyle_ = false;  ///< theme or scale are others than in the last picture
  bool screenshot_asked_ = false;
  int screenshots_ = 0;
  std::filesystem::path movie_directory_;
};

}  // namespace broadmark
