// The authored scene being edited: shown at rest or in motion, saved, baked, and left.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "broadmark/scenes/authored_simulation.h"
#include "inspector/jobs/background_bake.h"
#include "inspector/session/author_desk.h"
#include "inspector/session/body_selection.h"
#include "inspector/session/notices.h"
#include "inspector/session/playback.h"

namespace broadmark {

class Document {
 public:
  /// The parts it acts on outlive it.
  Document(Playback& playback, BodySelection& selection, Notices& notices, BackgroundBake& bake)
      : playback_(playback), selection_(selection), notices_(notices), bake_(bake) {}

  /// Whether it is what is played.
  [[nodiscard]] bool shown() const { return footage_ && footage_ == playback_.footage(); }
  /// Likewise, where its bodies start.
  [[nodiscard]] bool atRest() const { return shown() && !moves_; }

  /// Takes another scene and shows it. Does not ask.
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
  /// Returns whether it could be written; if not, there is an error.
  bool save(const std::filesystem::path& path);
  /// Bakes the simulation in the background; `path` gets its extension if it has none.
  void bake(std::filesystem::path path);
  /// Calls `then`, which ends the document; with unsaved changes it becomes `leaving` instead, for
  /// the user to decide.
  void leave(std::function<void()> then);

  AuthorDesk desk;                ///< its selection is the inspector's, while shown()
  std::function<void()> leaving;  ///< waits for unsaved changes to be saved or given up

 private:
  /// A frame that becomes a scene when `shown` is open.
  struct FrameToTake {
    std::shared_ptr<const FootageRequest> former;  ///< to return to when that fails
    std::uint32_t frame = 0;
    std::shared_ptr<const FootageRequest> shown;
    std::shared_ptr<scenes::AuthoredScene> scene;
  };

  void showAs(FootageOpener open, bool moves);

  Playback& playback_;
  BodySelection& selection_;
  Notices& notices_;
  BackgroundBake& bake_;
  std::shared_ptr<const FootageRequest> footage_;  ///< that shows the document last
  bool moves_ = false;
  std::uint64_t scene_ = 0;  ///< see FootageRequest; 0: not shown yet
  std::uint64_t last_scene_ = 0;
  Aabb world_{};
  std::optional<FrameToTake> to_take_;
};

}  // namespace broadmark
