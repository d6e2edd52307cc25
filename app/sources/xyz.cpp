// Particle trajectories in XYZ files: for each frame the number of particles, a comment, and a line
// per particle with its element and x y z. In an extended XYZ file the comment describes the
// columns: Properties=species:S:1:pos:R:3:radius:R:1.

#include <fmt/format.h>

#include "imports/text_frames.h"
#include "sources/source.h"

namespace broadmark::sources::xyz {
namespace {

using imports::LineReader;
using imports::ParticleColumns;
using imports::TextFrame;

ParticleColumns columnsOf(const LineReader& lines) {
  constexpr std::string_view kKey = "Properties=";
  constexpr std::int64_t kMaxColumns = 1000;
  const std::size_t key = lines.line().find(kKey);
  ParticleColumns columns{.what = "particle",
                          .no_radius = "states no radius: set it with --radius",
                          .position = {1, 2, 3},
                          .count = 4};
  if (key == std::string_view::npos) return columns;
  std::string_view text = lines.line().substr(key + kKey.size());
  text = text.substr(0, text.find_first_of(" \t\""));
  std::vector<std::string_view> words;
  imports::splitCells(':', text, words);
  std::size_t column = 0;
  bool positions = false;
  for (std::size_t i = 0; i + 2 < words.size(); i += 3) {
    const std::int64_t width = lines.integer(words[i + 2], "a number of columns");
    if (width < 1 || width > kMaxColumns) lines.fail("Properties: 1 to 1000 columns are expected");
    if (words[i] == "pos" && width == 3) {
      columns.position = {column, column + 1, column + 2};
      positions = true;
    }
    if (words[i] == "radius" && width == 1) columns.radius = column;
    column += static_cast<std::size_t>(width);
  }
  if (!positions) lines.fail("Properties without the positions: pos:R:3 is expected");
  columns.count = column;
  return columns;
}

bool readFrame(LineReader& lines, TextFrame& frame, double radius) {
  do {
    if (!lines.next()) return false;
  } while (imports::isBlank(lines.line()));
  std::vector<std::string_view> words;
  imports::splitWords(lines.line(), words);
  const std::int64_t count = lines.integer(words.front(), "the number of particles");
  if (count < 0) lines.fail("a negative number of particles");
  lines.require("a comment");
  imports::readParticles(lines, frame, count, columnsOf(lines), radius);
  return true;
}

std::unique_ptr<IndexedFrames> open(const std::vector<std::filesystem::path>& files,
                                    const ReadingOptions& options,
                                    imports::ImportSummary& summary) {
  summary.format = "XYZ";
  // Particles are identified by their index, so all frames must have the same number.
  const auto format = [radius = options.radius, particles = std::optional<std::size_t>()](
                          LineReader& lines, TextFrame& frame) mutable {
    if (!readFrame(lines, frame, radius)) return false;
    if (particles && frame.rows.size() != *particles) {
      lines.fail(fmt::format("a frame of {} particles: {} are expected, as before",
                             frame.rows.size(), *particles));
    }
    particles = frame.rows.size();
    return true;
  };
  return imports::openTextFrames(files, format, "Particles");
}

}  // namespace

SourceKind kind() {
  return {.what = "particles (.xyz)",
          .import = FileImport{.extensions = {".xyz"}, .options = {"radius"}, .open = open}};
}

}  // namespace broadmark::sources::xyz
