#version 330 core
// A box pulled from the buffer texture: 18 vertices, the three faces that look at the eye.
uniform samplerBuffer primitives;
uniform mat4 view_projection;
uniform vec3 eye;
uniform float focus;  // distance from the eye to what it looks at

out vec2 face_uv;          // 0 to 1 across the face; v runs upwards on the sides
flat out vec3 face_colour;
flat out float is_side;    // 1 on the four upright faces, 0 on top and bottom
out float far_away;        // 0 before the scene, 1 behind it

const vec2 kCorners[6] =
    vec2[](vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 0), vec2(1, 1), vec2(0, 1));
// Brightness by the face's axis: a light from above, a little more from z than from x.
const vec3 kLight = vec3(0.79, 1.0, 0.91);
const float kUnderside = 0.55;

void main() {
  int primitive = gl_VertexID / 18;
  int axis = (gl_VertexID % 18) / 6;
  vec4 low = texelFetch(primitives, 2 * primitive);
  vec4 high = texelFetch(primitives, 2 * primitive + 1);

  int rgb = int(low.w);
  vec3 colour = vec3(rgb >> 16, (rgb >> 8) & 255, rgb & 255) / 255.0;

  // Between the planes of an axis the eye sees neither face; then either may be drawn, hidden.
  bool upper = eye[axis] > 0.5 * (low[axis] + high[axis]);
  float light = axis == 1 && !upper ? kUnderside : kLight[axis];

  // u and v are the other two axes; y, where it is one of them, is v.
  ivec2 across = axis == 0 ? ivec2(2, 1) : axis == 1 ? ivec2(0, 2) : ivec2(0, 1);
  face_uv = kCorners[gl_VertexID % 6];
  vec3 point;
  point[axis] = upper ? high[axis] : low[axis];
  point[across.x] = mix(low[across.x], high[across.x], face_uv.x);
  point[across.y] = mix(low[across.y], high[across.y], face_uv.y);

  face_colour = colour * light;
  is_side = axis == 1 ? 0.0 : 1.0;
  far_away = smoothstep(focus - 0.8, focus + 0.9, distance(eye, point));
  gl_Position = view_projection * vec4(point, 1);
}
