// What every reader of meshes promises: any bytes are either a mesh whose faces and lines have
// vertices that exist, or an InputError.
#pragma once

#include <algorithm>

#include "import_through.h"
#include "imports/mesh.h"

namespace broadmark::fuzz {

using MeshReader = imports::MeshTopology(const std::filesystem::path&, const imports::PointSink&,
                                         imports::ImportSummary&);

inline void meshThrough(MeshReader& reader, const std::uint8_t* data, std::size_t size) {
  using namespace imports;
  withFile(data, size, [&](const std::filesystem::path& path) {
    std::size_t points = 0;
    ImportSummary summary;
    const auto count = [&](std::span<const Point> frame) { points = frame.size(); };
    const MeshTopology mesh = reader(path, count, summary);
    const auto exists = [&](std::uint32_t vertex) { return vertex < points; };
    const auto all_exist = [&](const auto& vertices) {
      return std::ranges::all_of(vertices, exists);
    };
    if (mesh.vertices != points || summary.format.empty()) std::abort();
    if (!std::ranges::all_of(mesh.triangles, all_exist)) std::abort();
    if (!std::ranges::all_of(mesh.lines, all_exist)) std::abort();
  });
}

}  // namespace broadmark::fuzz
