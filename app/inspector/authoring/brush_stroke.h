// Painting in the view: what the mouse points at, and the bodies that the brush puts there.
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
  Point point = Point::Zero();  ///< that is pointed at
  std::size_t axis = 1;         ///< along which bodies stand on it…
  int sign = 1;                 ///< …in this direction
};

/// What is seen at a pixel; of the floor only where the world is. O(boxes).
std::optional<Surface> surfaceUnder(std::span<const Aabb> boxes, const Aabb& world,
                                    const ViewProjection& sight, Pixel pixel,
                                    BodyMask visible = {});

/// One stroke of the document's brush, from press to release: a dab where it begins, and others as
/// far from each other as they are wide. What is painted keeps clear of the document's bodies and
/// of the stroke's own. For the document as it is: an edit calls for another one.
class BrushStroke {
 public:
  /// Takes note of the room that the document's bodies take: O(bodies).
  explicit BrushStroke(const Document& document);

  /// The bodies of a dab on the surface, standing on it; `most` of them or fewer. Throws
  /// InputError.
  [[nodiscard]] scenes::Stroke dab(
      const Surface& surface, std::size_t most = std::numeric_limits<std::size_t>::max()) const;
  /// Adds a dab, unless the last one is too near. Throws InputError.
  void paint(const Surface& surface);

  /// What has been painted so far.
  [[nodiscard]] const scenes::Stroke& painted() const { return painted_; }

 private:
  /// The AABB of a dab around the origin in an empty scene.
  [[nodiscard]] Aabb reach(std::size_t most) const;
  [[nodiscard]] scenes::Paint nextPaint() const;

  const Document* document_;
  scenes::OccupiedSpace taken_;
  scenes::Stroke painted_;
  std::optional<Surface> last_;
};

}  // namespace broadmark
