// The gizmo: handles by which the mouse moves, turns and scales the selected bodies. Pure geometry:
// shapes of the handles, hit tests, and transformations by drags.
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

  /// Returns nothing for a point behind the eye.
  [[nodiscard]] std::optional<Pixel> pixelOf(const Point& point) const;
  [[nodiscard]] Ray rayThrough(Pixel pixel) const;
  [[nodiscard]] Point eye() const;
  /// Returns the world length of a pixel at the depth of the point.
  [[nodiscard]] double pixelSizeAt(const Point& point) const;

  [[nodiscard]] const ViewSpace& space() const { return space_; }
  [[nodiscard]] const Viewpoint& viewpoint() const { return viewpoint_; }

 private:
  ViewSpace space_;
  Viewpoint viewpoint_;
};

/// An axis (or the ring about it), a plane of two axes, or all three axes.
enum class Handle { x, y, z, yz, zx, xy, all };
inline constexpr NameTable kHandles{{NamedValue{Handle::x, "x"},
                                     {Handle::y, "y"},
                                     {Handle::z, "z"},
                                     {Handle::yz, "yz"},
                                     {Handle::zx, "zx"},
                                     {Handle::xy, "xy"},
                                     {Handle::all, "all"}}};

/// The columns are the rotated axes of the world.
Eigen::Matrix3d rotationMatrix(const Quaternion& rotation);

/// Position, orientation and size of the gizmo.
struct GizmoPose {
  Vec3 centre{};
  Quaternion rotation{0, 0, 0, 1};  ///< from the world's axes to the gizmo's
  double length = 1;                ///< of an axis, in world units

  [[nodiscard]] Point axis(std::size_t index) const {
    return rotationMatrix(rotation).col(static_cast<Eigen::Index>(index));
  }
};

/// The shape of a handle, to draw and to hit: a polyline or, if `filled`, a polygon.
struct HandleShape {
  Handle handle = Handle::x;
  std::vector<Point> points;
  bool filled = false;
  Point grip = Point::Zero();  ///< a point to grab the handle
};

/// Returns the handles of a tool, without those that cannot be dragged: axes seen end-on, planes
/// seen edge-on. Rings have only their half in front of the centre.
std::vector<HandleShape> handleShapes(Tool tool, const GizmoPose& pose,
                                      const ViewProjection& projection);

/// Returns the handle nearest to a pixel, within `reach` pixels; a plane is hit anywhere inside.
std::optional<Handle> handleUnder(const std::vector<HandleShape>& shapes,
                                  const ViewProjection& projection, Pixel pixel, float reach);

/// One drag of a handle, from press to release, with a fixed camera.
class GizmoDrag {
 public:
  GizmoDrag(Tool tool, Handle handle, const GizmoPose& pose, const ViewProjection& projection,
            Pixel from);

  struct Outcome {
    scenes::Transformation change;
    std::string text;  ///< for the user: "x 1.5"
  };
  /// Returns the outcome with the mouse at this pixel. `snaps`: in the steps of `tools`.
  [[nodiscard]] Outcome at(Pixel pixel, const Tools& tools, bool snaps) const;

 private:
  [[nodiscard]] Outcome moved(Pixel pixel, double step) const;
  [[nodiscard]] Outcome turned(Pixel pixel, double step) const;
  [[nodiscard]] Outcome scaled(Pixel pixel, double step) const;
  /// Returns the coordinate on an axis, from the centre, of the point nearest to the mouse's ray.
  [[nodiscard]] double axisCoordinate(std::size_t axis, Pixel pixel) const;
  /// Returns the point, from the centre, where the mouse's ray hits the plane normal to an axis.
  [[nodiscard]] std::optional<Point> planePoint(std::size_t axis, Pixel pixel) const;

  Tool tool_;
  Handle handle_;
  GizmoPose pose_;
  ViewProjection projection_;
  Pixel from_;
};

}  // namespace broadmark
