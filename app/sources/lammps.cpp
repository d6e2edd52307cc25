// Particle trajectories in text dumps of LAMMPS. They consist of sections "ITEM: …"; the last one
// of each frame names the columns and holds a line for each atom, in any order.

#include <algorithm>

#include "imports/text_frames.h"
#include "sources/source.h"

namespace broadmark::sources::lammps {
namespace {

using imports::LineReader;
using imports::ParticleColumns;
using imports::TextFrame;

constexpr std::string_view kItem = "ITEM: ";

/// The sections of a frame before the atoms.
struct FrameHeader {
  std::int64_t atoms = -1;  ///< -1: not stated
  std::array<double, 3> low{};
  std::array<double, 3> high{};
  bool has_bounds = false;    ///< low and high are stated
  bool is_triclinic = false;  ///< the box is not a cuboid
};

ParticleColumns columnsOf(const LineReader& lines, const std::vector<std::string_view>& names,
                          const FrameHeader& header) {
  const auto find = [&](std::string_view name) -> std::optional<std::size_t> {
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) return {};
    return static_cast<std::size_t>(found - names.begin());
  };
  ParticleColumns columns{.what = "atom",
                          .no_radius = "no column 'radius' or 'diameter': set it with --radius",
                          .id = find("id"),
                          .radius = find("radius"),
                          .count = names.size()};
  if (!columns.radius) {
    columns.radius = find("diameter");
    columns.is_diameter = columns.radius.has_value();
  }
  struct CoordinateColumns {
    std::array<std::string_view, 3> names;
    bool scaled;
  };
  constexpr CoordinateColumns kColumns[] = {{{"x", "y", "z"}, false},
                                            {{"xu", "yu", "zu"}, false},
                                            {{"xs", "ys", "zs"}, true},
                                            {{"xsu", "ysu", "zsu"}, true}};
  for (const CoordinateColumns& coordinates : kColumns) {
    const auto x = find(coordinates.names[0]);
    const auto y = find(coordinates.names[1]);
    const auto z = find(coordinates.names[2]);
    if (!x || !y || !z) continue;
    columns.position = {*x, *y, *z};
    if (!coordinates.scaled) return columns;
    if (!header.has_bounds || header.is_triclinic) {
      lines.fail("scaled positions need a cuboid box ('ITEM: BOX BOUNDS'): dump x y z");
    }
    columns.low = header.low;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      columns.extent[axis] = header.high[axis] - header.low[axis];
    }
    return columns;
  }
  lines.fail("no position columns: 'x y z', 'xu yu zu' or 'xs ys zs' is expected");
}

void readBounds(LineReader& lines, FrameHeader& header) {
  std::vector<std::string_view> words;
  imports::splitWords(lines.line(), words);
  header.is_triclinic = std::ranges::find(words, "xy") != words.end();
  header.has_bounds = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lines.require("the bounds of the box");
    imports::splitWords(lines.line(), words);
    if (words.size() < 2) lines.fail("two bounds of the box are expected");
    header.low[axis] = lines.realNumber(words[0], "a bound of the box");
    header.high[axis] = lines.realNumber(words[1], "a bound of the box");
  }
}

/// Reads the sections before the atoms, up to the line with the names of the atoms' columns.
/// Returns false at the end of the file.
bool readHeader(LineReader& lines, FrameHeader& header) {
  for (bool first = true; lines.next(); first = false) {
    const std::string_view line = lines.line();
    if (first && imports::isBlank(line)) {
      first = true;
      continue;
    }
    if (!line.starts_with(kItem)) lines.fail("'ITEM: …' is expected");
    const std::string_view item = line.substr(kItem.size());
    if (item.starts_with("ATOMS")) {
      if (header.atoms < 0) lines.fail("'ITEM: NUMBER OF ATOMS' is expected before the atoms");
      return true;
    }
    if (item.starts_with("BOX BOUNDS")) {
      readBounds(lines, header);
    } else if (item.starts_with("NUMBER OF ATOMS")) {
      lines.require("a number of atoms");
      header.atoms = lines.integer(lines.line(), "the number of atoms");
      if (header.atoms < 0) lines.fail("a negative number of atoms");
    } else if (item.starts_with("TIMESTEP") || item.starts_with("UNITS") ||
               item.starts_with("TIME")) {
      lines.require("a value");
    } else {
      lines.fail("an unknown ITEM: TIMESTEP, NUMBER OF ATOMS, BOX BOUNDS or ATOMS is expected");
    }
  }
  if (header.atoms >= 0) lines.require("'ITEM: ATOMS'");
  return false;
}

bool readFrame(LineReader& lines, TextFrame& frame, double radius) {
  FrameHeader header;
  if (!readHeader(lines, header)) return false;
  std::vector<std::string_view> words;
  const std::string names(lines.line().substr(kItem.size()));
  imports::splitWords(names, words);
  words.erase(words.begin());
  const ParticleColumns columns = columnsOf(lines, words, header);
  imports::readParticles(lines, frame, header.atoms, columns, radius);
  return true;
}

std::unique_ptr<IndexedFrames> open(const std::vector<std::filesystem::path>& files,
                                    const ReadingOptions& options,
                                    imports::ImportSummary& summary) {
  summary.format = "LAMMPS dump";
  const auto format = [radius = options.radius](LineReader& lines, TextFrame& frame) {
    return readFrame(lines, frame, radius);
  };
  return imports::openTextFrames(files, format, "Particles");
}

}  // namespace

SourceKind kind() {
  return {.what = "LAMMPS dumps (.lammpstrj, .dump)",
          .import = FileImport{
              .extensions = {".lammpstrj", ".dump"}, .options = {"radius"}, .open = open}};
}

}  // namespace broadmark::sources::lammps
