// Cubes, all of the same size: edge 1 times the scale.

#include "broadmark/scenes/registry.h"

namespace broadmark::scenes::cubes {

ObjectType entry() {
  return {.listing = {"cubes", "Cubes"}, .shape = [](std::size_t, double scale, Random&) -> Shape {
            const auto half = static_cast<float>(scale / 2);
            return BoxShape{{half, half, half}};
          }};
}

}  // namespace broadmark::scenes::cubes
