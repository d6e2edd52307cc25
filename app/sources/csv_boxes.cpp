// Boxes as CSV: a line for each body in each frame, "frame,id,min x,min y,min z,max x,max y,max z".
// A generic format for data from any program.

#include <fmt/format.h>

#include <cctype>

#include "imports/text_frames.h"
#include "sources/source.h"

namespace broadmark::sources::csv_boxes {
namespace {

using imports::LineReader;
using imports::TextFrame;
using imports::TextRow;

constexpr std::size_t kCells = 8;

float coordinate(const LineReader& lines, std::string_view cell, std::string_view what) {
  const auto value = static_cast<float>(lines.realNumber(cell, what));
  if (!std::isfinite(value)) lines.fail(fmt::format("{} is beyond what 32-bit floats hold", what));
  return value;
}

TextRow rowOf(const LineReader& lines, const std::vector<std::string_view>& cells) {
  constexpr std::string_view kAxes[] = {"x", "y", "z"};
  TextRow row{.id = lines.integer(cells[1], "the id"), .box = {}, .line = lines.number()};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    float& min = row.box.min[axis] = coordinate(lines, cells[2 + axis], "a minimum");
    float& max = row.box.max[axis] = coordinate(lines, cells[5 + axis], "a maximum");
    if (min > max) {
      lines.fail(fmt::format("min {0} = {1} is above max {0} = {2}", kAxes[axis], min, max));
    }
  }
  return row;
}

/// Whether the first line of a file names the columns.
bool isHeader(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t\"");
  return first != std::string_view::npos &&
         std::isalpha(static_cast<unsigned char>(line[first])) != 0;
}

/// Reads the lines with the same frame number.
bool readFrame(LineReader& lines, TextFrame& frame) {
  std::vector<std::string_view> cells;
  while (lines.next()) {
    const std::string_view line = lines.line();
    if (imports::isBlank(line)) continue;
    if (lines.number() == 1 && isHeader(line)) continue;
    imports::splitCells(',', line, cells);
    if (cells.size() != kCells) {
      lines.fail(fmt::format("{} values: 8 are expected: frame, id, min x, y, z, max x, y, z",
                             cells.size()));
    }
    const std::int64_t number = lines.integer(cells[0], "the frame");
    if (frame.number && number != *frame.number) {
      lines.unread();
      return true;
    }
    frame.number = number;
    frame.rows.push_back(rowOf(lines, cells));
  }
  return frame.number.has_value();
}

std::unique_ptr<IndexedFrames> open(const std::vector<std::filesystem::path>& files,
                                    const ReadingOptions&, imports::ImportSummary& summary) {
  summary.format = "CSV";
  return imports::openTextFrames(files, readFrame, "Boxes");
}

}  // namespace

SourceKind kind() {
  return {.what = "boxes (.csv: frame, id, six numbers)",
          .import = FileImport{.extensions = {".csv"}, .options = {}, .open = open}};
}

}  // namespace broadmark::sources::csv_boxes
