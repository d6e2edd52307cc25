// The authored scene being edited: shown at rest or simulated, saved, baked, closed.
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
#include "broadmark/scenes/transformation.h"
#include "inspector/jobs/jobs.h"
#include "inspector/session/notices.h"
#include "inspector/session/playback.h"

namespace broadmark {

/// `move`, `turn` and `scale` use the gizmo; `none`: the mouse only selects, and moves the camera.
enum class Tool { none, move, turn, scale, brush };
inline constexpr NameTable kTools{{NamedValue{Tool::none, "none"},
                                   {Tool::move, "move"},
                                   {Tool::turn, "rotate"},
                                   {Tool::scale, "scale"},
                                   {Tool::brush, "brush"}}};

/// Settings of the mouse tools that edit the document's bodies in the view.
struct Tools {
  Tool tool = Tool::move;
  bool local = false;     ///< the gizmo uses the axes of the first selected body, not the world's
  bool snaps = false;     ///< drags snap to steps; Ctrl inverts this
  double move_step = 1;   ///< in world units
  double turn_step = 15;  ///< in degrees
  double scale_step = 0.1;

  /// Selects a tool, or none if it is already selected.
  void toggle(Tool other) { tool = tool == other ? Tool::none : other; }
};

/// The scene with its history, its file, the brush and the tools. Initially empty.
class Document {
 public:
  /// The arguments must outlive this object.
  Document(Playback& playback, Notices& notices, Jobs& jobs)
      : playback_(playback), notices_(notices), jobs_(jobs) {
    chooseBrush(0);
  }

  /// The file; "": none yet.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Display name: the file's name, or the scene's.
  [[nodiscard]] std::string title() const {
    return path_.empty() ? editor.scene().name : path_.filename().string();
  }
  /// Number of scenes loaded so far.
  [[nodiscard]] std::uint64_t loads() const { return loads_; }
  /// Whether there are unsaved changes.
  [[nodiscard]] bool isModified() const { return unsaved_ || editor.isModified(); }
  /// Creates a simulation of a copy of the scene. Throws InputError. O(bodies).
  [[nodiscard]] std::unique_ptr<Simulation> simulation() const;

  /// Selects a brush by its index in `brushes`.
  void chooseBrush(std::size_t index) {
    brush_ = brushes.at(index).create();
    chosen_brush_ = index;
  }
  [[nodiscard]] std::size_t chosenBrush() const { return chosen_brush_; }
  [[nodiscard]] scenes::Brush& brush() const { return *brush_; }
  /// Paints a stroke at `paint_at`, without adding it. Throws InputError.
  [[nodiscard]] scenes::Stroke stroke() const {
    return scenes::paint(*brush_, paint, paint_at, editor.scene().bodies);
  }

  /// Whether the playback shows the document.
  [[nodiscard]] bool shown() const { return source_ && source_ == playback_.source(); }
  /// Whether the document is shown with its bodies at their initial poses.
  [[nodiscard]] bool atRest() const { return shown() && !simulated_; }

  /// Replaces the scene and its history, without confirmation, and shows it. `unsaved`: it differs
  /// from its file.
  void load(scenes::AuthoredScene scene, std::filesystem::path path = {}, bool unsaved = false);
  /// Replaces the scene by the shown frame, once that frame's bodies have been read.
  void loadCurrentFrame();
  /// Changes the selected bodies in the shown frame of a simulation, and simulates on from there
  /// once that frame's bodies have been read; plays if `plays`. The scene then starts with this
  /// frame: a step to undo.
  void changeInFrame(const scenes::Transformation& change, bool plays);
  /// Call with every progress of the playback's source.
  void advance(const RunProgress& progress);

  /// Changes the scene and shows it at rest. Reports errors.
  void edit(const std::function<void(scenes::SceneEditor&)>& change);
  /// Adds the painted bodies, selects them, and reports their number. Reports errors.
  void add(const std::function<scenes::Stroke()>& paint_stroke);
  /// Shows the scene at rest.
  void show();
  /// Shows a simulation of the scene.
  void simulate();
  /// Saves the scene to `path`, which becomes its file; adds a missing extension. Returns whether
  /// it succeeded; reports errors.
  bool save(std::filesystem::path path);
  /// Bakes the simulation in the background; adds a missing extension to `path`.
  void bake(std::filesystem::path path);
  /// Calls `then`, which discards the document. With unsaved changes, stores it in `pending_close`
  /// instead, until the user decides.
  void closeThen(std::function<void()> then);

  scenes::SceneEditor editor;  ///< its selection is the session's while shown()
  const std::vector<scenes::BrushEntry> brushes = scenes::brushEntries();
  scenes::Paint paint;
  Vec3 paint_at{};  ///< where stroke() paints
  Tools tools;
  std::function<void()> pending_close;  ///< to call once unsaved changes are saved or discarded

 private:
  /// A frame that becomes the scene when `shown` is open.
  struct PendingFrame {
    std::shared_ptr<const FrameProviderRequest> previous;  ///< shown again on failure
    std::uint32_t frame = 0;
    std::shared_ptr<const FrameProviderRequest> shown;
    std::shared_ptr<scenes::AuthoredScene> scene;
    std::optional<scenes::Transformation> change = {};  ///< of the selected bodies
    bool plays = false;                                 ///< after the change
  };

  void readCurrentFrame();
  void playFrom(const PendingFrame& frame);

  void showFrames(FrameProviderOpener open, bool simulated);

  Playback& playback_;
  Notices& notices_;
  Jobs& jobs_;
  std::filesystem::path path_;
  std::uint64_t loads_ = 0;
  bool unsaved_ = false;  ///< the loaded scene differs from its file
  std::size_t chosen_brush_ = 0;
  std::unique_ptr<scenes::Brush> brush_;
  std::shared_ptr<const FrameProviderRequest>
      source_;  ///< the latest source that shows the document
  bool simulated_ = false;
  std::uint64_t scene_ = 0;  ///< see FrameProviderRequest; 0: not shown yet
  std::uint64_t last_scene_ = 0;
  Aabb world_{};
  std::optional<PendingFrame> pending_frame_;
};

}  // namespace broadmark
