#include "inspector/session/view_options.h"

#include <limits>

namespace broadmark {
namespace {

double placeOf(const BodyFilter& filter, const Aabb& world) {
  const auto axis = static_cast<std::size_t>(filter.clip_axis);
  const double low = world.min[axis];
  return low + filter.clip_at * (world.max[axis] - low);
}

}  // namespace

bool BodyFilter::hides() const {
  return hidden_layers != 0 || hidden_classes != 0 || smallest > 0 || largest > 0 || clip_axis >= 0;
}

void hideBodies(const BodyFilter& filter, const FilteredBodies& bodies,
                std::vector<std::uint8_t>& visible) {
  const double largest = filter.largest > 0 ? filter.largest : std::numeric_limits<double>::max();
  const bool by_size = filter.smallest > 0 || filter.largest > 0;
  const bool by_layer = filter.hidden_layers != 0 && bodies.layers.size() == bodies.boxes.size();
  const bool by_class = filter.hidden_classes != 0 && bodies.classes.size() == bodies.boxes.size();
  const bool clips = filter.clip_axis >= 0;
  const double plane = clips ? placeOf(filter, bodies.world) : 0;
  for (std::size_t body = 0; body < bodies.boxes.size(); ++body) {
    const Aabb& box = bodies.boxes[body];
    bool hidden = by_layer && ((filter.hidden_layers >> bodies.layers[body]) & 1U) != 0;
    hidden |= by_class && bodies.classes[body] < 64 &&
              ((filter.hidden_classes >> bodies.classes[body]) & 1U) != 0;
    if (by_size) {
      const double size = longestEdge(box);
      hidden |= size < filter.smallest || size > largest;
    }
    if (clips) {
      const double centre = centreOf(box, static_cast<std::size_t>(filter.clip_axis));
      hidden |= filter.clip_below ? centre < plane : centre > plane;
    }
    if (hidden) visible[body] = 0;
  }
}

std::optional<Aabb> clipPlane(const BodyFilter& filter, const Aabb& world) {
  if (filter.clip_axis < 0) return {};
  Aabb plane = world;
  const auto axis = static_cast<std::size_t>(filter.clip_axis);
  plane.min[axis] = plane.max[axis] = static_cast<float>(placeOf(filter, world));
  return plane;
}

}  // namespace broadmark
