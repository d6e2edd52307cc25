// Particle trajectories in text dumps of LAMMPS. They consist of sections "ITEM: …"; the last one
// of each frame names the columns and holds a line for each atom, in any order.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "imports/text_frames.h"
#include "sources/source.h"

namespace broadmark::sources::lammps {
namespace {

using imports::addOnce;
using imports::Cell;
using imports::LineReader;
using imports::ParticleColumns;
using imports::TextFrame;

constexpr std::string_view kItem = "ITEM: ";

/// The sections of a frame before the atoms.
struct FrameHeader {
  std::int64_t atoms = -1;  ///< -1: not stated
  std::optional<Cell> cell;
  std::array<bool, 3> repeats{};  ///< periodic boundaries, along each edge of the cell
};

/// Names of columns of positions, the best first: unwrapped ones before those that image flags
/// unwrap.
struct PositionColumns {
  std::array<std::string_view, 3> names;
  bool is_scaled;
  bool is_wrapped;
};
constexpr PositionColumns kPositions[] = {{{"xu", "yu", "zu"}, false, false},
                                          {{"xsu", "ysu", "zsu"}, true, false},
                                          {{"x", "y", "z"}, false, true},
                                          {{"xs", "ys", "zs"}, true, true}};
constexpr std::array<std::string_view, 3> kImages = {"ix", "iy", "iz"};

/// Finds columns by their names.
class ColumnNames {
 public:
  explicit ColumnNames(std::vector<std::string_view> names) : names_(std::move(names)) {}

  [[nodiscard]] std::size_t count() const { return names_.size(); }
  std::optional<std::size_t> use(std::string_view name) {
    const auto found = std::ranges::find(names_, name);
    if (found == names_.end()) return {};
    used_.push_back(name);
    return static_cast<std::size_t>(found - names_.begin());
  }
  /// All or none.
  std::optional<std::array<std::size_t, 3>> use(const std::array<std::string_view, 3>& names) {
    const auto is_there = [&](std::string_view name) {
      return std::ranges::find(names_, name) != names_.end();
    };
    if (!std::ranges::all_of(names, is_there)) return {};
    return std::array{*use(names[0]), *use(names[1]), *use(names[2])};
  }
  /// A name of two columns.
  [[nodiscard]] std::optional<std::string_view> twice() const {
    std::vector<std::string_view> sorted = names_;
    std::ranges::sort(sorted);
    const auto found = std::ranges::adjacent_find(sorted);
    if (found == sorted.end()) return {};
    return *found;
  }
  [[nodiscard]] const std::vector<std::string_view>& used() const { return used_; }
  [[nodiscard]] std::vector<std::string_view> unused() const {
    std::vector<std::string_view> unused = names_;
    std::erase_if(unused, [&](std::string_view name) {
      // These tell what an atom is, not where.
      return name == "type" || name == "element" || std::ranges::find(used_, name) != used_.end();
    });
    return unused;
  }

