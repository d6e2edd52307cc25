// Editing of the document's bodies with the mouse in the view: gizmo drags and brush strokes. The
// document changes only when the mouse is released; until then a limited number of ghosts shows the
// result, so that the cost does not grow with the number of bodies.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "inspector/authoring/brush_stroke.h"
#include "inspector/authoring/gizmo.h"
#include "inspector/session/session.h"
#include "inspector/ui/ui.h"

namespace broadmark {

class ViewportManipulator {
 public:
  /// The state of the view in a picture; borrowed.
  struct Input {
    Session& session;
    const std::shared_ptr<const Snapshot>& snapshot;
    BodyMask visible;
    ViewProjection projection;
    float scale = 1;             ///< pixels per unit
    std::optional<Pixel> mouse;  ///< nothing: outside the view
    bool ctrl = false;           ///< the key is down
  };

  /// Places the gizmo and the ghosts; called once per picture.
  void update(const Input& input);
  /// Handles a press of the left button. Returns whether it starts a drag or a stroke.
  bool press(const Input& input);
  /// Handles the release: applies the drag or the stroke to the document.
  void release(const Input& input);
  /// Cancels the drag or the stroke; plays on if a drag has paused. Returns whether there was one.
  bool cancel(Session& session);
  /// Whether a drag or a stroke is in progress.
  [[nodiscard]] bool busy() const { return drag_.has_value() || painting_; }
  [[nodiscard]] bool painting() const { return painting_; }

  /// Draws over the picture with this upper left corner, and registers the handles as widgets.
  void draw(Ui& ui, const Input& input, ImVec2 corner) const;

  /// Text of the drag or the stroke: "x 1.5"; "": none.
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void updateGizmo(const Input& input);
  void updateBrush(const Input& input);
  void previewDab(const Input& input);
  void paintTo(const Input& input, Pixel to);
  std::optional<Surface> surfaceAt(const Input& input, Pixel pixel);
  void captureBodies(const Input& input);
  void drawHandle(const Ui& ui, const HandleShape& shape, const ViewProjection& projection,
                  Tool tool, ImVec2 corner) const;
  void drawGhosts(const Ui& ui, const ViewProjection& projection, ImVec2 corner) const;
  /// Returns the common centre of the selected bodies, which is cached while they rest.
  Vec3 centreOf(const Input& input);

  /// Source of the document's frames, replaced by each edit.
  std::shared_ptr<const FrameProviderRequest> source_;

  // The gizmo.
  std::vector<HandleShape> shapes_;  ///< none: the gizmo is hidden
  GizmoPose pose_;
  std::optional<Handle> hot_;  ///< under the mouse, or dragged
  std::optional<GizmoDrag> drag_;
  bool resumes_ = false;                        ///< plays on after the drag
  scenes::Transformation change_;               ///< of the drag
  std::vector<scenes::AuthoredBody> captured_;  ///< at its start
  scenes::BodyIds centred_bodies_;              ///< bodies of centre_
  Vec3 centre_{};

  // The brush.
  std::optional<BrushStroke> stroke_;
  bool painting_ = false;
  Pixel painted_at_ = Pixel::Zero();  ///< last position of the stroke
  /// The last result of surfaceAt(), with its arguments.
  struct {
    std::shared_ptr<const Snapshot> snapshot;
    Viewpoint viewpoint;
    Pixel pixel = Pixel::Zero();
    std::optional<Surface> surface;
  } last_surface_;

  std::vector<scenes::AuthoredBody> ghosts_;
  std::string text_;
};

}  // namespace broadmark
