// Boxes in tables of text: a line for each body in each frame. A heading names the columns, in any
// order; without one they are frame, id, min x, y, z, max x, y, z. A generic format for data from
// any program.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ranges>

#include "broadmark/json_fields.h"
#include "imports/text_frames.h"
#include "sources/source.h"

namespace broadmark::sources::csv_boxes {
namespace {

using imports::addOnce;
using imports::LineReader;
using imports::TextFrame;
using imports::TextRow;

/// What a column holds: one of these, followed by an axis if it is part of a box.
constexpr const char* kFrame = "frame";
constexpr const char* kTime = "time";
constexpr const char* kStep = "step";
constexpr const char* kId = "id";
constexpr const char* kLayer = "layer";
constexpr std::string_view kAxes = "xyz";

struct Synonyms {
  std::string_view meaning;
  std::vector<std::string_view> names;
};
const std::vector<Synonyms> column_synonyms = {
    {kFrame, {"frame", "frameid", "frameno", "framenumber", "frameindex"}},
    {kTime, {"time", "t"}},
    {kStep, {"step", "timestep"}},
    {kId, {"id", "body", "bodyid", "object", "objectid", "entity", "entityid", "particleid"}},
    {kLayer, {"layer", "layerid"}},
};
/// Names of parts of a box, before or behind the axis.
const std::vector<Synonyms> box_column_synonyms = {
    {"min_", {"min", "minimum", "mins", "lower", "lowerbound", "low", "lo", "lb", "0"}},
    {"max_", {"max", "maximum", "maxs", "upper", "upperbound", "high", "hi", "ub", "1"}},
    {"centre_", {"centre", "center", "c", "mid"}},
    {"half_", {"half", "halfextent", "halfextents", "halfsize", "halfwidth", "halflength", "h"}},
    {"size_", {"size", "fullsize", "length", "width", "dim", "dimension"}},
    {"position_", {"", "pos", "position"}},
    {"extent_", {"extent", "extents"}},
};

std::string_view unquoted(std::string_view cell) {
  const bool is_quoted = cell.size() >= 2 && cell.front() == '"' && cell.back() == '"';
  return is_quoted ? imports::trimmed(cell.substr(1, cell.size() - 2)) : cell;
}

/// Splits a line at delimiters outside of quotes.
void splitRow(char delimiter, std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  bool is_quoted = false;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') is_quoted = !is_quoted;
    if (i < line.size() && (is_quoted || line[i] != delimiter)) continue;
    cells.push_back(unquoted(imports::trimmed(line.substr(begin, i - begin))));
    begin = i + 1;
  }
}

/// The most frequent of the delimiters.
char delimiterOf(std::string_view line) {
  constexpr std::string_view kDelimiters = ",;\t";
  return std::ranges::max(kDelimiters, {},
                          [&](char delimiter) { return std::ranges::count(line, delimiter); });
}

/// The letters and digits of a name, in lower case, without a unit in parentheses or brackets.
std::string plainName(std::string_view name) {
  std::string plain = imports::lowered(name.substr(0, name.find_first_of("([")));
  std::erase_if(plain, [](char c) { return !(c >= 'a' && c <= 'z') && !(c >= '0' && c <= '9'); });
  return plain;
}

/// Returns what a column of this name holds; "": not known.
std::string meaningOf(std::string_view name) {
  std::string plain = plainName(name);
  for (const auto& [meaning, names] : column_synonyms) {
    if (std::ranges::find(names, plain) != names.end()) return std::string(meaning);
  }
  for (const std::string_view prefix : {"aabb", "boundingbox", "bbox", "bounds", "box"}) {
    if (plain.starts_with(prefix)) plain.erase(0, prefix.size());
  }
  if (plain.empty()) return {};
  for (const auto& [part, names] : box_column_synonyms) {
    for (const char axis : kAxes) {
      const bool before = plain.front() == axis;
      if (!before && plain.back() != axis) continue;
      const std::string rest = before ? plain.substr(1) : plain.substr(0, plain.size() - 1);
      if (std::ranges::find(names, rest) != names.end()) return std::string(part) + axis;
    }
  }
  return {};
}

bool isNumber(std::string_view text) {
  double number = 0;
  return imports::parseReal(text, number);
}

/// Whether cells look like names of columns of boxes.
bool namesBoxes(const std::vector<std::string_view>& cells) {
  const auto is_part = [](std::string_view cell) {
    return !isNumber(cell) && meaningOf(cell).find('_') != std::string::npos;
  };
  return std::ranges::count_if(cells, is_part) >= 3;
}

/// The columns of a file.
struct Columns {
  char delimiter = ',';
  std::vector<std::string> names;                 ///< as in the file
  std::map<std::string, std::size_t> by_meaning;  ///< index of a column by what it holds
  std::string first = "min_";                     ///< a part of the box
  std::string second = "max_";                    ///< the other one
  // Indices of the columns, by axis for parts of the box.
  std::array<std::size_t, 3> first_column{};
  std::array<std::size_t, 3> second_column{};
  std::optional<std::size_t> frame;
  std::optional<std::size_t> time;
  std::optional<std::size_t> id;
  std::optional<std::size_t> layer;

