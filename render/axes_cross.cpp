#include "axes_cross.h"

#include <algorithm>
#include <cmath>

#include "broadmark/render/scene_view.h"

namespace broadmark {
namespace {

constexpr float kAxesSide = 96;  ///< pixels
constexpr float kAxesWidth = 2.4F;

// In lengths of an axis.
constexpr float kAxesReach = 1.55F;  ///< half the side of the picture
constexpr float kAxesLabels = 1.28F;
constexpr float kAxesDistance = 8;  ///< of the eye

}  // namespace

Viewpoint axesViewpoint(const Viewpoint& viewpoint, float scale) {
  const CameraAxes axes = axesOf(viewpoint.camera);
  Viewpoint result = viewpoint;
  result.width = result.height = std::max(1, static_cast<int>(std::lround(kAxesSide * scale)));
  constexpr float kHalf = kAxesReach / kAxesDistance;
  result.camera = {};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.camera.eye[axis] = kAxesDistance * axes.back[axis];
  }
  result.camera.window_min = {-kHalf, -kHalf};
  result.camera.window_max = {kHalf, kHalf};
  return result;
}

std::vector<Primitive> axesCross(const Camera& camera, const Palette& theme, float scale) {
  const std::array<float, 3> back = axesOf(camera).back;
  std::array<std::size_t, 3> order = {0, 1, 2};
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return back[a] < back[b]; });
  std::vector<Primitive> lines;
  for (const std::size_t axis : order) {
    Primitive line{{}, static_cast<float>(theme.axis[axis]), {}, kAxesWidth * scale};
    line.to[axis] = 1;
    lines.push_back(line);
  }
  return lines;
}

std::array<std::array<float, 2>, 3> axisTips(const Viewpoint& viewpoint, float scale) {
  const Viewpoint corner = axesViewpoint(viewpoint, scale);
  const float margin = std::trunc(kAxesMargin * scale);
  std::array<std::array<float, 2>, 3> tips{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::array<float, 3> tip{};
    tip[axis] = kAxesLabels;
    const std::array at = project(corner.camera, tip).value();
    tips[axis] = {margin + (at[0] + 1) / 2 * static_cast<float>(corner.width),
                  static_cast<float>(viewpoint.height) - margin -
                      (at[1] + 1) / 2 * static_cast<float>(corner.height)};
  }
  return tips;
}

}  // namespace broadmark
