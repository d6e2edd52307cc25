// The stb libraries for pictures, compiled once, with no more than we use. (The one for letters is
// Debian's, which Dear ImGui uses, too.)
#define STBI_ONLY_PNG
#define STBI_MAX_DIMENSIONS 32768
#define STBI_NO_STDIO
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>

#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>