  void setIndices() {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      first_column[axis] = by_meaning.at(first + kAxes[axis]);
      second_column[axis] = by_meaning.at(second + kAxes[axis]);
    }
    frame = find(kFrame);
    if (!frame) time = find(find(kTime) ? kTime : kStep);
    id = find(kId);
    layer = find(kLayer);
  }
  [[nodiscard]] bool uses(std::size_t column) const {
    return column == frame || column == time || column == id || column == layer ||
           std::ranges::count(first_column, column) + std::ranges::count(second_column, column) > 0;
  }

  [[nodiscard]] std::optional<std::size_t> find(const std::string& meaning) const {
    const auto found = by_meaning.find(meaning);
    if (found == by_meaning.end()) return {};
    return found->second;
  }
  [[nodiscard]] bool has(const std::string& part) const {
    return std::ranges::any_of(kAxes, [&](char axis) { return find(part + axis).has_value(); });
  }
};

/// Finds the two parts that define a box. Throws InputError.
void setForm(const LineReader& lines, Columns& columns) {
  const auto heading = [&] {
    return fmt::format("the heading is '{}'", fmt::join(columns.names, ", "));
  };
  if (columns.has("extent_")) {
    lines.fail("extents may be half or whole: call them half_x or size_x; " + heading());
  }
  std::vector<std::string> parts;
  for (const char* part : {"min_", "max_", "centre_", "half_", "size_"}) {
    if (columns.has(part)) parts.emplace_back(part);
  }
  const auto use = [&](const char* first, const char* second) {
    columns.first = first;
    columns.second = second;
  };
  // A position beside half sizes is a centre; beside sizes it may be a corner.
  if (parts == std::vector<std::string>{"half_"} && columns.has("position_")) {
    use("position_", "half_");
  } else if (parts == std::vector<std::string>{"size_"} && columns.has("position_")) {
    lines.fail("x, y, z may be a corner or the centre: call them min_x or centre_x; " + heading());
  } else if (parts.size() > 2) {
    lines.fail("boxes in two forms: min and max, or centre and half or size are expected; " +
               heading());
  } else if (parts == std::vector<std::string>{"centre_", "half_"}) {
    use("centre_", "half_");
  } else if (parts == std::vector<std::string>{"centre_", "size_"}) {
    use("centre_", "size_");
  } else if (parts == std::vector<std::string>{"min_", "size_"}) {
    use("min_", "size_");
  } else if (parts.size() == 2 && parts != std::vector<std::string>{"min_", "max_"}) {
    lines.fail(
        fmt::format("boxes of {}x and {}x: min and max, or centre and half or size are "
                    "expected; {}",
                    parts[0], parts[1], heading()));
  }
  for (const std::string& part : {columns.first, columns.second}) {
    for (const char axis : kAxes) {
      if (columns.find(part + axis)) continue;
      lines.fail(
          fmt::format("no column {}{}: min_x … max_z, or centre_x … with half_x … or size_x "
                      "… are expected, between commas, semicolons or tabs; {}",
                      part, axis, heading()));
    }
  }
}

