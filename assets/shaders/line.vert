// A line pulled from the texture of primitives (see box.vert), widened on the screen to a rectangle of two triangles.
uniform sampler2D primitives;
uniform mat4 view_projection;
uniform vec3 eye;
uniform vec2 viewport;  // pixels
uniform float lift;     // part of the way to the eye, from shading.h

out float across_w;         // pixels from the middle of the line, times w: linear on the screen
flat out float half_width;  // pixels
flat out vec3 line_colour;

const float kNearest = 1e-3;  // clip w: what lies nearer, or behind the eye, is cut off

const vec2 kCorners[6] =
    vec2[](vec2(0, -1), vec2(1, -1), vec2(1, 1), vec2(0, -1), vec2(1, 1), vec2(0, 1));

void main() {
  int primitive = gl_VertexID / 6;
  int per_row = textureSize(primitives, 0).x / 2;
  ivec2 texel = ivec2(2 * (primitive % per_row), primitive / per_row);
  vec4 from = texelFetch(primitives, texel, 0);
  vec4 to = texelFetch(primitives, texel + ivec2(1, 0), 0);
  int rgb = int(from.w);
  line_colour = vec3(rgb >> 16, (rgb >> 8) & 255, rgb & 255) / 255.0;

  vec4 a = view_projection * vec4(mix(from.xyz, eye, lift), 1);
  vec4 b = view_projection * vec4(mix(to.xyz, eye, lift), 1);
  if (a.w < kNearest && b.w < kNearest) {
    gl_Position = vec4(0, 0, 2, 1);  // wholly behind the eye: outside the clip volume
    return;
  }
  if (a.w < kNearest) a = mix(a, b, (kNearest - a.w) / (b.w - a.w));
  if (b.w < kNearest) b = mix(b, a, (kNearest - b.w) / (a.w - b.w));

  vec2 direction = (b.xy / b.w - a.xy / a.w) * viewport;
  float length_px = length(direction);
  direction = length_px > 1e-6 ? direction / length_px : vec2(1, 0);
  vec2 normal = vec2(-direction.y, direction.x);

  vec2 corner = kCorners[gl_VertexID % 6];
  half_width = 0.5 * to.w;
  float across = corner.y * (half_width + 1.0);  // one pixel more for the smooth border
  vec4 position = corner.x == 0.0 ? a : b;
  position.xy += normal * across * 2.0 / viewport * position.w;
  across_w = across * position.w;
  gl_Position = position;
}
