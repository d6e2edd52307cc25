// Particle trajectories in XYZ files: for each frame the number of particles, a comment, and a line
// per particle with its element and x y z. In an extended XYZ file the comment holds keys and
// values, and describes the columns: Properties=species:S:1:pos:R:3:radius:R:1.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <set>

#include "imports/text_frames.h"
#include "sources/source.h"

namespace broadmark::sources::xyz {
namespace {

using imports::addOnce;
using imports::Cell;
using imports::LineReader;
using imports::ParticleColumns;
using imports::TextFrame;

/// A key or value and the text behind it. It is quoted, in brackets, or a word.
struct Token {
  std::string_view text;
  std::string_view rest;
};
Token tokenOf(std::string_view text, std::string_view ends) {
  constexpr std::string_view kOpening = "\"'{[";
  constexpr std::string_view kClosing = "\"'}]";
  const std::size_t bracket = kOpening.find(text.front());
  int depth = 0;
  for (std::size_t i = 0; bracket != std::string_view::npos && i < text.size(); ++i) {
    if (text[i] == '\\') {
      ++i;  // the next character is a part of the text
    } else if (i > 0 && text[i] == kClosing[bracket]) {
      if (--depth == 0) return {text.substr(1, i - 1), text.substr(i + 1)};
    } else if (text[i] == kOpening[bracket]) {
      ++depth;
    }
  }
  const std::size_t end = std::min(text.find_first_of(ends), text.size());
  return {text.substr(0, end), text.substr(end)};
}

using Values = std::map<std::string, std::string>;

/// The keys of a comment in lower case, and their values. A comment may be any text.
Values valuesIn(std::string_view comment) {
  Values values;
  std::string_view rest = imports::trimmed(comment);
  while (!rest.empty()) {
    const Token key = tokenOf(rest, " \t=");
    rest = imports::trimmed(key.rest);
    if (!rest.starts_with('=')) continue;
    rest = imports::trimmed(rest.substr(1));
    if (rest.empty()) break;
    const Token value = tokenOf(rest, " \t");
    values.try_emplace(imports::lowered(key.text), value.text);
    rest = imports::trimmed(value.rest);
  }
  return values;
}

/// Whether a comment states columns, even in text that is quoted as a whole.
bool statesProperties(std::string_view comment) {
  const std::string text = imports::lowered(comment);
  const std::size_t key = text.find("properties");
  return key != std::string::npos &&
         imports::trimmed(std::string_view(text).substr(key + 10)).starts_with('=');
}

/// Columns of plain XYZ: element x y z.
ParticleColumns plainColumns() {
  return {.what = "particle",
          .no_radius = "states no radius: set it with --radius",
          .position = {1, 2, 3},
          .count = 4,
          .more = true};
}

class XyzFormat final : public imports::TextFormat {
 public:
  explicit XyzFormat(const ReadingOptions& options)
      : TextFormat(options.periodic),
        radius_(options.radius),
        is_periodic_(options.periodic == kStatedPeriodicBox) {}

  bool read(LineReader& lines, TextFrame& frame) override {
    do {
      if (!lines.next()) return false;
    } while (imports::isBlank(lines.line()));
    const std::int64_t count =
        lines.integer(imports::trimmed(lines.line()), "the number of particles");
    if (count < 0) lines.fail("a negative number of particles");
    lines.require("a comment");
    describe(lines);
    imports::readParticles(lines, frame, count, columns_, radius_);
    if (columns_.more && count > 0) describeMore(lines);
    return true;
  }

 private:
  /// Applies a frame's comment.
  void describe(const LineReader& lines) {
    if (is_described_ && lines.line() == comment_) return;
    is_described_ = true;
    comment_ = lines.line();
    const auto values = valuesIn(comment_);
    const auto properties = values.find("properties");
    if (properties == values.end()) {
      if (statesProperties(comment_)) {
        lines.fail("Properties must be a key of its own, not part of another value");
      }
      columns_ = plainColumns();
      addOnce(summary_.used, "columns 2 to 4 as x, y, z");
    } else {
      setColumns(lines, properties->second);
    }
    const auto lattice = values.find("lattice");
    if (lattice != values.end() && !has_lattice_) {
      has_lattice_ = true;
      addOnce(summary_.used, "lattice " + lattice->second);
    }
    describeBoundaries(lines, values);
  }

  void describeBoundaries(const LineReader& lines, const Values& values) {
    const auto lattice = values.find("lattice");
    const auto boundaries = values.find("pbc");
    std::array<bool, 3> repeats{};
    if (boundaries != values.end()) {
      std::vector<std::string_view> words;
      imports::splitWords(boundaries->second, words);
      for (std::size_t axis = 0; axis < 3 && !words.empty(); ++axis) {
        // One word may stand for all axes.
        repeats[axis] = words[std::min(axis, words.size() - 1)].find_first_of("Tt1") == 0;
      }
    } else if (is_periodic_ && lattice != values.end()) {
      repeats.fill(true);  // a lattice alone means boundaries that are all periodic
    }
    Cell cell;
    if (is_periodic_ && std::ranges::count(repeats, true) > 0) {
      if (lattice == values.end()) lines.fail("--periodic: pbc needs a Lattice");
      const std::vector<double> edges = numbersIn(lines, *lattice, 9);
      for (std::size_t i = 0; i < 9; ++i) cell.edges[i / 3][i % 3] = edges[i];
      if (const auto origin = values.find("origin"); origin != values.end()) {
        std::ranges::copy(numbersIn(lines, *origin, 3), cell.origin.begin());
      }
    }
    setPeriodic(lines, cell, repeats);
  }