Columns columnsIn(const LineReader& lines, char delimiter,
                  const std::vector<std::string_view>& names) {
  Columns columns{.delimiter = delimiter};
  for (const std::string_view name : names) {
    const std::string meaning = meaningOf(name);
    const auto [same, is_new] = columns.by_meaning.try_emplace(meaning, columns.names.size());
    if (!is_new && !meaning.empty()) {
      lines.fail(fmt::format("columns {} and {} have the same meaning",
                             imports::quoted(columns.names[same->second]), imports::quoted(name)));
    }
    constexpr std::size_t kMaxShown = 60;
    columns.names.push_back(onOneLine(std::string(name.substr(0, kMaxShown))));
  }
  columns.by_meaning.erase("");
  setForm(lines, columns);
  columns.setIndices();
  return columns;
}

/// Columns of a file without a heading.
Columns columnsByPosition(char delimiter) {
  Columns columns{.delimiter = delimiter,
                  .names = {kFrame, kId, "min_x", "min_y", "min_z", "max_x", "max_y", "max_z"}};
  for (std::size_t i = 0; i < columns.names.size(); ++i) columns.by_meaning[columns.names[i]] = i;
  columns.setIndices();
  return columns;
}

class CsvFormat final : public imports::TextFormat {
 public:
  void start(LineReader& lines) override {
    std::optional<char> stated;
    while (lines.next()) {
      std::string_view line = imports::trimmed(lines.line());
      if (line.empty()) continue;
      if (line.starts_with("sep=") && line.size() == 5) {  // for Excel
        stated = line.back();
        continue;
      }
      const bool is_comment = line.starts_with('#');
      if (is_comment) line = imports::trimmed(line.substr(1));
      const char delimiter = stated.value_or(delimiterOf(line));
      splitRow(delimiter, line, cells_);
      // NumPy writes the heading as a comment.
      if (is_comment && !namesBoxes(cells_)) continue;
      if (is_comment || !isNumber(cells_.front()) || namesBoxes(cells_)) {
        setColumns(columnsIn(lines, delimiter, cells_), "columns");
      } else {
        setColumns(columnsByPosition(delimiter), "no heading, columns by position:");
        lines.unread();
      }
      return;
    }
  }

  /// Reads the lines with the same frame or time.
  bool read(LineReader& lines, TextFrame& frame) override {
    frame.has_ids = columns_.id.has_value();
    while (lines.next()) {
      const std::string_view line = lines.line();
      // Spreadsheets end with rows of empty cells.
      const bool is_empty = line.find_first_not_of(" \t\",;") == std::string_view::npos;
      if (is_empty || imports::trimmed(line).starts_with('#')) continue;
      splitCells(lines, line);
      if (!frame.rows.empty() && !isIn(lines, frame)) {
        lines.unread();
        return true;
      }
      setMoment(lines, frame);
      frame.rows.push_back(row(lines, static_cast<std::int64_t>(frame.rows.size())));
    }
    return !frame.rows.empty();
  }

 private:
  void setColumns(Columns columns, std::string_view how) {
    columns_ = std::move(columns);
    std::vector<std::string> used;
    std::vector<std::string> unused;
    for (std::size_t i = 0; i < columns_.names.size(); ++i) {
      if (columns_.names[i].empty()) continue;
      (columns_.uses(i) ? used : unused).push_back(columns_.names[i]);
    }
    addOnce(summary_.used, fmt::format("{} {}", how, fmt::join(used, ", ")));
    if (!unused.empty()) {
      addOnce(summary_.left_out, fmt::format("columns {}", fmt::join(unused, ", ")));
    }
  }

  void splitCells(const LineReader& lines, std::string_view line) {
    splitRow(columns_.delimiter, line, cells_);
    if (cells_.size() == columns_.names.size()) return;
    lines.fail(
        fmt::format("{} values: {} are expected: {}{}", cells_.size(), columns_.names.size(),
                    fmt::join(columns_.names, ", "),
                    columns_.delimiter == ',' ? "; decimals have a point, not a comma" : ""));
  }

  /// Whether the current line belongs to the frame.
  [[nodiscard]] bool isIn(const LineReader& lines, const TextFrame& frame) const {
    TextFrame other;
    setMoment(lines, other);
    return other.number == frame.number && other.time == frame.time;
  }

  void setMoment(const LineReader& lines, TextFrame& frame) const {
    if (columns_.frame) frame.number = lines.integer(cells_[*columns_.frame], "the frame");
    if (columns_.time) frame.time = number(lines, *columns_.time);
  }

