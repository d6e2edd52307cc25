// Frames from text files of particles or boxes. Opening a file reads it once, to count frames and
// bodies; then frames are read individually.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/frame.h"
#include "imports/import_summary.h"
#include "request/reading_options.h"
#include "support/line_reader.h"

namespace broadmark::imports {

/// A body in a frame.
struct TextRow {
  std::int64_t id = 0;  ///< as in the file; without ids: its index in the frame
  Aabb box;
  std::uint64_t line = 0;
  std::optional<std::uint8_t> layer = {};
};

/// One frame of a file.
struct TextFrame {
  std::optional<std::int64_t> number;  ///< if frames are numbered; skipped numbers are empty frames
  std::optional<double> time;          ///< if frames have times
  bool has_ids = true;
  std::vector<TextRow> rows;
};

/// A parallelepiped: a corner, and the three edges from it.
struct Cell {
  std::array<double, 3> origin{};
  std::array<std::array<double, 3>, 3> edges{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
};

/// Reads the frames of files of one format. Files are opened again to read their frames once more,
/// in any order.
class TextFormat {
 public:
  virtual ~TextFormat() = default;

  /// Reads what precedes the first frame of a file. Throws InputError.
  virtual void start(LineReader&) {}
  /// Reads the frame that starts at the next line into an empty TextFrame. Returns false at the end
  /// of the file. Throws InputError.
  virtual bool read(LineReader&, TextFrame&) = 0;
  /// Whether programs keep the order of bodies without ids.
  [[nodiscard]] virtual bool keepsOrder() const { return true; }
  /// What was understood of the frames read so far.
  [[nodiscard]] const ImportSummary& summary() const { return summary_; }
  /// The periodic box that all frames state, if it is asked for.
  [[nodiscard]] PeriodicBox periodic() const { return periodic_.value_or(PeriodicBox()); }

 protected:
  /// `option`: as in ReadingOptions.
  explicit TextFormat(const std::string& periodic_option = "") : option_(periodic_option) {}

  /// Applies the periodic boundaries that a frame states. Throws InputError if they are asked for
  /// but slanted, or others than in the frame before.
  void setPeriodic(const LineReader&, const Cell&, const std::array<bool, 3>& repeats);

  ImportSummary summary_;

 private:
  std::string option_;
  std::optional<PeriodicBox> periodic_;
};

/// Opens the frames of all files, concatenated. Bodies are numbered by ascending id over all files;
/// a body without a row is absent in that frame. Throws InputError, and Cancelled.
std::unique_ptr<IndexedFrames> openTextFrames(const std::vector<std::filesystem::path>& files,
                                              std::unique_ptr<TextFormat> format,
                                              std::string object_type, const ReadingOptions&,
                                              ImportSummary&);

/// The box that contains all points within `half` of the centre, along each axis, rounded outward.
/// Throws InputError if 32-bit floats cannot represent it.
Aabb boxAround(const LineReader&, const std::array<double, 3>& centre,
               const std::array<double, 3>& half);

/// Meaning of the columns of a line that describes a particle, a ball.
struct ParticleColumns {
  std::string_view what;       ///< name for messages: "particle"
  std::string_view no_radius;  ///< error message if neither the file nor the user states a radius
  std::array<std::size_t, 3> position{};
  bool is_scaled = false;  ///< whether positions are multiples of the cell's edges
  /// How often a particle has left the cell along each of its edges, where that is stated.
  std::array<std::optional<std::size_t>, 3> images = {};
  std::optional<std::size_t> id = {};
  std::optional<std::size_t> radius = {};
  bool is_diameter = false;  ///< whether the column `radius` holds diameters
  std::size_t count = 0;     ///< required number of columns
  bool more = false;         ///< whether there may be more columns
};

/// Reads the next `count` lines, one particle each; a `radius` above 0 applies to all. Throws
/// InputError.
void readParticles(LineReader& lines, TextFrame& frame, std::int64_t count,
                   const ParticleColumns& columns, double radius, const Cell& cell = {});

}  // namespace broadmark::imports
