// The user interface: triangles in pixels from the upper left corner.
uniform vec2 viewport;  // pixels

layout(location = 0) in vec2 position;
layout(location = 1) in vec2 texture_uv;
layout(location = 2) in vec4 vertex_colour;

out vec2 uv;
out vec4 tint;

void main() {
  uv = texture_uv;
  tint = vertex_colour;
  gl_Position = vec4(2.0 * position.x / viewport.x - 1.0, 1.0 - 2.0 * position.y / viewport.y, 0, 1);
}
