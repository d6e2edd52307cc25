#include "scenes/sizes.h"

#include <algorithm>
#include <cmath>

#include "scenes/course.h"

namespace broadmark::scenes {

double sizeOfMany(double most, Random& random) {
  // The share of bodies larger than x is 1/x³.
  return std::min(1 / std::cbrt(1 - random.uniform()), std::max(1.0, most));
}

Vec3 anywhereInside(const Shape& shape, double side, Random& random) {
  const double reach = farthestInside(shape, side);
  Vec3 place;
  for (float& coordinate : place) coordinate = static_cast<float>(random.between(-reach, reach));
  return place;
}

}  // namespace broadmark::scenes
