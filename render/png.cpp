// The stb libraries read and write PNG, without unused formats. (stb_truetype is part of Dear
// ImGui.)
#include <fmt/format.h>
#define STBI_ONLY_PNG
#define STBI_MAX_DIMENSIONS 32768
#define STBI_NO_STDIO
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>
#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "broadmark/render/picture.h"

namespace broadmark {
namespace {

constexpr int kChannels = 4;

std::size_t bytesOf(const Picture& picture) {
  return std::size_t{kChannels} * static_cast<std::size_t>(picture.width) *
         static_cast<std::size_t>(picture.height);
}

}  // namespace

std::string encodePng(const Picture& picture) {
  std::string png;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data),
                                               static_cast<std::size_t>(size));
  };
  const bool has_pixels =
      picture.width > 0 && picture.height > 0 && picture.rgba.size() == bytesOf(picture);
  if (!has_pixels || stbi_write_png_to_func(append, &png, picture.width, picture.height, kChannels,
                                            picture.rgba.data(), picture.width * kChannels) == 0) {
    throw InputError(fmt::format("a picture of {} x {} cannot be written as PNG", picture.width,
                                 picture.height));
  }
  return png;
}

void writePng(const std::filesystem::path& path, const Picture& picture) {
  AtomicFile file(path);
  file.write(encodePng(picture));
  file.commit();
}

Picture readPng(const std::filesystem::path& path) {
  const std::string png = readTextFile(path);
  Picture picture;
  int channels = 0;
  const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
      stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(png.data()),
                            static_cast<int>(png.size()), &picture.width, &picture.height,
                            &channels, kChannels),
      stbi_image_free);
  if (pixels == nullptr) {
    throw InputError(
        fmt::format("{}: not a readable PNG ({})", path.string(), stbi_failure_reason()));
  }
  picture.rgba.assign(pixels.get(), pixels.get() + bytesOf(picture));
  return picture;
}

}  // namespace broadmark
