// Any bytes as an OBJ file.

#include "import_through.h"
#include "imports/mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace broadmark::imports;
  broadmark::fuzz::withFile(data, size, [](const std::filesystem::path& path) {
    std::size_t points = 0;
    ImportSummary summary;
    const auto count = [&](std::span<const Point> frame) { points = frame.size(); };
    const MeshTopology mesh = readObj(path, count, summary);
    if (mesh.vertices != points) std::abort();
    for (const Triangle& triangle : mesh.triangles) {
      for (const std::uint32_t vertex : triangle) {
        if (vertex >= points) std::abort();
      }
    }
  });
  return 0;
}
