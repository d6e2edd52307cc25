// How boxes and lines look, in the shaders and in the software renderer alike.
#pragma once

namespace broadmark {

struct BoxLook {
  /// Brightness by the axis of the face: light from above, a little more from z than from x.
  float light[3] = {0.79F, 1.0F, 0.91F};
  float underside = 0.55F;      ///< brightness of the lower face
  float foot_darkness = 0.10F;  ///< of an upright face at its lower border
  float edge_pixels = 1.1F;     ///< width of the dark edges in a picture 720 pixels high
  float edge_darkness = 0.55F;
  float haze = 0.38F;        ///< how much the farthest faces fade towards the background
  float haze_before = 0.8F;  ///< haze begins this far before the camera's target, in view space
  float haze_behind = 0.9F;  ///< and is full this far behind it
  /// A body is drawn at least this wide, in pixels: a sphere of that size always covers the middle
  /// of a pixel, so no body is lost.
  float smallest_pixels = 1.42F;
};
inline constexpr BoxLook kBoxLook;

struct LineLook {
  /// Lines lie so much nearer to the eye than they are, or the edges of boxes would cover half of
  /// them.
  float lift = 0.001F;
  float faint = 0.28F;  ///< opacity of what bodies hide of a faint line
};
inline constexpr LineLook kLineLook;

/// Width of the edges in a picture of that height, in pixels.
constexpr float edgePixels(int height) {
  const float scale = static_cast<float>(height) / 720;
  return kBoxLook.edge_pixels * (scale > 0.6F ? scale : 0.6F);
}

}  // namespace broadmark
