// Frames from text files of particles or boxes. Opening a file reads it once, to count frames and
// bodies; then frames are read individually.
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
  std::int64_t id = 0;  ///< as in the file
  Aabb box;
  std::uint64_t line = 0;
};

/// One frame of a file.
struct TextFrame {
  std::optional<std::int64_t> number;  ///< if frames are numbered; skipped numbers are empty frames
  std::vector<TextRow> rows;
};

/// Reads the frame that starts at the next line into an empty TextFrame. Returns false at the end
/// of the file. Throws InputError.
using TextFormat = std::function<bool(LineReader&, TextFrame&)>;

/// Opens the frames of all files, concatenated. Bodies are numbered by ascending id over all files;
/// a body without a row is absent in that frame. Throws InputError.
std::unique_ptr<IndexedFrames> openTextFrames(const std::vector<std::filesystem::path>& files,
                                              TextFormat format, std::string object_type);

/// Meaning of the columns of a line that describes a particle, a ball.
struct ParticleColumns {
  std::string_view what;       ///< name for messages: "particle"
  std::string_view no_radius;  ///< error message if neither the file nor the user states a radius
  std::array<std::size_t, 3> position{};
  std::optional<std::size_t> id = {};  ///< nothing: particles are numbered in file order
  std::optional<std::size_t> radius = {};
  bool is_diameter = false;  ///< whether the column `radius` holds diameters
  std::size_t count = 0;     ///< required number of columns
  // Positions are relative to this box; by default they are coordinates.
  std::array<double, 3> low{};
  std::array<double, 3> extent = {1, 1, 1};
};

/// Reads the next `count` lines, one particle each; a `radius` above 0 applies to all. Throws
/// InputError, also if 32-bit floats cannot represent the box of a particle.
void readParticles(LineReader& lines, TextFrame& frame, std::int64_t count,
                   const ParticleColumns& columns, double radius);

}  // namespace broadmark::imports
