#include "inspector/authoring/brush_stroke.h"

#include <cmath>

#include "broadmark/render/picking.h"

namespace broadmark {
namespace {

/// The face of a box by which a line enters it.
Surface faceOf(const Aabb& box, const ViewProjection::Ray& line) {
  Surface face;
  double latest = -std::numeric_limits<double>::infinity();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (line.direction[axis] == 0) continue;
    const bool high = line.direction[axis] < 0;
    const double at = high ? box.max[axis] : box.min[axis];
    const double share = (at - line.from[axis]) / line.direction[axis];
    if (share <= latest) continue;
    latest = share;
    face.axis = axis;
    face.sign = high ? 1 : -1;
  }
  face.point = line.from + latest * line.direction;
  face.point[face.axis] = face.sign > 0 ? box.max[face.axis] : box.min[face.axis];
  return face;
}

std::optional<Surface> floorUnder(const Aabb& world, const ViewProjection::Ray& line) {
  const double share = (world.min[1] - line.from[1]) / line.direction[1];
  if (!(share > 0) || !std::isfinite(share)) return {};
  Surface floor{.point = line.from + share * line.direction};
  for (const std::size_t axis : {0, 2}) {
    if (floor.point[axis] < world.min[axis] || floor.point[axis] > world.max[axis]) return {};
  }
  floor.point[1] = world.min[1];
  return floor;
}

}  // namespace

std::optional<Surface> surfaceUnder(std::span<const Aabb> boxes, const Aabb& world,
                                    const ViewProjection& sight, Pixel pixel, BodyMask visible) {
  const ViewProjection::Ray line = sight.through(pixel);
  const auto picked =
      pickBody(boxes, sight.space(), sight.viewpoint(), pixel[0], pixel[1], visible);
  if (picked) return faceOf(boxes[picked->body], line);
  return floorUnder(world, line);
}

BrushStroke::BrushStroke(const Document& document)
    : document_(&document), taken_(document.editor.scene().bodies) {}

scenes::Paint BrushStroke::nextPaint() const {
  scenes::Paint paint = document_->paint;
  // No two dabs are alike where the brush scatters.
  paint.seed +=
      static_cast<std::int64_t>(document_->editor.scene().bodies.size() + painted_.bodies.size());
  return paint;
}

Aabb BrushStroke::reach(std::size_t most) const {
  Aabb bounds = kEmptyBox;
  for (const scenes::AuthoredBody& body :
       scenes::paint(document_->brush(), nextPaint(), {}, scenes::OccupiedSpace(), most).bodies) {
    bounds = merged(bounds, tightBox(body.shape, body.pose));
  }
  return bounds;
}

scenes::Stroke BrushStroke::dab(const Surface& surface, std::size_t most) const {
  const Aabb bounds = reach(most);
  Vec3 at;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double place = surface.point[axis];
    if (axis == surface.axis) place -= surface.sign > 0 ? bounds.min[axis] : bounds.max[axis];
    at[axis] = static_cast<float>(place);
  }
  return scenes::paint(document_->brush(), nextPaint(), at, taken_, most);
}

void BrushStroke::paint(const Surface& surface) {
  if (last_ && last_->axis == surface.axis && last_->sign == surface.sign) {
    const Aabb bounds = reach(std::numeric_limits<std::size_t>::max());
    bool near = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double apart = std::abs(surface.point[axis] - last_->point[axis]);
      near = near && apart < double{bounds.max[axis]} - double{bounds.min[axis]};
    }
    if (near) return;
  }
  last_ = surface;
  scenes::Stroke added = dab(surface);
  for (const scenes::AuthoredBody& body : added.bodies) taken_.add(body);
  painted_.bodies.insert(painted_.bodies.end(), added.bodies.begin(), added.bodies.end());
  painted_.left_out += added.left_out;
}

}  // namespace broadmark
