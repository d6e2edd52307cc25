// Covers the pixel as far as the line does.
uniform float opacity;

in float across_w;
flat in float half_width;
flat in vec3 line_colour;
out vec4 colour;

void main() {
  float across = across_w * gl_FragCoord.w;
  colour = vec4(line_colour, opacity * clamp(half_width + 0.5 - abs(across), 0.0, 1.0));
}
