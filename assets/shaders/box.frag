#version 330 core
// A face with dark edges of even width in pixels, fading with distance.
uniform vec2 viewport;  // pixels
uniform vec3 haze;

in vec2 face_uv;
flat in vec3 face_colour;
flat in float is_side;
in float far_away;
out vec4 colour;

const float kEdgePixels = 1.1;  // at a height of 720
const float kEdgeDarkness = 0.55;
const float kFootDarkness = 0.10;
const float kHaze = 0.38;

void main() {
  vec2 pixel = max(fwidth(face_uv), vec2(1e-6));  // a pixel's step in u and v
  vec2 distance_px = min(face_uv, 1.0 - face_uv) / pixel;
  float width = kEdgePixels * max(viewport.y / 720.0, 0.6);
  float edge = 1.0 - smoothstep(width - 0.5, width + 0.7, min(distance_px.x, distance_px.y));
  // On faces of a few pixels edges would be all there is: they fade out.
  edge *= smoothstep(2.0, 14.0, min(1.0 / pixel.x, 1.0 / pixel.y));

  vec3 face = face_colour * (1.0 - kFootDarkness * is_side * (1.0 - face_uv.y));
  face *= 1.0 - kEdgeDarkness * edge;
  colour = vec4(mix(face, haze, kHaze * far_away), 1);
}
