#include "imports/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "broadmark/error.h"
#include "imports/files.h"

namespace broadmark::imports {

const std::vector<std::string>& meshExtensions() {
  static const std::vector<std::string> extensions = {".ply", ".obj", ".stl", ".gltf", ".glb"};
  return extensions;
}

MeshTopology readMesh(const std::filesystem::path& file, double frame_rate, const PointSink& sink) {
  const PointSink checked = [&](std::span<const Point> points) {
    const auto broken = std::ranges::find_if(points, [](const Point& point) {
      return !std::ranges::all_of(point, [](float value) { return std::isfinite(value); });
    });
    if (broken != points.end()) {
      throw InputError(fmt::format("{}: vertex {} has a coordinate that is no finite 32-bit float",
                                   file.string(), broken - points.begin()));
    }
    sink(points);
  };
  return hasExtension(file, {".obj"}) ? readObj(file, checked)
                                      : readWithAssimp(file, frame_rate, checked);
}

}  // namespace broadmark::imports
