// The boxes of a mesh's elements: its vertices, its edges, its triangles.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "broadmark/frame.h"
#include "request/reading_options.h"

namespace broadmark::imports {

/// A body for each element: vertices in the order of the file, then edges in the order of their
/// vertices, then triangles in the order of the file, as far as they are asked for. Elements that
/// share a vertex are not wanted as a pair, unless they are to be kept: the vertices are tags. All
/// files are the same mesh, each with the frames of its animation or only one. Throws InputError.
std::unique_ptr<IndexedFrames> openElements(const std::vector<std::filesystem::path>& files,
                                            const ReadingOptions& options);

}  // namespace broadmark::imports
