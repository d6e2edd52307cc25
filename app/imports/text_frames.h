// Frames from text files of particles or boxes. A file is read once when it is opened, to learn how
// many frames and bodies there are; then frame by frame.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/frame.h"
#include "imports/line_reader.h"

namespace broadmark::imports {

/// A body in a frame.
struct TextRow {
  std::int64_t id = 0;  ///< whatever the file calls it
  Aabb box;
  std::uint64_t line = 0;
};

/// One frame as it stands in a file.
struct TextFrame {
  std::optional<std::int64_t> number;  ///< if the file numbers them; those left out are empty
  std::vector<TextRow> rows;
};

/// Reads the frame that begins with the next line into a frame that is empty; false at the end of
/// the file. Throws InputError.
using TextFormat = std::function<bool(LineReader&, TextFrame&)>;

/// Frames of all files, one after the other. Bodies are numbered in the order of their ids, over
/// all files; one without a row in a frame is absent in it. Throws InputError.
std::unique_ptr<IndexedFrames> openTextFrames(const std::vector<std::filesystem::path>& files,
                                              TextFormat format, std::string object_type);

/// Which columns of a line are what of a particle, a ball.
struct ParticleColumns {
  std::string_view what;       ///< "particle", in messages
  std::string_view no_radius;  ///< the complaint where neither the file nor the user states one
  std::array<std::size_t, 3> position{};
  std::optional<std::size_t> id = {};  ///< nothing: particles are numbered as they stand
  std::optional<std::size_t> radius = {};
  bool is_diameter = false;  ///< that column holds diameters
  std::size_t count = 0;
  // Positions are shares of this box; by default they are coordinates.
  std::array<double, 3> low{};
  std::array<double, 3> extent = {1, 1, 1};
};

/// Reads the next `count` lines, a particle each; a `radius` above 0 is that of all. Throws
/// InputError, also when 32-bit floats cannot hold the box of a particle.
void readParticles(LineReader& lines, TextFrame& frame, std::int64_t count,
                   const ParticleColumns& columns, double radius);

}  // namespace broadmark::imports
