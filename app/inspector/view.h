// The view of the scene: what is drawn, the camera, and what the mouse does in it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "broadmark/render/colouring.h"
#include "broadmark/render/gl.h"
#include "broadmark/render/input_queue.h"
#include "broadmark/render/orbit_camera.h"
#include "broadmark/render/overlays.h"
#include "broadmark/render/scene_view.h"
#include "inspector/answer_text.h"
#include "inspector/hands.h"
#include "inspector/session.h"
#include "inspector/ui.h"

namespace broadmark {

/// Keys that fly while they are held and the mouse is over the view.
struct FlyKey {
  Key key = 0;
  std::array<float, 3> direction{};  ///< forward, right, up
  const char* doc = "";
};
extern const std::array<FlyKey, 6> kFlyKeys;

class View {
 public:
  /// Whether it shows what is played, where the hands are, or what stands beside that.
  enum class Role { first, second };
  explicit View(const Gl& gl, Role role = Role::first);

  /// Fills the current window. `leader`: whose camera it takes over; null: it has its own.
  void draw(Ui& ui, Session& session, const RunProgress& progress, const View* leader = nullptr);
  /// Takes over the other one's camera.
  void follow(const View& leader);
  /// Whether the user has moved the camera in the last picture.
  [[nodiscard]] bool moved() const { return moved_; }
  /// Whether it moves by itself.
  [[nodiscard]] bool lively() const { return flight_.has_value(); }
  /// What the colours of the present picture mean.
  [[nodiscard]] const std::vector<LegendEntry>& legend() const { return colouring_.legend; }
  /// The same of the oracle's answer, where the colours tell of another one.
  [[nodiscard]] const std::vector<LegendEntry>& oracleLegend() const { return oracle_legend_; }
  /// What the colours of the shown structure mean, and how many of its cells have each.
  [[nodiscard]] const std::vector<LegendEntry>& cellLegend() const { return cell_legend_; }
  /// How many bodies are not drawn because the user does not want to see them.
  [[nodiscard]] std::size_t hiddenBodies() const;
  /// Whose answer is seen.
  [[nodiscard]] const AnswerText& answer() const { return answer_; }
  [[nodiscard]] const OrbitCamera& camera() const { return camera_; }
  /// What the mouse does with bodies.
  [[nodiscard]] Hands& hands() { return hands_; }

  void lookFrom(Direction direction);
  void lookAtAll();

 private:
  struct Flight {
    OrbitCamera from;
    OrbitCamera to;
    float part = 0;
  };
  /// What a picture of the bodies was made from.
  struct Shown {
    std::shared_ptr<const Snapshot> snapshot;
    std::shared_ptr<const PairComparison> comparison;  ///< with the other view; null: none
    std::vector<std::uint32_t> selection;
    ViewOptions options;
    bool dark = false;
  };

  void update(Session& session, const RunProgress& progress, bool dark);
  void drawEmpty(Ui& ui, const char* hint, ImVec2 corner, ImVec2 size);
  void drawScene(const Ui& ui, ImVec2 corner, ImVec2 size);
  void updateBodies(const Session& session);
  void updateVisible(const ViewOptions& options);
  void addXray(bool dark);
  void updateLines(const Session& session, bool dark);
  void add(Overlay overlay);
  void takeFlightRequest(Session& session);
  void fly(const OrbitCamera& to);
  void moveOn(float seconds);
  void handleMouse(Ui& ui, const Hands::Seen& seen, ImVec2 corner, ImVec2 size);
  void handleRelease(const Hands::Seen& seen, ImVec2 mouse);
  void handleDrag(ImVec2 corner, ImVec2 size);
  void handleKeys();
  void beginDrag(const Hands::Seen& seen, ImVec2 mouse);
  void click(Session& session, ImVec2 at, bool fly_there);
  void selectWithin(Session& session, ImVec2 from, ImVec2 to);
  void drawAxisNames(ImVec2 corner) const;
  /// Of those that are present; empty if there are none.
  [[nodiscard]] Aabb boundsOf(std::span<const std::uint32_t> bodies) const;
  [[nodiscard]] double aspect() const;

  const Role role_;
  SceneView scene_;
  SceneViewContent content_;
  Shown shown_;
  OrbitCamera camera_;
  std::optional<Flight> flight_;
  bool moved_ = false;
  std::shared_ptr<const FootageRequest> footage_;  ///< the camera has been placed for
  Colouring colouring_;
  std::vector<LegendEntry> oracle_legend_;  ///< of the oracle's answer, if another one is shown
  std::vector<LegendEntry> cell_legend_;
  AnswerText answer_;
  std::vector<std::uint8_t> visible_;
  std::vector<SceneLine> lines_;
  std::vector<SceneWireBox> wire_boxes_;
  std::uint64_t revision_ = 0;
  std::size_t left_out_ = 0;  ///< lines and boxes that were too many
  Hands hands_;
  int width_ = 1;
  int height_ = 1;
  enum class Drag { none, orbit, pan, rectangle, hands } drag_ = Drag::none;
  ImVec2 drag_from_;
  bool dragged_ = false;  ///< the mouse has moved since the button went down
};

}  // namespace broadmark
