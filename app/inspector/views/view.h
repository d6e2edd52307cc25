// The views of the scene: their cameras, and what the mouse does in them.
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

/// Keys that fly while they are held and the mouse is over the view.
struct FlyKey {
  Key key = 0;
  std::array<float, 3> direction{};  ///< forward, right, up
  const char* doc = "";
};
std::span<const FlyKey> flyKeys();

class View {
 public:
  /// What a view shows in a picture.
  struct Shown {
    const char* name = "";
    std::shared_ptr<const Snapshot> snapshot;  ///< null: nothing…
    std::string hint;                          ///< …for this reason
    int track = 0;                             ///< number of the answer's track; 0: the oracle's
    bool has_hands = false;                    ///< the document's bodies can be moved in it
    const View* leader = nullptr;  ///< view to copy the camera from; null: its own camera
  };
  explicit View(const Gl& gl) : scene_(gl) {}

  /// Fills the current window.
  void draw(Ui& ui, Session& session, const RunProgress& progress, const Shown& shown);
  /// Takes over the other one's camera.
  void follow(const View& leader);
  /// Whether the user has moved the camera in the last picture.
  [[nodiscard]] bool moved() const { return moved_; }
  /// Whether it moves by itself.
  [[nodiscard]] bool needsRedraw() const { return flight_.has_value(); }
  [[nodiscard]] const ViewContent& content() const { return content_; }
  /// Labels of the shown answer.
  [[nodiscard]] const AnswerText& answer() const { return answer_; }
  [[nodiscard]] const OrbitCamera& camera() const { return camera_; }
  /// What the mouse does with bodies.
  [[nodiscard]] ViewportManipulator& hands() { return hands_; }

  void lookFrom(Direction direction);
  void lookAtAll();

 private:
  struct Flight {
    OrbitCamera from;
    OrbitCamera to;
    float part = 0;
  };

  void drawEmpty(Ui& ui, const std::string& hint);
  void drawScene(const Ui& ui);
  /// Of a scene that has not been looked at so far.
  void placeCamera(const Snapshot& snapshot);
  void takeFlightRequest(Session& session);
  void fly(const OrbitCamera& to);
  void moveOn(float seconds);
  void handleMouse(Ui& ui, const ViewportManipulator::Seen& seen);
  void handleRelease(const ViewportManipulator::Seen& seen);
  void handleDrag();
  void handleKeys();
  void beginDrag(const ViewportManipulator::Seen& seen);
  void click(Session& session, bool fly_there);
  void selectWithin(Session& session);
  void drawAxisNames(float scale) const;
  [[nodiscard]] double aspect() const;

  SceneView scene_;
  ViewContent content_;
  ViewSpace space_;
  OrbitCamera camera_;
  std::optional<Flight> flight_;
  bool moved_ = false;
  std::shared_ptr<const FrameProviderRequest> source_;  ///< the camera has been placed for
  AnswerText answer_;
  ViewportManipulator hands_;
  // In pixels, of the present picture.
  ImVec2 corner_;
  ImVec2 size_{1, 1};
  ImVec2 mouse_;  ///< beside the corner
  enum class Drag { none, orbit, pan, rectangle, hands } drag_ = Drag::none;
  ImVec2 drag_from_;
  bool dragged_ = false;  ///< the mouse has moved since the button went down
};

/// The views, side by side.
class Views {
 public:
  explicit Views(const Gl& gl) : list_{View(gl), View(gl)} {}

  /// Draws those that are wanted into a rectangle.
  void draw(Ui& ui, Session& session, const RunProgress& progress, ImVec2 position, ImVec2 size);
  /// Whether a camera is in flight.
  [[nodiscard]] bool needsRedraw() const { return std::ranges::any_of(list_, &View::needsRedraw); }
  /// Of what is played.
  [[nodiscard]] View& first() { return list_.front(); }
  [[nodiscard]] const std::array<View, 2>& list() const { return list_; }

 private:
  std::array<View, 2> list_;
};

}  // namespace broadmark
