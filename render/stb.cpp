// The stb libraries that read and write PNG, with nothing that we do not use. (stb_truetype comes
// with Dear ImGui.)
#define STBI_ONLY_PNG
#define STBI_MAX_DIMENSIONS 32768
#define STBI_NO_STDIO
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>

#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>