  [[nodiscard]] double number(const LineReader& lines, std::size_t column) const {
    const std::string_view text = cells_[column];
    const std::string& name = columns_.names[column];
    if (columns_.delimiter != ',' && text.find(',') != std::string_view::npos) {
      lines.fail(
          fmt::format("{} is {}: decimals have a point, not a comma", name, imports::quoted(text)));
    }
    return lines.realNumber(text, name);
  }

  [[nodiscard]] TextRow row(const LineReader& lines, std::int64_t index) const {
    TextRow row{.id = index, .box = {}, .line = lines.number()};
    if (columns_.id) row.id = lines.integer(cells_[*columns_.id], "the id");
    if (columns_.layer) {
      constexpr std::int64_t kMaxLayer = LayerMatrix::kLayers - 1;
      const std::int64_t layer = lines.integer(cells_[*columns_.layer], "the layer");
      if (layer < 0 || layer > kMaxLayer) {
        lines.fail(fmt::format("no layer {}: there are 0 to {}", layer, kMaxLayer));
      }
      row.layer = static_cast<std::uint8_t>(layer);
    }
    row.box = columns_.second == "max_" ? cornerBox(lines) : sizedBox(lines);
    return row;
  }

  [[nodiscard]] float coordinate(const LineReader& lines, std::size_t column) const {
    const auto value = static_cast<float>(number(lines, column));
    if (std::isfinite(value)) return value;
    lines.fail(fmt::format("{} is beyond what 32-bit floats hold", columns_.names[column]));
  }

  [[nodiscard]] Aabb cornerBox(const LineReader& lines) const {
    Aabb box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      float& min = box.min[axis] = coordinate(lines, columns_.first_column[axis]);
      float& max = box.max[axis] = coordinate(lines, columns_.second_column[axis]);
      if (min > max) {
        lines.fail(fmt::format("min {0} = {1} is above max {0} = {2}", kAxes[axis], min, max));
      }
    }
    return box;
  }

  /// From a centre and half of the size, or a corner or centre and the size.
  [[nodiscard]] Aabb sizedBox(const LineReader& lines) const {
    const bool is_half = columns_.second == "half_";
    std::array<double, 3> position{};
    std::array<double, 3> size{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      position[axis] = number(lines, columns_.first_column[axis]);
      size[axis] = number(lines, columns_.second_column[axis]);
      if (size[axis] >= 0) continue;
      lines.fail(fmt::format("{} = {:g} is negative", columns_.names[columns_.second_column[axis]],
                             size[axis]));
    }
    if (columns_.first == "min_") {
      return {imports::boxAround(lines, position, {}).min,
              imports::boxAround(lines, position, size).max};
    }
    for (double& value : size) value = is_half ? value : value / 2;
    return imports::boxAround(lines, position, size);
  }

  Columns columns_;
  std::vector<std::string_view> cells_;
};

/// Whether a file starts with a heading, or a line of eight numbers.
bool recognises(const imports::FileStart& start) {
  const std::string_view text = start.text;
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
    std::string_view line = imports::trimmed(text.substr(begin, end - begin));
    begin = end + 1;
    if (line.empty() || line.starts_with("sep=")) continue;
    const bool is_comment = line.starts_with('#');
    if (is_comment) line.remove_prefix(1);
    splitRow(delimiterOf(line), line, cells);
    if (namesBoxes(cells)) return true;
    if (!is_comment) return cells.size() == 8 && std::ranges::all_of(cells, isNumber);
  }
  return false;
}

std::unique_ptr<IndexedFrames> open(const std::vector<std::filesystem::path>& files,
                                    const ReadingOptions& options,
                                    imports::ImportSummary& summary) {
  summary.format = "CSV";
  return imports::openTextFrames(files, std::make_unique<CsvFormat>(), "Boxes", options, summary);
}

}  // namespace

SourceKind kind() {
  return {.what = "boxes (CSV: .csv, .tsv)",
          .import = FileImport{.formats = {"csv"},
                               .extensions = {".csv", ".tsv"},
                               .options = {},
                               .recognises = recognises,
                               .open = open}};
}

}  // namespace broadmark::sources::csv_boxes
