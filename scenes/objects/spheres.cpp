// Spheres, all of the same size: diameter 1 times the scale.

#include "broadmark/scenes/registry.h"

namespace broadmark::scenes::spheres {

ObjectType entry() {
  return {.listing = {"spheres", "Spheres"},
          .shape = [](std::size_t, double scale, Random&) -> Shape {
            return SphereShape{static_cast<float>(scale / 2)};
          }};
}

}  // namespace broadmark::scenes::spheres
