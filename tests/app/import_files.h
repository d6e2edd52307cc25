// Files of other programs, and helpers that read them.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/files.h"
#include "broadmark/recordings/adapted_frames.h"
#include "engine/helpers.h"
#include "sources/make_source.h"

namespace broadmark::tests {

/// The frames of the source `name`, read with these options.
inline std::unique_ptr<IndexedFrames> importFrom(const std::filesystem::path& name,
                                                 const ParameterValues& options = {}) {
  ReadingOptions reading;
  setParameters(reading, options);
  const auto import = importOf(name.string());
  if (!import) throw std::logic_error("not of a kind that is imported");
  return importedSource({name.string()}, *import, reading).imported;
}

/// A box from its corners.
inline Aabb boxOf(std::array<float, 3> min, std::array<float, 3> max) {
  return {{min[0], min[1], min[2], 0}, {max[0], max[1], max[2], 0}};
}

/// The boxes of one frame, as a list.
inline std::vector<Aabb> boxesOf(IndexedFrames& frames, std::uint32_t index) {
  const Frame frame = frames.at(index);
  return {frame.boxes.begin(), frame.boxes.end()};
}

/// The number of overlapping pairs in a frame, and of those that pass the filter.
struct PairCounts {
  std::size_t overlapping = 0;
  std::size_t wanted = 0;

  friend bool operator==(const PairCounts&, const PairCounts&) = default;
};
inline PairCounts pairsIn(IndexedFrames& frames, std::uint32_t index) {
  const auto boxes = boxesOf(frames, index);
  PairCounts counts;
  for (std::uint32_t b = 0; b < boxes.size(); ++b) {
    for (std::uint32_t a = 0; a < b; ++a) {
      if (!overlaps(boxes[a], boxes[b])) continue;
      ++counts.overlapping;
      if (frames.scene().filter.wanted(a, b)) ++counts.wanted;
    }
  }
  return counts;
}

class Imports : public testing::Test {
 protected:
  /// A file with this text.
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    const auto path = directory_ / name;
    std::filesystem::create_directories(path.parent_path());
    writeTextFile(path, text);
    return path;
  }
  /// The frames of a file with this text.
  [[nodiscard]] std::unique_ptr<IndexedFrames> read(const std::string& name,
                                                    const std::string& text,
                                                    const ParameterValues& options = {}) const {
    return importFrom(write(name, text), options);
  }
  /// The error message for a file with this text.
  [[nodiscard]] std::string complaint(const std::string& name, const std::string& text,
                                      const ParameterValues& options = {}) const {
    const auto path = write(name, text);
    return inputErrorOf([&] { importFrom(path, options); });
  }

  TemporaryDirectory directory_;
};

}  // namespace broadmark::tests
