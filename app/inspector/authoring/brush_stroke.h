// Painting in the view: the surface under the mouse, and the bodies that the brush adds to it.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>

#include "inspector/authoring/gizmo.h"
#include "inspector/session/document.h"

namespace broadmark {

/// A face of a body's box, or the world's floor.
struct Surface {
  Point point = Point::Zero();  ///< under the mouse
  std::size_t axis = 1;         ///< of the normal
  int sign = 1;                 ///< of the normal
};

/// Returns the surface at a pixel; of the floor, only the part within the world. O(boxes).
std::optional<Surface> surfaceUnder(std::span<const Aabb> boxes, const Aabb& world,
                                    const ViewProjection& projection, Pixel pixel,
                                    BodyMask visible = {});

/// One stroke of the document's brush, from press to release: dabs at distances of their width,
/// clear of the document's bodies and of each other. Invalid after an edit of the document.
class BrushStroke {
 public:
  /// Computes the space occupied by the document's bodies: O(bodies).
  explicit BrushStroke(const Document& document);

  /// Returns the bodies of a dab, standing on the surface. Throws InputError.
  [[nodiscard]] scenes::Stroke dab(const Surface& surface,
                                   std::size_t max_bodies = kUnlimited) const;
  /// Adds a dab, unless it is too close to the last one. Throws InputError.
  void paint(const Surface& surface);

  /// The bodies painted so far.
  [[nodiscard]] const scenes::Stroke& painted() const { return painted_; }

 private:
  static constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();

  /// Returns the AABB of a dab at the origin of an empty scene.
  [[nodiscard]] Aabb dabBounds(std::size_t max_bodies) const;
  [[nodiscard]] scenes::Paint nextPaint() const;

  const Document* document_;
  scenes::OccupiedSpace occupied_;
  scenes::Stroke painted_;
  std::optional<Surface> last_surface_;
};

}  // namespace broadmark
