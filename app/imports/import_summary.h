// What a reader understood of its files.
#pragma once

#include <string>
#include <vector>

namespace broadmark::imports {

/// Filled by readers for the user to check, over all files of a sequence.
struct ImportSummary {
  std::string format;                 ///< "binary PLY, big-endian"
  std::vector<std::string> used;      ///< "columns xu, yu, zu", "animation 'walk'", "units: lj"
  std::vector<std::string> left_out;  ///< recognised, but not in the frames: "a camera"
};

}  // namespace broadmark::imports
