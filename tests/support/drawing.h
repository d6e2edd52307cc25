// Boxes to draw, and their positions and colours in a picture.
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

/// Cubes in a world of side 10. Does not use std::uniform_real_distribution: its results differ
/// between libraries.
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

/// Position of a world point in the picture, in pixels from the upper left corner.
inline std::array<float, 2> pixelOf(const Viewpoint& viewpoint, const std::array<float, 3>& point) {
  const std::array ndc = project(viewpoint.camera, point).value();
  return {(ndc[0] + 1) / 2 * static_cast<float>(viewpoint.width),
          (1 - ndc[1]) / 2 * static_cast<float>(viewpoint.height)};
}

/// Red, green and blue at a position of the picture, in pixels from the upper left corner.
inline std::array<int, 3> colourAt(const Picture& picture, const std::array<float, 2>& position) {
  const auto column = static_cast<std::size_t>(position[0]);
  const auto row = static_cast<std::size_t>(position[1]);
  const std::uint8_t* pixel =
      &picture.rgba[4 * (row * static_cast<std::size_t>(picture.width) + column)];
  return {pixel[0], pixel[1], pixel[2]};
}

}  // namespace broadmark::tests
