// Boxes of a mesh's elements: vertices, edges, triangles.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "broadmark/frame.h"
#include "imports/import_summary.h"
#include "request/reading_options.h"

namespace broadmark::imports {

/// Creates a body for each requested element: vertices in file order, edges sorted by their
/// vertices, then triangles in file order. Pairs of elements that share a vertex are filtered out,
/// unless kept, with vertices as tags. All files must contain the same mesh, each with an animation
/// or a single frame. Throws InputError.
std::unique_ptr<IndexedFrames> openElements(const std::vector<std::filesystem::path>& files,
                                            const ReadingOptions& options, ImportSummary&);

}  // namespace broadmark::imports
