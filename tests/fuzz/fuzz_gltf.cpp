// Any bytes as a glTF file, as text or binary.

#include "import_through.h"
#include "imports/mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace broadmark::imports;
  broadmark::fuzz::withFile(data, size, [](const std::filesystem::path& path) {
    constexpr std::size_t kEnough = 1 << 20;
    constexpr std::uint64_t kSpareBytes = 64 << 20;
    broadmark::ReadingOptions options;
    options.frame_rate = 1;
    ImportSummary summary;
    std::size_t points = 0;
    std::size_t all_points = 0;
    const auto count = [&](std::span<const Point> frame) {
      points = frame.size();
      all_points += points;
      // A file of a few bytes may have a million frames.
      if (all_points > kEnough) throw broadmark::InputError("enough");
    };
    const MeshTopology mesh = readGltf(path, options, count, summary, kSpareBytes);
    if (mesh.vertices != points) std::abort();
    const auto require = [&](const auto& elements) {
      for (const auto& element : elements) {
        for (const std::uint32_t vertex : element) {
          if (vertex >= points) std::abort();
        }
      }
    };
    require(mesh.triangles);
    require(mesh.lines);
  });
  return 0;
}
