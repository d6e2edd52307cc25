// The gizmo: handles around the selected bodies, by which the mouse moves, turns and scales them.
// Pure geometry: where the handles are, which one is under the mouse, and what a drag of it makes
// of the bodies.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "broadmark/names.h"
#include "broadmark/render/picking.h"
#include "broadmark/scenes/transformation.h"
#include "inspector/session/document.h"

namespace broadmark {

/// A point or a direction in the world.
using Point = Eigen::Vector3d;
/// Pixels from the upper left corner of the view.
using Pixel = Eigen::Vector2f;

inline Point pointOf(const Vec3& v) { return {v[0], v[1], v[2]}; }

/// Projects points of the world to pixels, and unprojects pixels to rays.
class ViewProjection {
 public:
  struct Ray {
    Point from;       ///< the eye
    Point direction;  ///< of any length
  };

  ViewProjection(const ViewSpace& space, const Viewpoint& viewpoint)
      : space_(space), viewpoint_(viewpoint) {}

  /// Nothing for a point behind the eye.
  [[nodiscard]] std::optional<Pixel> pixelOf(const Point& point) const;
  /// The ray through a pixel.
  [[nodiscard]] Ray through(Pixel pixel) const;
  [[nodiscard]] Point eye() const;
  /// The world length that a pixel covers there.
  [[nodiscard]] double pixelAt(const Point& point) const;

  [[nodiscard]] const ViewSpace& space() const { return space_; }
  [[nodiscard]] const Viewpoint& viewpoint() const { return viewpoint_; }

 private:
  ViewSpace space_;
  Viewpoint viewpoint_;
};

/// An axis (or the ring about it), a plane of two, or all three at once.
enum class Handle { x, y, z, yz, zx, xy, all };
inline constexpr NameTable kHandles{{NamedValue{Handle::x, "x"},
                                     {Handle::y, "y"},
                                     {Handle::z, "z"},
                                     {Handle::yz, "yz"},
                                     {Handle::zx, "zx"},
                                     {Handle::xy, "xy"},
                                     {Handle::all, "all"}}};

/// Its columns are where the world's axes point once they are turned.
Eigen::Matrix3d turnOf(const Quaternion& turn);

/// Where the gizmo is.
struct GizmoPlace {
  Vec3 centre{};
  Quaternion turn{0, 0, 0, 1};  ///< from the world's axes to the gizmo's
  double length = 1;            ///< of an axis, in world units

  [[nodiscard]] Point axis(std::size_t which) const {
    return turnOf(turn).col(static_cast<Eigen::Index>(which));
  }
};

/// A handle as it is to be drawn and hit: a line through these points, or the area within.
struct HandleShape {
  Handle handle = Handle::x;
  std::vector<Point> points;
  bool filled = false;
  Point grip = Point::Zero();  ///< where the mouse can grab the handle
};

/// The handles of a tool. Those that could not be dragged are left out: an axis seen from its end,
/// a plane seen from its edge. Of rings the half before the centre.
std::vector<HandleShape> handleShapes(Tool tool, const GizmoPlace& place,
                                      const ViewProjection& sight);

/// The handle nearest to a pixel, within `reach` pixels; of a plane also all that is inside.
std::optional<Handle> handleUnder(const std::vector<HandleShape>& shapes,
                                  const ViewProjection& sight, Pixel pixel, float reach);

/// One drag of a handle, from press to release, seen from one place.
class GizmoDrag {
 public:
  GizmoDrag(Tool tool, Handle handle, const GizmoPlace& place, const ViewProjection& sight,
            Pixel from);

  struct Outcome {
    scenes::Transformation change;
    std::string text;  ///< the numbers, for people: "x 1.5"
  };
  /// With the mouse there. `snaps`: by the steps of `tools`.
  [[nodiscard]] Outcome at(Pixel pixel, const Tools& tools, bool snaps) const;

 private:
  [[nodiscard]] Outcome moved(Pixel pixel, double step) const;
  [[nodiscard]] Outcome turned(Pixel pixel, double step) const;
  [[nodiscard]] Outcome scaled(Pixel pixel, double step) const;
  /// How far along an axis the mouse is, from the centre.
  [[nodiscard]] double along(std::size_t axis, Pixel pixel) const;
  /// Where the mouse is on the plane across an axis, from the centre.
  [[nodiscard]] std::optional<Point> across(std::size_t axis, Pixel pixel) const;

  Tool tool_;
  Handle handle_;
  GizmoPlace place_;
  ViewProjection sight_;
  Pixel from_;
};

}  // namespace broadmark
