#include "inspector/authoring/brush_stroke.h"

#include <cmath>

#include "broadmark/render/picking.h"

namespace broadmark {
namespace {

/// Returns the face by which a ray enters a box.
Surface entryFace(const Aabb& box, const ViewProjection::Ray& ray) {
  Surface face;
  double entry = -std::numeric_limits<double>::infinity();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (ray.direction[axis] == 0) continue;
    const bool high = ray.direction[axis] < 0;
    const double at = high ? box.max[axis] : box.min[axis];
    const double distance = (at - ray.from[axis]) / ray.direction[axis];
    if (distance <= entry) continue;
    entry = distance;
    face.axis = axis;
    face.sign = high ? 1 : -1;
  }
  face.point = ray.from + entry * ray.direction;
  face.point[face.axis] = face.sign > 0 ? box.max[face.axis] : box.min[face.axis];
  return face;
}

std::optional<Surface> floorUnder(const Aabb& world, const ViewProjection::Ray& ray) {
  const double distance = (world.min[1] - ray.from[1]) / ray.direction[1];
  if (!(distance > 0) || !std::isfinite(distance)) return {};
  Surface floor{.point = ray.from + distance * ray.direction};
  for (const std::size_t axis : {0, 2}) {
    if (floor.point[axis] < world.min[axis] || floor.point[axis] > world.max[axis]) return {};
  }
  floor.point[1] = world.min[1];
  return floor;
}

}  // namespace

std::optional<Surface> surfaceUnder(std::span<const Aabb> boxes, const Aabb& world,
                                    const ViewProjection& projection, Pixel pixel,
                                    BodyMask visible) {
  const ViewProjection::Ray ray = projection.rayThrough(pixel);
  const auto picked =
      pickBody(boxes, projection.space(), projection.viewpoint(), pixel[0], pixel[1], visible);
  if (picked) return entryFace(boxes[picked->body], ray);
  return floorUnder(world, ray);
}

BrushStroke::BrushStroke(const Document& document)
    : document_(&document), occupied_(document.editor.scene().bodies) {}

scenes::Paint BrushStroke::nextPaint() const {
  scenes::Paint paint = document_->paint;
  // A new seed for each dab, so that the dabs of a scattering brush differ.
  paint.seed +=
      static_cast<std::int64_t>(document_->editor.scene().bodies.size() + painted_.bodies.size());
  return paint;
}

Aabb BrushStroke::dabBounds(std::size_t max_bodies) const {
  Aabb bounds = kEmptyBox;
  for (const scenes::AuthoredBody& body :
       scenes::paint(document_->brush(), nextPaint(), {}, scenes::OccupiedSpace(), max_bodies)
           .bodies) {
    bounds = merged(bounds, tightBox(body.shape, body.pose));
  }
  return bounds;
}

scenes::Stroke BrushStroke::dab(const Surface& surface, std::size_t max_bodies) const {
  const Aabb bounds = dabBounds(max_bodies);
  Vec3 at;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double coordinate = surface.point[axis];
    if (axis == surface.axis) coordinate -= surface.sign > 0 ? bounds.min[axis] : bounds.max[axis];
    at[axis] = static_cast<float>(coordinate);
  }
  return scenes::paint(document_->brush(), nextPaint(), at, occupied_, max_bodies);
}

void BrushStroke::paint(const Surface& surface) {
  if (last_surface_ && last_surface_->axis == surface.axis && last_surface_->sign == surface.sign) {
    const Aabb bounds = dabBounds(kUnlimited);
    bool near = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double distance = std::abs(surface.point[axis] - last_surface_->point[axis]);
      near = near && distance < double{bounds.max[axis]} - double{bounds.min[axis]};
    }
    if (near) return;
  }
  last_surface_ = surface;
  scenes::Stroke added = dab(surface);
  for (const scenes::AuthoredBody& body : added.bodies) occupied_.add(body);
  painted_.bodies.insert(painted_.bodies.end(), added.bodies.begin(), added.bodies.end());
  painted_.left_out += added.left_out;
}

}  // namespace broadmark
