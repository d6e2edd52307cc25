// Boxes to draw, and where they appear in a picture.
#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "broadmark/aabb.h"
#include "broadmark/render/camera.h"
#include "broadmark/render/offscreen_context.h"

namespace broadmark::tests {

/// Software drivers only: the same picture on every machine.
inline OffscreenOptions softwareOnly() {
  OffscreenOptions options;
  options.software = true;
  return options;
}

inline Aabb cube(const std::array<float, 3>& centre, float side) {
  Aabb box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.min[axis] = centre[axis] - side / 2;
    box.max[axis] = centre[axis] + side / 2;
  }
  return box;
}

/// Cubes in a world of side 10. Not by std::uniform_real_distribution, whose results differ between
/// libraries.
inline std::vector<Aabb> randomCubes(std::size_t count, float smallest, float largest,
                                     unsigned seed) {
  std::mt19937 bits(seed);
  const auto random = [&](float low, float high) {
    return low + (high - low) * static_cast<float>(bits() >> 8) / static_cast<float>(1U << 24);
  };
  std::vector<Aabb> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const float x = random(-4.5F, 4.5F);
    const float y = random(-4.5F, 4.5F);
    const float z = random(-4.5F, 4.5F);
    boxes.push_back(cube({x, y, z}, random(smallest, largest)));
  }
  return boxes;
}

/// Where a point of view space appears, in pixels from the upper left corner.
inline std::array<float, 2> pixelOf(const Viewpoint& viewpoint, const std::array<float, 3>& point) {
  const std::array at = project(viewpoint.camera, point).value();
  return {(at[0] + 1) / 2 * static_cast<float>(viewpoint.width),
          (1 - at[1]) / 2 * static_cast<float>(viewpoint.height)};
}

/// Red, green and blue at a place of the picture, in pixels from the upper left corner.
inline std::array<int, 3> colourAt(const Picture& picture, const std::array<float, 2>& place) {
  const auto column = static_cast<std::size_t>(place[0]);
  const auto row = static_cast<std::size_t>(place[1]);
  const std::uint8_t* pixel =
      &picture.rgba[4 * (row * static_cast<std::size_t>(picture.width) + column)];
  return {pixel[0], pixel[1], pixel[2]};
}

}  // namespace broadmark::tests
