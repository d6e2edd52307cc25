// Meshes, one file a frame or an animation in one file, as boxes of their elements.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "imports/element_frames.h"
#include "sources/source.h"

namespace broadmark::sources::meshes {
namespace {

std::unique_ptr<IndexedFrames> open(const std::vector<std::filesystem::path>& files,
                                    const ReadingOptions& options) {
  return std::make_unique<imports::ElementFrames>(files, options);
}

}  // namespace

SourceKind kind() {
  return {.what = fmt::format("meshes ({}), also as animations",
                              fmt::join(imports::meshExtensions(), ", ")),
          .import = FileImport{.extensions = imports::meshExtensions(),
                               .options = {"elements", "keep", "frame_rate"},
                               .open = open}};
}

}  // namespace broadmark::sources::meshes
