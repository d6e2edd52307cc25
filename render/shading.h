// Constants of shading, shared by the shaders and the software renderer.
#pragma once

namespace broadmark {

struct BoxShading {
  /// Brightness by the face's axis: light from above, and slightly more from z than from x.
  float light[3] = {0.79F, 1.0F, 0.91F};
  float underside = 0.55F;      ///< brightness of the lower face
  float foot_darkness = 0.10F;  ///< of a vertical face at its lower border
  float edge_pixels = 1.1F;     ///< width of the dark edges in a picture 720 pixels high
  float edge_darkness = 0.55F;
  float haze = 0.38F;        ///< fading of the farthest faces towards the background
  float haze_before = 0.8F;  ///< start of the haze before the target, in view space
  float haze_behind = 0.9F;  ///< full haze behind the target
  /// The minimum width of a body in pixels: a sphere of this size always covers the centre of a
  /// pixel, so no body disappears.
  float min_pixels = 1.42F;
  float glass = 0.02F;  ///< opacity of a transparent body's faces
};
inline constexpr BoxShading kBoxShading;

struct LineShading {
  /// Relative shift of lines towards the eye, so that the edges of boxes do not cover half of the
  /// line.
  float lift = 0.001F;
  float faint = 0.28F;  ///< opacity of the hidden part of a faint line
  float glass = 0.3F;   ///< opacity of a transparent body's edges
};
inline constexpr LineShading kLineShading;

/// Width of the edges in a picture of this height, in pixels.
constexpr float edgePixels(int height) {
  const float scale = static_cast<float>(height) / 720;
  return kBoxShading.edge_pixels * (scale > 0.6F ? scale : 0.6F);
}

}  // namespace broadmark
