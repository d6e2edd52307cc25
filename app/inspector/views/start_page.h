// The page that is shown while nothing is open: examples as moving pictures, recent files, what a
// drop does.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/aabb.h"
#include "broadmark/render/colouring.h"
#include "broadmark/render/gl.h"
#include "broadmark/render/orbit_camera.h"
#include "broadmark/render/scene_view.h"
#include "inspector/session/examples.h"
#include "inspector/session/session.h"
#include "inspector/ui/ui.h"

namespace broadmark {

class StartPage {
 public:
  /// Time between two frames of the pictures.
  static constexpr double kFrameSeconds = 0.1;

  explicit StartPage(const Gl& gl) : gl_(&gl) {}

  /// Whether it is shown: while nothing is open, or as long as the user wants.
  [[nodiscard]] bool isShown(const Session& session) const {
    return wanted_ || (!session.playback.source() && !session.results);
  }
  /// Shows it instead of the open source, until another is opened.
  void show(const Session& session) {
    wanted_ = true;
    shown_instead_of_ = session.playback.source();
  }
  void close() { wanted_ = false; }
  /// Call once per picture: closes it if another source has been opened, and frees the pictures if
  /// it is not shown.
  void update(const Session& session);

  /// A file to open, with its text.
  struct Entry {
    std::string text;
    std::string tooltip;
    std::function<void()> open;
  };
  /// Fills the current window. `recovered`: scenes that were not saved.
  void draw(Ui& ui, Session& session, const std::vector<Entry>& recovered,
            const std::vector<Entry>& recent, double seconds);

 private:
  /// The moving picture of an example.
  struct Tile {
    Tile(const Gl& gl, const Example& example);
    void advance(bool dark);
    /// Draws into the view's texture.
    void draw(int width, int height, const Ui& ui);

    std::unique_ptr<Simulation> simulation;
    std::vector<Aabb> boxes;
    Colouring colouring;
    std::uint64_t revision = 0;
    SceneView view;
    ViewSpace space;
    OrbitCamera camera;
  };

  void advance(const Session& session, bool dark, double seconds);
  void handleKeys(Session& session, std::size_t columns);
  void drawExamples(Ui& ui, Session& session, float bottom);
  /// Returns whether it was pressed.
  bool drawTile(Ui& ui, std::size_t index, ImVec2 size, float picture_height);
  static void drawEntries(Ui& ui, const char* heading, const std::vector<Entry>& entries);

  const Gl* gl_;
  bool wanted_ = false;
  std::shared_ptr<const FrameProviderRequest> shown_instead_of_;
  std::vector<std::unique_ptr<Tile>> tiles_;  ///< while the page is shown
  std::size_t selected_ = 0;                  ///< by the keys
  double seconds_due_ = 0;
};

}  // namespace broadmark
