// The authored scene being edited: shown at rest or in motion, saved, baked, and left.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/names.h"
#include "broadmark/scenes/brush.h"
#include "broadmark/scenes/scene_editor.h"
#include "inspector/jobs/background_bake.h"
#include "inspector/session/notices.h"
#include "inspector/session/playback.h"

namespace broadmark {

/// The first three are the gizmo's; `none`: the mouse only selects, and moves the camera.
enum class Tool { none, move, turn, scale, brush };
inline constexpr NameTable kTools{{NamedValue{Tool::none, "none"},
                                   {Tool::move, "move"},
                                   {Tool::turn, "turn"},
                                   {Tool::scale, "scale"},
                                   {Tool::brush, "brush"}}};

/// What the mouse does in the view with the document's bodies, besides selecting them.
struct Tools {
  Tool tool = Tool::move;
  bool local = false;    ///< the gizmo's axes are those of the first selected body, not the world's
  bool snaps = false;    ///< drags go by steps; while Ctrl is down, the other way round
  double move_step = 1;  ///< in world units
  double turn_step = 15;  ///< in degrees
  double scale_step = 0.1;

  /// Takes a tool, or puts it down if it is the one in hand.
  void toggle(Tool which) { tool = tool == which ? Tool::none : which; }
};

/// The scene with its history, its file, the brush, and the tools. At first it is empty.
class Document {
 public:
  /// The parts it acts on outlive it.
  Document(Playback& playback, Notices& notices, BackgroundBake& bake)
      : playback_(playback), notices_(notices), bake_(bake) {
    chooseBrush(0);
  }

  /// Its file; "": none yet.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Its name for people: that of the file, or of the scene.
  [[nodiscard]] std::string title() const {
    return path_.empty() ? editor.scene().name : path_.filename().string();
  }
  /// Whether it has unsaved changes.
  [[nodiscard]] bool isModified() const { return unsaved_ || editor.isModified(); }
  /// The simulation of a copy. Throws InputError. O(bodies).
  [[nodiscard]] std::unique_ptr<Simulation> simulation() const;

  /// Takes another brush, by its index in `brushes`.
  void chooseBrush(std::size_t which) {
    brush_ = brushes.at(which).create();
    chosen_brush_ = which;
  }
  [[nodiscard]] std::size_t chosenBrush() const { return chosen_brush_; }
  [[nodiscard]] scenes::Brush& brush() const { return *brush_; }
  /// What the brush paints at `paint_at`. Throws InputError.
  [[nodiscard]] scenes::Stroke stroke() const {
    return scenes::paint(*brush_, paint, paint_at, editor.scene().bodies);
  }

  /// Whether it is what is played.
  [[nodiscard]] bool shown() const { return source_ && source_ == playback_.source(); }
  /// Whether the document is shown with its bodies at their initial poses.
  [[nodiscard]] bool atRest() const { return shown() && !moves_; }

  /// Takes another scene, with no history, and shows it. `unsaved`: no file holds it as it is. Does
  /// not ask.
  void start(scenes::AuthoredScene scene, std::filesystem::path path = {}, bool unsaved = false);
  /// Makes a scene of the frame that is played, once its bodies are known.
  void startFromFrame();
  /// To be called with each progress on what is played.
  void advance(const RunProgress& progress);

  /// Changes the scene and shows it at rest. What goes wrong becomes an error.
  void edit(const std::function<void(scenes::SceneEditor&)>& change);
  /// Adds what has been painted, selects it, and says how much that was. What goes wrong becomes an
  /// error.
  void add(const std::function<scenes::Stroke()>& painted);
  /// Shows the scene at rest, or moves it on from its first frame.
  void show();
  void simulate();
  /// Writes the scene to what becomes its file; `path` gets its extension if it has none. Returns
  /// whether that went well; if not, there is an error.
  bool save(std::filesystem::path path);
  /// Bakes the simulation in the background; `path` gets its extension if it has none.
  void bake(std::filesystem::path path);
  /// Calls `then`, which ends the document; with unsaved changes it becomes `leaving` instead, for
  /// the user to decide.
  void leave(std::function<void()> then);

  scenes::SceneEditor editor;  ///< its selection is the session's, while shown()
  const std::vector<scenes::BrushEntry> brushes = scenes::brushEntries();
  scenes::Paint paint;
  Vec3 paint_at{};  ///< where stroke() paints
  Tools tools;
  std::function<void()> leaving;  ///< waits for unsaved changes to be saved or given up

 private:
  /// A frame that becomes a scene when `shown` is open.
  struct FrameToTake {
    std::shared_ptr<const FrameProviderRequest> former;  ///< to return to when that fails
    std::uint32_t frame = 0;
    std::shared_ptr<const FrameProviderRequest> shown;
    std::shared_ptr<scenes::AuthoredScene> scene;
  };

  void showAs(FrameProviderOpener open, bool moves);

  Playback& playback_;
  Notices& notices_;
  BackgroundBake& bake_;
  std::filesystem::path path_;
  bool unsaved_ = false;  ///< no file holds it as it was handed in
  std::size_t chosen_brush_ = 0;
  std::unique_ptr<scenes::Brush> brush_;
  std::shared_ptr<const FrameProviderRequest> source_;  ///< that shows the document last
  bool moves_ = false;
  std::uint64_t scene_ = 0;  ///< see FrameProviderRequest; 0: not shown yet
  std::uint64_t last_scene_ = 0;
  Aabb world_{};
  std::optional<FrameToTake> to_take_;
};

}  // namespace broadmark