  static std::vector<double> numbersIn(const LineReader& lines, const Values::value_type& value,
                                       std::size_t count) {
    std::vector<std::string_view> words;
    imports::splitWords(value.second, words);
    if (words.size() != count) {
      lines.fail(
          fmt::format("{}: {} numbers are expected, not {}", value.first, count, words.size()));
    }
    std::vector<double> numbers;
    for (const std::string_view word : words)
      numbers.push_back(lines.realNumber(word, value.first));
    return numbers;
  }

  /// Finds the columns in "NAME:TYPE:WIDTH:…".
  void setColumns(const LineReader& lines, std::string_view properties) {
    constexpr std::int64_t kMaxColumns = 1000;
    std::vector<std::string_view> words;
    imports::splitCells(':', properties, words);
    if (words.size() % 3 != 0) {
      lines.fail(fmt::format("Properties={}: NAME:TYPE:COLUMNS for each is expected",
                             imports::quoted(properties)));
    }
    columns_ = plainColumns();
    columns_.more = false;
    columns_.count = 0;
    bool positions = false;
    std::set<std::string> names;
    std::vector<std::string> unused;
    for (std::size_t i = 0; i < words.size(); i += 3) {
      const std::string name = imports::lowered(words[i]);
      const std::int64_t width = lines.integer(words[i + 2], "a number of columns");
      if (width < 1 || width > kMaxColumns) {
        lines.fail("Properties: 1 to 1000 columns are expected");
      }
      const std::size_t column = columns_.count;
      columns_.count += static_cast<std::size_t>(width);
      if (!names.insert(name).second) {
        lines.fail(fmt::format("Properties: {} twice", imports::quoted(words[i])));
      }
      if (name == "pos" && width == 3) {
        columns_.position = {column, column + 1, column + 2};
        positions = true;
      } else if (name == "id" && width == 1) {
        columns_.id = column;
      } else if (name == "radius" && width == 1) {
        columns_.radius = column;
      } else if (name != "species") {
        unused.emplace_back(words[i]);
      }
    }
    if (!positions) lines.fail("Properties without the positions: pos:R:3 is expected");
    const bool uses_radius = columns_.radius && radius_ == 0;
    if (columns_.radius && !uses_radius) unused.emplace_back("radius");
    addOnce(summary_.used, fmt::format("columns {}pos{}", columns_.id ? "id, " : "",
                                       uses_radius ? ", radius" : ""));
    if (!unused.empty()) {
      addOnce(summary_.left_out, fmt::format("columns {}", fmt::join(unused, ", ")));
    }
  }

  /// Names columns behind those of plain XYZ, from the last line of a frame.
  void describeMore(const LineReader& lines) {
    imports::splitWords(lines.line(), words_);
    if (words_.size() > columns_.count) addOnce(summary_.left_out, "columns after the fourth");
  }

  double radius_;
  bool is_periodic_;  ///< the stated boundaries are asked for
  ParticleColumns columns_;
  std::string comment_;  ///< that `columns_` are from
  bool is_described_ = false;
  bool has_lattice_ = false;
  std::vector<std::string_view> words_;
};

/// Whether a file starts with a number, a comment, and a particle.
bool recognises(const imports::FileStart& start) {
  std::vector<std::string_view> lines;
  std::string_view text = start.text;
  const char line_end = text.find('\n') == std::string_view::npos ? '\r' : '\n';
  while (!text.empty() && lines.size() < 3) {
    const std::size_t end = std::min(text.find(line_end), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (!lines.empty() || !imports::isBlank(line)) lines.push_back(line);
  }
  std::int64_t count = 0;
  if (lines.size() < 2 || !imports::parseInteger(imports::trimmed(lines[0]), count) || count < 0) {
    return false;
  }
  if (valuesIn(lines[1]).contains("properties")) return true;
  if (count == 0) return true;
  std::vector<std::string_view> words;
  if (lines.size() == 3) imports::splitWords(lines[2], words);
  double number = 0;
  return words.size() >= 4 && imports::parseReal(words[1], number) &&
         imports::parseReal(words[2], number) && imports::parseReal(words[3], number);
}

std::unique_ptr<IndexedFrames> open(const std::vector<std::filesystem::path>& files,
                                    const ReadingOptions& options,
                                    imports::ImportSummary& summary) {
  summary.format = "XYZ";
  return imports::openTextFrames(files, std::make_unique<XyzFormat>(options), "Particles", options,
                                 summary);
}

}  // namespace

SourceKind kind() {
  return {.what = "particles (.xyz, .extxyz)",
          .import = FileImport{.formats = {"xyz"},
                               .extensions = {".xyz", ".extxyz"},
                               .options = {"radius", "periodic"},
                               .recognises = recognises,
                               .open = open}};
}

}  // namespace broadmark::sources::xyz
