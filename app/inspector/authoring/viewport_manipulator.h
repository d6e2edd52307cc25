// What the mouse does with the document's bodies in the view: drags of the gizmo, strokes of the
// brush. Nothing of the document changes before the mouse is released; until then ghosts show what
// would be, so that a crowd is as light as a single body.
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
  /// What is seen in a picture; borrowed.
  struct Seen {
    Session& session;
    const std::shared_ptr<const Snapshot>& snapshot;
    BodyMask visible;
    ViewProjection sight;
    float scale = 1;             ///< pixels per unit
    std::optional<Pixel> mouse;  ///< nothing: elsewhere
    bool ctrl = false;           ///< whether that key is down
  };

  /// Once per picture: puts the gizmo and the ghosts where they belong.
  void look(const Seen& seen);
  /// The left button goes down, where look() saw the mouse. Returns whether that is for the hands.
  bool press(const Seen& seen);
  /// The button comes up: changes the document. A press that has not moved paints, but drags
  /// nothing.
  void release(const Seen& seen);
  /// Gives up what is being done with the button down. Returns whether there was anything.
  bool cancel();
  /// Whether a button is down for the hands.
  [[nodiscard]] bool busy() const { return drag_.has_value() || painting_; }
  [[nodiscard]] bool painting() const { return painting_; }

  /// Draws over the picture with this upper left corner, and registers the handles as widgets.
  void draw(Ui& ui, const Seen& seen, ImVec2 corner) const;

  /// The numbers of what is being done: "x 1.5"; "": nothing is.
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void lookAtGizmo(const Seen& seen);
  void lookAtBrush(const Seen& seen);
  void previewDab(const Seen& seen);
  void paintTo(const Seen& seen, Pixel to);
  std::optional<Surface> surfaceAt(const Seen& seen, Pixel pixel);
  void takeBodies(const scenes::SceneEditor& editor);
  void drawHandle(const Ui& ui, const HandleShape& shape, const ViewProjection& sight, Tool tool,
                  ImVec2 corner) const;
  void drawGhosts(const Ui& ui, const ViewProjection& sight, ImVec2 corner) const;
  /// The common centre of the selected bodies. O(1) while nothing changes.
  Vec3 centreOf(const Session& session);

  /// What the document looks like; another one after each edit.
  std::shared_ptr<const FrameProviderRequest> document_;

  // The gizmo.
  std::vector<HandleShape> shapes_;  ///< none: it is not shown
  GizmoPlace place_;
  std::optional<Handle> hot_;  ///< under the mouse, or held
  std::optional<GizmoDrag> drag_;
  scenes::Transformation change_;            ///< of the drag
  std::vector<scenes::AuthoredBody> taken_;  ///< what its ghosts are made from
  scenes::BodyIds centred_;                  ///< the bodies of which centre_ is the centre
  Vec3 centre_{};

  // The brush.
  std::optional<BrushStroke> stroke_;
  bool painting_ = false;
  Pixel painted_at_ = Pixel::Zero();  ///< by the stroke, last
  /// What was pointed at, and from where.
  struct {
    std::shared_ptr<const Snapshot> snapshot;
    Viewpoint viewpoint;
    Pixel pixel = Pixel::Zero();
    std::optional<Surface> surface;
  } pointed_;

  std::vector<scenes::AuthoredBody> ghosts_;
  std::string text_;
};

}  // namespace broadmark