 private:
  std::vector<std::string_view> names_;
  std::vector<std::string_view> used_;
};

/// Sets the columns of positions and image flags.
void setPositions(const LineReader& lines, ColumnNames& names, const FrameHeader& header,
                  ParticleColumns& columns) {
  for (const PositionColumns& positions : kPositions) {
    const auto found = names.use(positions.names);
    if (!found) continue;
    columns.position = *found;
    columns.is_scaled = positions.is_scaled;
    bool has_images = false;
    for (std::size_t axis = 0; axis < 3 && positions.is_wrapped; ++axis) {
      columns.images[axis] = names.use(kImages[axis]);
      has_images |= columns.images[axis].has_value();
    }
    if ((columns.is_scaled || has_images) && !header.cell) {
      lines.fail("scaled positions and image flags need the box: 'ITEM: BOX BOUNDS' is expected");
    }
    return;
  }
  lines.fail("no position columns: 'x y z', 'xu yu zu', 'xs ys zs' or 'xsu ysu zsu' is expected");
}

ParticleColumns columnsOf(const LineReader& lines, ColumnNames& names, const FrameHeader& header,
                          double radius) {
  ParticleColumns columns{.what = "atom",
                          .no_radius = "no column 'radius' or 'diameter': set it with --radius",
                          .id = names.use("id"),
                          .count = names.count()};
  if (const auto twice = names.twice()) {
    lines.fail(fmt::format("two columns {}", imports::quoted(*twice)));
  }
  setPositions(lines, names, header, columns);
  if (radius > 0) return columns;
  columns.radius = names.use("radius");
  if (!columns.radius) {
    columns.radius = names.use("diameter");
    columns.is_diameter = columns.radius.has_value();
  }
  return columns;
}

/// Reads the next line as numbers, at least `count` of them.
std::vector<double> boundsIn(LineReader& lines, std::size_t count) {
  lines.require("the bounds of the box");
  std::vector<std::string_view> words;
  imports::splitWords(lines.line(), words);
  if (words.size() != count) {
    lines.fail(fmt::format("{} bounds of the box: {} are expected", words.size(), count));
  }
  std::vector<double> numbers;
  for (const std::string_view word : words) {
    numbers.push_back(lines.realNumber(word, "a bound of the box"));
  }
  return numbers;
}

/// Reads a box given by three edges and a corner: "ax ay az x", …
Cell generalCell(LineReader& lines) {
  Cell cell;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::vector<double> numbers = boundsIn(lines, 4);
    std::copy_n(numbers.begin(), 3, cell.edges[i].begin());
    cell.origin[i] = numbers[3];
  }
  return cell;
}

/// Reads a cuboid's bounds, or, of a slanted box, those of the cuboid around it, and its tilts.
Cell boundedCell(LineReader& lines, bool is_slanted) {
  std::array<std::vector<double>, 3> bounds;
  for (auto& numbers : bounds) numbers = boundsIn(lines, is_slanted ? 3 : 2);
  const double xy = is_slanted ? bounds[0][2] : 0;
  const double xz = is_slanted ? bounds[1][2] : 0;
  const double yz = is_slanted ? bounds[2][2] : 0;
  const auto [x_low, x_high] = std::minmax({0.0, xy, xz, xy + xz});
  const auto [y_low, y_high] = std::minmax({0.0, yz});
  const std::array<double, 3> low = {bounds[0][0] - x_low, bounds[1][0] - y_low, bounds[2][0]};
  const std::array<double, 3> high = {bounds[0][1] - x_high, bounds[1][1] - y_high, bounds[2][1]};
  return {
      .origin = low,
      .edges = {{{high[0] - low[0], 0, 0}, {xy, high[1] - low[1], 0}, {xz, yz, high[2] - low[2]}}}};
}

class DumpFormat final : public imports::TextFormat {
 public:
  explicit DumpFormat(const ReadingOptions& options)
      : TextFormat(options.periodic), radius_(options.radius) {}

  [[nodiscard]] bool keepsOrder() const override { return false; }

  bool read(LineReader& lines, TextFrame& frame) override {
    FrameHeader header;
    if (!readHeader(lines, header)) return false;
    const std::string names_line(lines.line());
    std::vector<std::string_view> words;
    imports::splitWords(names_line, words);
    words.erase(words.begin(), words.begin() + 2);
    ColumnNames names(words);
    const ParticleColumns columns = columnsOf(lines, names, header, radius_);
    if (names_line != described_) describe(names, names_line);
    setPeriodic(lines, header.cell.value_or(Cell()), header.repeats);
    imports::readParticles(lines, frame, header.atoms, columns, radius_,
                           header.cell.value_or(Cell()));
    return true;
  }

 private:
  void describe(const ColumnNames& names, const std::string& line) {
    described_ = line;
    addOnce(summary_.used, fmt::format("columns {}", fmt::join(names.used(), ", ")));
    if (const auto unused = names.unused(); !unused.empty()) {
      addOnce(summary_.left_out, fmt::format("columns {}", fmt::join(unused, ", ")));
    }
  }

