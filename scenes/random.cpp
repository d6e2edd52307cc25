#include "broadmark/scenes/random.h"

namespace broadmark::scenes {

double Random::uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

Vec3 Random::inBall(double radius) {
  // Rejection from the cube: exactly uniform, and no library function that might round differently.
  for (;;) {
    const double x = 2 * uniform() - 1;
    const double y = 2 * uniform() - 1;
    const double z = 2 * uniform() - 1;
    if (x * x + y * y + z * z <= 1) {
      return {static_cast<float>(radius * x), static_cast<float>(radius * y),
              static_cast<float>(radius * z)};
    }
  }
}

}  // namespace broadmark::scenes
