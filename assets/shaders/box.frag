// A face with dark edges of even width in pixels, fading with distance.
uniform vec3 haze;
uniform float focus;  // distance from the eye to what it looks at
uniform float opacity;

// The shading of boxes, from shading.h.
uniform float edge_pixels;
uniform float edge_darkness;
uniform float foot_darkness;
uniform float most_haze;
uniform vec2 haze_range;  // from where to where it grows, before and behind the focus

in vec2 face_uv;
flat in vec3 face_colour;
flat in float is_side;
out vec4 colour;

void main() {
  vec2 pixel = max(fwidth(face_uv), vec2(1e-6));  // a pixel's step in u and v
  vec2 distance_px = min(face_uv, 1.0 - face_uv) / pixel;
  float edge = 1.0 - smoothstep(edge_pixels - 0.5, edge_pixels + 0.7,
                                min(distance_px.x, distance_px.y));
  // On faces of a few pixels edges would be all there is: they fade out.
  edge *= smoothstep(2.0, 14.0, min(1.0 / pixel.x, 1.0 / pixel.y));

  vec3 face = face_colour * (1.0 - foot_darkness * is_side * (1.0 - face_uv.y));
  face *= 1.0 - edge_darkness * edge;
  float depth = 1.0 / gl_FragCoord.w;
  float far_away = smoothstep(focus + haze_range.x, focus + haze_range.y, depth);
  colour = vec4(mix(face, haze, most_haze * far_away), opacity);
}
