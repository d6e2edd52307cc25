uniform sampler2D image;  // letters, or a picture

in vec2 uv;
in vec4 tint;
out vec4 colour;

void main() { colour = tint * texture(image, uv); }