  /// Reads the sections before the atoms, up to the line with the names of the atoms' columns.
  /// Returns false at the end of the file.
  bool readHeader(LineReader& lines, FrameHeader& header) {
    do {
      if (!lines.next()) return false;
    } while (imports::isBlank(lines.line()));
    while (true) {
      if (!lines.line().starts_with(kItem)) lines.fail("'ITEM: …' is expected");
      const std::string item(imports::trimmed(lines.line().substr(kItem.size())));
      if (item == "ATOMS" || item.starts_with("ATOMS ")) break;
      readSection(lines, item, header);
      lines.require("'ITEM: ATOMS'");
    }
    if (header.atoms < 0) lines.fail("'ITEM: NUMBER OF ATOMS' is expected before the atoms");
    return true;
  }

  void readSection(LineReader& lines, const std::string& item, FrameHeader& header) {
    if (item.starts_with("BOX BOUNDS")) {
      readBounds(lines, item.substr(std::string_view("BOX BOUNDS").size()), header);
    } else if (item == "NUMBER OF ATOMS") {
      lines.require("a number of atoms");
      header.atoms = lines.integer(imports::trimmed(lines.line()), "the number of atoms");
      if (header.atoms < 0) lines.fail("a negative number of atoms");
    } else if (item == "UNITS") {
      lines.require("units");
      summary_.units = imports::trimmed(lines.line());
    } else if (item == "TIMESTEP" || item == "TIME") {
      lines.require("a value");
    } else {
      lines.fail(
          fmt::format("ITEM: {} is not read: TIMESTEP, TIME, UNITS, NUMBER OF ATOMS, BOX "
                      "BOUNDS or ATOMS is expected",
                      imports::quoted(item)));
    }
  }

  /// The words behind "BOX BOUNDS" name the form of the box, and its boundaries: "pp", "ff".
  static void readBounds(LineReader& lines, std::string_view form, FrameHeader& header) {
    std::vector<std::string_view> words;
    imports::splitWords(form, words);
    const auto starts_with = [&](std::initializer_list<std::string_view> start) {
      const bool found =
          words.size() >= start.size() && std::equal(start.begin(), start.end(), words.begin());
      if (found) words.erase(words.begin(), words.begin() + std::ssize(start));
      return found;
    };
    const bool is_general = starts_with({"abc", "origin"});
    const bool is_slanted = !is_general && starts_with({"xy", "xz", "yz"});
    for (const std::string_view word : words) {
      if (word.size() <= 2 && word.find_first_not_of("pfsm") == std::string_view::npos) continue;
      lines.fail(
          fmt::format("BOX BOUNDS {}: 'xy xz yz', 'abc origin' or boundaries like 'pp' are "
                      "expected",
                      imports::quoted(word)));
    }
    for (std::size_t axis = 0; axis < std::min<std::size_t>(words.size(), 3); ++axis) {
      header.repeats[axis] = words[axis].starts_with('p');
    }
    header.cell = is_general ? generalCell(lines) : boundedCell(lines, is_slanted);
  }

  double radius_;
  std::string described_;  ///< line with the names of columns
};

bool recognises(const imports::FileStart& start) {
  const std::size_t begin = std::min(start.text.find_first_not_of(" \t\r\n"), start.text.size());
  return std::string_view(start.text).substr(begin).starts_with(kItem);
}

std::unique_ptr<IndexedFrames> open(const std::vector<std::filesystem::path>& files,
                                    const ReadingOptions& options,
                                    imports::ImportSummary& summary) {
  summary.format = "LAMMPS dump";
  return imports::openTextFrames(files, std::make_unique<DumpFormat>(options), "Particles", options,
                                 summary);
}

}  // namespace

SourceKind kind() {
  return {.what = "LAMMPS dumps (.dump, .lammpstrj)",
          .import = FileImport{.formats = {"lammps"},
                               .extensions = {".dump", ".lammpstrj", ".lammpsdump"},
                               .options = {"radius", "periodic"},
                               .recognises = recognises,
                               .open = open}};
}

}  // namespace broadmark::sources::lammps
