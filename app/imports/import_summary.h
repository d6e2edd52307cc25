// What a reader understood of its files.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace broadmark::imports {

/// Filled by readers for the user to check, over all files of a sequence.
struct ImportSummary {
  std::string format;                 ///< "binary PLY, big-endian"
  std::string units;                  ///< of lengths, as the file says; "": it does not
  std::vector<std::string> used;      ///< "columns xu, yu, zu", "animation 'walk'"
  std::vector<std::string> left_out;  ///< recognised, but not in the frames: "a camera"
  std::vector<std::string> warnings;  ///< what may be wrong: "atoms without ids: …"
};

/// Adds a text that is not in the list yet.
inline void addOnce(std::vector<std::string>& texts, std::string text) {
  if (std::ranges::find(texts, text) == texts.end()) texts.push_back(std::move(text));
}

}  // namespace broadmark::imports
