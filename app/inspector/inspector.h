// The inspector: the session, and the window's contents. Draws into the bound framebuffer, of a
// window or off-screen. A "picture" is one drawn image; a "frame" always belongs to the scene.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/render/gl.h"
#include "broadmark/render/input_queue.h"
#include "broadmark/render/picture.h"
#include "broadmark/render/ui_renderer.h"
#include "inspector/authoring/autosave.h"
#include "inspector/commands.h"
#include "inspector/panels/panel.h"
#include "inspector/session/session.h"
#include "inspector/ui/file_dialog.h"
#include "inspector/ui/preferences.h"
#include "inspector/ui/ui.h"
#include "inspector/views/start_page.h"
#include "inspector/views/view.h"

struct ImGuiContext;

namespace broadmark {

class Inspector {
 public:
  /// `scale`: pixels per unit. `autosaves`: folder of unsaved scenes; "": none are kept. The GL
  /// context must be current from construction to destruction; at most one instance may exist.
  Inspector(const Gl& gl, std::vector<Algorithm> algorithms, Preferences preferences, float scale,
            ExecutorFactory make_executor = makeInProcessExecutor,
            SimulationHost host = simulateInProcess, const std::filesystem::path& autosaves = {});
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
  /// Time after which to draw a picture that moves for ever; nothing: there is none.
  [[nodiscard]] std::optional<double> animationSeconds() const;
  /// Returns what to do with this picture of the window, and clears the request; null: nothing.
  std::function<void(const Picture&)> takePictureRequest();
  /// Directory of the numbered pictures of a movie; "": not recording.
  [[nodiscard]] const std::filesystem::path& movieDirectory() const { return movie_directory_; }
  /// Returns a value of the session's state as text, for scripts and tests: "frame", "pairs", …
  /// Nothing for an unknown name.
  [[nodiscard]] std::optional<std::string> value(const std::string& name);
  [[nodiscard]] const std::vector<UserCommand>& commands() const { return commands_; }
  [[nodiscard]] const std::vector<PanelTab>& panels() const { return panels_; }
  [[nodiscard]] bool hasPanel(std::string_view name) const {
    return std::ranges::find(panels_, name, &PanelTab::name) != panels_.end();
  }

 private:
  /// Sizes of the dock areas in pixels; 0: hidden.
  struct Layout {
    float left = 0;
    float right = 0;
    float bottom = 0;
  };
  /// Measures pictures.
  struct PictureRate {
    void add(double seconds, double drawing_seconds);

    bool shown = false;
    std::string text;

   private:
    double seconds_ = 0;
    double drawing_seconds_ = 0;
    int pictures_ = 0;
  };

  void applyStyle();
  void loadFonts();
  void build(const RunProgress& progress, int width, int height, double seconds);
  void drawMiddle(const RunProgress& progress, ImVec2 position, ImVec2 size, double seconds);
  void recover(const Autosave::Left& left);
  void drawMenus();
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

  // Commands: see command_table.cpp.
  void makeCommands();
  std::vector<UserCommand> playbackCommands();
  std::vector<UserCommand> fileCommands();
  std::vector<UserCommand> authorCommands();
  std::vector<UserCommand> viewCommands();
  std::vector<UserCommand> panelCommands();
  void handleShortcuts();
  void escape();
  void askOpen();
  void askLoadAlgorithms();
  void askSaveRecording();
  void askExportTimings(const std::string& table);
  void takeScreenshot();
  void copyLink();
  void askShare();
  /// `plot`: its name, see Ui.
  void askSavePlot(const std::string& plot);
  void savePlot(const std::string& plot, std::filesystem::path path);
  void askMovie();

  // Docked panels: see docks.cpp.
  /// Whether all panels are at the bottom: a phone's window.
  [[nodiscard]] bool isNarrow() const;
  [[nodiscard]] DockArea areaOf(const PanelTab& panel) const;
  [[nodiscard]] bool isHidden(const PanelTab& panel) const;
  void setHidden(const PanelTab& panel, bool hidden);
  void movePanel(const PanelTab& panel, DockArea to);
  /// Fills the window with an area, or the view for none; restores the others if it does already.
  void maximise(std::optional<DockArea> area);
  /// The focused area, else the bottom one.
  [[nodiscard]] DockArea areaInUse() const;
  [[nodiscard]] bool hasVisiblePanel(DockArea area) const;
  void resetLayout();
  /// Makes the raised panels visible.
  void showRaisedPanels();
  [[nodiscard]] bool isRaised(const PanelTab& panel) const;
  [[nodiscard]] Layout layout(float width, float top, float bottom) const;
  void splitter(const char* id, ImVec2 position, ImVec2 size, double& extent, float sign);
  void drawDockArea(DockArea area, const RunProgress& progress, ImVec2 position, ImVec2 size);
  void drawTab(const PanelTab& panel, const std::string& area, const RunProgress& progress);
  void drawTabMenu(const PanelTab& panel);

  // Keyboard navigation: see shortcuts.cpp.
  /// Enables or disables keyboard navigation for the next picture.
  void prepareNavigation();
  void focusNextArea(int step);
  void enterPanel(const PanelTab& panel);
  /// Call inside the window of an area: focuses it if requested.
  void focusIfRequested(std::size_t area);
  /// Focuses the last item, which is the tab of a panel.
  void focusTab(DockArea area);
  /// Starts keyboard navigation in the current window, which is that of an area.
  void navigateFrom(std::size_t area);

  Preferences preferences_;
  ImGuiContext* context_;
  UiRenderer renderer_;
  const Gl* gl_;
  Ui ui_;
  FileDialog files_;
  Session session_;
  Views views_;
  std::vector<PanelTab> panels_;
  std::vector<std::string> in_front_;  ///< panels, in the last session
  std::vector<std::string> raised_;    ///< panels to bring to the front in this picture
  std::vector<UserCommand> commands_;
  bool commands_changed_ = false;          ///< the recent files have
  const RunProgress* progress_ = nullptr;  ///< during a picture, for commands
  /// Whether the panels at the bottom and the playback are shown while nothing is open.
  bool bottom_wanted_ = false;
  CommandPalette palette_;
  StartPage start_page_;
  Autosave autosave_;
  PictureRate rate_;
  std::optional<DockArea> maximised_;  ///< fills the window
  bool view_alone_ = false;            ///< all panels are hidden
  bool help_open_ = false;
  bool keyboard_navigation_ = false;          ///< keys move the focus among widgets
  std::optional<std::size_t> focus_request_;  ///< area to focus in the next picture
  std::string panel_to_focus_;                ///< once its tab is open
  std::array<bool, 4> drawn_areas_{};         ///< dock areas and playback, in the last picture
  std::size_t focused_ = 0;
  bool quit_requested_ = false;  ///< the quit dialog is open
  bool closing_ = false;
  float screen_scale_;          ///< suggested by the screen
  bool style_changed_ = false;  ///< theme or scale has changed since the last picture
  /// Writes a picture, and reports its file.
  using PictureWriter = std::function<void(const std::filesystem::path&, const Picture&)>;
  void requestPicture(std::filesystem::path file, PictureWriter write);

  std::function<void(const Picture&)> picture_request_;
  bool picture_is_due_ = false;  ///< the dialog that asked for its file is gone from the picture
  std::filesystem::path movie_directory_;
};

}  // namespace broadmark
