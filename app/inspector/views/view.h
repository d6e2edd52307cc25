// The views of the scene, with their cameras and mouse controls.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "broadmark/render/gl.h"
#include "broadmark/render/input_queue.h"
#include "broadmark/render/orbit_camera.h"
#include "broadmark/render/scene_view.h"
#include "inspector/authoring/viewport_manipulator.h"
#include "inspector/session/answer_text.h"
#include "inspector/session/session.h"
#include "inspector/ui/ui.h"
#include "inspector/views/view_content.h"

namespace broadmark {

/// A key that moves the camera while it is held and the mouse is over the view.
struct FlyKey {
  Key key = 0;
  std::array<float, 3> direction{};  ///< forward, right, up
  const char* doc = "";
};
std::span<const FlyKey> flyKeys();

class View {
 public:
  /// The input of a view in a picture.
  struct Input {
    const char* name = "";
    std::shared_ptr<const Snapshot> snapshot;  ///< null: draws `hint`
    std::string hint;                          ///< reason for drawing no scene
    std::string waiting = {};                  ///< what delays the requested frame
    int track = 0;                             ///< number of the answer's track; 0: the oracle's
    bool editable = false;                     ///< the document's bodies can be moved
    const View* leader = nullptr;  ///< view to copy the camera from; null: its own camera
  };
  explicit View(const Gl& gl) : scene_(gl) {}

  /// Fills the current window.
  void draw(Ui& ui, Session& session, const RunProgress& progress, const Input& input);
  void copyCamera(const View& leader);
  /// Whether the user moved the camera in the last picture.
  [[nodiscard]] bool cameraMoved() const { return camera_moved_; }
  /// Whether the camera is in flight.
  [[nodiscard]] bool needsRedraw() const { return flight_.has_value(); }
  [[nodiscard]] const ViewContent& content() const { return content_; }
  /// Labels of the shown answer.
  [[nodiscard]] const AnswerText& answer() const { return answer_; }
  [[nodiscard]] const OrbitCamera& camera() const { return camera_; }
  /// Edits the document's bodies with the mouse.
  [[nodiscard]] ViewportManipulator& hands() { return manipulator_; }

  void viewFrom(Direction direction);
  void showWholeScene();

 private:
  struct Flight {
    OrbitCamera from;
    OrbitCamera to;
    float progress = 0;  ///< from 0 to 1
  };

  void drawEmpty(Ui& ui, const std::string& hint);
  void drawScene(const Ui& ui, const Session& session);
  /// Resets the camera for a new scene.
  void placeCamera(const Snapshot& snapshot, Session& session);
  void startRequestedFlight(Session& session);
  void flyTo(const OrbitCamera& to);
  void advanceFlight(float seconds);
  void handleMouse(Ui& ui, const ViewportManipulator::Input& input);
  void handleRelease(const ViewportManipulator::Input& input);
  void handleDrag();
  void handleKeys();
  void beginDrag(const ViewportManipulator::Input& input);
  void click(Session& session, bool fly_there);
  void selectWithin(Session& session);
  void drawAxisNames(float scale) const;
  [[nodiscard]] double aspect() const;

  SceneView scene_;
  ViewContent content_;
  ViewSpace space_;
  OrbitCamera camera_;
  std::optional<Flight> flight_;
  bool camera_moved_ = false;
  std::shared_ptr<const FrameProviderRequest> source_;  ///< of the camera's placement
  AnswerText answer_;
  ViewportManipulator manipulator_;
  // In pixels, of the current picture.
  ImVec2 corner_;
  ImVec2 size_{1, 1};
  ImVec2 mouse_;  ///< relative to corner_
  enum class Drag { none, orbit, pan, rectangle, manipulate } drag_ = Drag::none;
  ImVec2 drag_from_;
  bool dragged_ = false;  ///< the mouse has moved since the press
};

/// The views, side by side.
class Views {
 public:
  explicit Views(const Gl& gl) : list_{View(gl), View(gl)} {}

  /// Draws the open views into a rectangle.
  void draw(Ui& ui, Session& session, const RunProgress& progress, ImVec2 position, ImVec2 size);
  /// Whether a camera is in flight.
  [[nodiscard]] bool needsRedraw() const { return std::ranges::any_of(list_, &View::needsRedraw); }
  /// The view of the playback.
  [[nodiscard]] View& first() { return list_.front(); }
  [[nodiscard]] const std::array<View, 2>& list() const { return list_; }

 private:
  std::array<View, 2> list_;
};

}  // namespace broadmark
