// A box pulled from the texture of primitives, two texels each: 18 vertices, the three faces that look at the eye.
uniform sampler2D primitives;
uniform mat4 view_projection;
uniform vec3 eye;
uniform float pixel;  // length that a pixel covers at distance 1

// The shading of boxes, from shading.h.
uniform vec3 light;             // brightness by the face's axis
uniform float underside;        // brightness of the face that looks down

out vec2 face_uv;          // 0 to 1 across the face; v runs upwards on the sides
flat out vec3 face_colour;
flat out float is_side;    // 1 on the four upright faces, 0 on top and bottom

const vec2 kCorners[6] =
    vec2[](vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 0), vec2(1, 1), vec2(0, 1));

void main() {
  int primitive = gl_VertexID / 18;
  int axis = (gl_VertexID % 18) / 6;
  int per_row = textureSize(primitives, 0).x / 2;
  ivec2 texel = ivec2(2 * (primitive % per_row), primitive / per_row);
  vec4 from = texelFetch(primitives, texel, 0);
  vec4 to = texelFetch(primitives, texel + ivec2(1, 0), 0);

  vec3 centre = 0.5 * (from.xyz + to.xyz);
  float depth = (view_projection * vec4(centre, 1)).w;
  float half_side = 0.5 * to.w * pixel * depth;  // the least
  vec3 low = min(from.xyz, centre - half_side);
  vec3 high = max(to.xyz, centre + half_side);
  if (all(lessThan(low, eye)) && all(lessThan(eye, high))) {
    gl_Position = vec4(0, 0, 2, 1);  // outside the clip volume: one sees out of a box around the eye
    return;
  }

  int rgb = int(from.w);
  vec3 colour = vec3(rgb >> 16, (rgb >> 8) & 255, rgb & 255) / 255.0;

  // Between the planes of an axis the eye sees neither face; then either may be drawn, hidden.
  bool upper = eye[axis] > 0.5 * (low[axis] + high[axis]);

  // u and v are the other two axes; y, where it is one of them, is v.
  ivec2 across = axis == 0 ? ivec2(2, 1) : axis == 1 ? ivec2(0, 2) : ivec2(0, 1);
  face_uv = kCorners[gl_VertexID % 6];
  vec3 point;
  point[axis] = upper ? high[axis] : low[axis];
  point[across.x] = mix(low[across.x], high[across.x], face_uv.x);
  point[across.y] = mix(low[across.y], high[across.y], face_uv.y);

  face_colour = colour * (axis == 1 && !upper ? underside : light[axis]);
  is_side = axis == 1 ? 0.0 : 1.0;
  gl_Position = view_projection * vec4(point, 1);
}
