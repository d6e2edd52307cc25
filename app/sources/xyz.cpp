// Particle trajectories in XYZ files: of each frame the number of particles, a comment, and a line
// for each particle: its element and x y z. An extended XYZ file says in its comment, as
// Properties=species:S:1:pos:R:3:radius:R:1, which column is what.

#include <fmt/format.h>

#include "imports/text_frames.h"
#include "sources/source.h"

namespace broadmark::sources::xyz {
namespace {

using imports::LineReader;
using imports::TextFrame;

/// Where in a line things stand.
struct Columns {
  std::size_t position = 1;
  std::optional<std::size_t> radius;
  std::size_t fewest = 4;
};

std::vector<std::string> parts(std::string_view text, char separator) {
  std::vector<std::string> all;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    all.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return all;
}

Columns columnsOf(const LineReader& lines) {
  constexpr std::string_view kKey = "Properties=";
  constexpr std::int64_t kMostColumns = 1000;
  const std::size_t key = lines.line().find(kKey);
  if (key == std::string_view::npos) return {};
  std::string_view text = lines.line().substr(key + kKey.size());
  text = text.substr(0, text.find_first_of(" \t\""));
  const auto words = parts(text, ':');
  Columns columns;
  std::size_t column = 0;
  bool positions = false;
  for (std::size_t i = 0; i + 2 < words.size(); i += 3) {
    const std::int64_t width = lines.integer(words[i + 2], "a number of columns");
    if (width < 1 || width > kMostColumns) lines.fail("Properties: 1 to 1000 columns are expected");
    if (words[i] == "pos" && width == 3) {
      columns.position = column;
      positions = true;
    }
    if (words[i] == "radius" && width == 1) columns.radius = column;
    column += static_cast<std::size_t>(width);
  }
  if (!positions) lines.fail("Properties without the positions: pos:R:3 is expected");
  columns.fewest = column;
  return columns;
}

double radiusIn(const LineReader& lines, const std::vector<std::string_view>& words,
                const Columns& columns, double stated) {
  if (stated > 0) return stated;
  if (!columns.radius) lines.fail("states no radius: say it with --radius");
  const double radius = lines.realNumber(words[*columns.radius], "the radius");
  if (radius < 0) lines.fail(fmt::format("the radius {:g} is negative", radius));
  return radius;
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
  const Columns columns = columnsOf(lines);
  for (std::int64_t id = 0; id < count; ++id) {
    lines.require(fmt::format("particle {} of {}", id + 1, count));
    imports::splitWords(lines.line(), words);
    if (words.size() < columns.fewest) {
      lines.fail(fmt::format("{} columns: {} are expected", words.size(), columns.fewest));
    }
    std::array<double, 3> centre{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      centre[axis] = lines.realNumber(words[columns.position + axis], "a coordinate");
    }
    const double size = radiusIn(lines, words, columns, radius);
    frame.rows.push_back({.id = id, .box = ballBox(lines, centre, size), .line = lines.number()});
  }
  return true;
}

std::unique_ptr<IndexedFrames> open(const std::vector<std::filesystem::path>& files,
                                    const ReadingOptions& options) {
  // A particle is known by its place in the frame: all frames have the same ones.
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
  return std::make_unique<imports::TextFrames>(files, format, "Particles");
}

}  // namespace

SourceKind kind() {
  return {.what = "particles (.xyz)",
          .import = FileImport{.extensions = {".xyz"}, .options = {"radius"}, .open = open}};
}

}  // namespace broadmark::sources::xyz
