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
/// unless kept, with vertices as tags. A file with the same topology as another one has the same
/// bodies, and one that only adds to the file before continues its bodies; another mesh has bodies
/// of its own. Bodies of other meshes are absent. Throws InputError.
std::unique_ptr<IndexedFrames> openElements(const std::vector<std::filesystem::path>& files,
                                            const ReadingOptions& options, ImportSummary&);

}  // namespace broadmark::imports
