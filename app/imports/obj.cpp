// Wavefront OBJ: 'v x y z' is a vertex, 'f a b c…' a face, 'l a b…' a line. Corners are vertex
// numbers, counted from 1, or backwards from the last vertex if negative; text after a slash is
// ignored.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "broadmark/error.h"
#include "imports/mesh.h"
#include "support/line_reader.h"

namespace broadmark::imports {
namespace {

/// Statements that say nothing about the places of vertices, faces and lines.
constexpr std::string_view kObjAttributes[] = {
    "vt",     "vn",     "g",          "s",         "o",     "mg",       "usemtl",   "mtllib",
    "usemap", "maplib", "shadow_obj", "trace_obj", "bevel", "c_interp", "d_interp", "lod"};
class ObjReader {
 public:
  explicit ObjReader(const std::filesystem::path& file) : lines_(file) {}

  void read() {
    while (nextLine()) {
      if (words_.empty()) continue;
      if (words_[0] == "v") {
        addVertex();
      } else if (words_[0] == "f" || words_[0] == "fo") {
        addFace();
      } else if (words_[0] == "l") {
        addLine();
      } else if (words_[0] == "p") {
        readVertices(1, "a point needs at least one vertex");  // all vertices are elements
      } else if (std::ranges::find(kObjAttributes, words_[0]) == std::end(kObjAttributes)) {
        leaveOut();
      }
    }
    if (max_number_ > static_cast<std::int64_t>(points.size())) {
      lines_.fail(max_line_, noVertex(max_number_));
    }
    mesh.vertices = static_cast<std::uint32_t>(points.size());
  }

  MeshTopology mesh;
  std::vector<Point> points;
  std::set<std::string, std::less<>> left_out;
  bool has_weights = false;  ///< other than 1

 private:
  /// Reads a line with its continuation lines: a backslash at the end continues a line, unless it
  /// ends a comment.
  bool nextLine() {
    constexpr std::size_t kMaxLength = 1 << 24;
    if (!lines_.next()) return false;
    line_ = withoutComment(lines_.line());
    while (line_.ends_with('\\')) {
      line_.back() = ' ';
      if (!lines_.next()) lines_.fail("the file ends within a continued line: cut short?");
      line_ += withoutComment(lines_.line());
      if (line_.size() > kMaxLength) lines_.fail("is too long with its continuation lines");
    }
    splitWords(line_, words_);
    return true;
  }
  static std::string_view withoutComment(std::string_view line) {
    line = line.substr(0, line.find('#'));
    return line.substr(0, line.find_last_not_of(" \t\r") + 1);
  }

  void addVertex() {
    // A weight or a colour may follow, or both; a colour may have a transparency.
    if (words_.size() < 4 || words_.size() > 8) {
      lines_.fail("a vertex needs three coordinates; a weight or a colour may follow");
    }
    if (points.size() >= MeshTopology::kMaxVertices) lines_.fail("more than 2^31 - 1 vertices");
    Point point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      point[axis] = static_cast<float>(lines_.realNumber(words_[1 + axis], "a coordinate"));
    }
    if (words_.size() == 5) has_weights |= lines_.realNumber(words_[4], "a weight") != 1;
    points.push_back(point);
  }

  void addFace() {
    readVertices(3, "a face needs at least three vertices");
    mesh.addPolygon(vertices_);
  }

  void addLine() {
    readVertices(2, "a line needs at least two vertices");
    for (std::size_t i = 1; i < vertices_.size(); ++i) {
      mesh.lines.push_back({vertices_[i - 1], vertices_[i]});
    }
  }

  void readVertices(std::size_t min, std::string_view expected) {
    if (words_.size() < 1 + min) lines_.fail(expected);
    vertices_.clear();
    for (std::size_t i = 1; i < words_.size(); ++i) vertices_.push_back(vertex(words_[i]));
  }

  std::uint32_t vertex(std::string_view corner) {
    const auto count = static_cast<std::int64_t>(points.size());
    const std::int64_t number = lines_.integer(corner.substr(0, corner.find('/')), "a vertex");
    const std::int64_t index = number < 0 ? count + number : number - 1;
    if (index < 0 || index >= MeshTopology::kMaxVertices) lines_.fail(noVertex(number));
    if (number > max_number_) {  // the vertex may follow
      max_number_ = number;
      max_line_ = lines_.number();
    }
    return static_cast<std::uint32_t>(index);
  }
  [[nodiscard]] std::string noVertex(std::int64_t number) const {
    return fmt::format("no vertex {}: there are {}{}", number, points.size(),
                       number < 0 ? " up to here" : "");
  }

  /// Notes a statement that is not used: of a curve or a surface, or unknown. A word that is none
  /// may be a damaged 'v': to leave it out would shift the numbers of all vertices behind it.
  void leaveOut() {
    constexpr std::size_t kMaxNames = 8;
    if (words_[0].find_first_not_of("abcdefghijklmnopqrstuvwxyz_0123456789") !=
        std::string_view::npos) {
      std::string shown;  // also what would be invisible
      for (const char c : words_[0].substr(0, 40)) {
        shown += c > ' ' && c <= '~' ? std::string(1, c)
                                     : fmt::format("\\x{:02X}", static_cast<unsigned char>(c));
      }
      lines_.fail(fmt::format("'{}' is not an OBJ statement", shown));
    }
    if (left_out.size() < kMaxNames) left_out.emplace(words_[0].substr(0, 40));
  }

  LineReader lines_;
  std::string line_;
  std::vector<std::string_view> words_;
  std::vector<std::uint32_t> vertices_;  ///< of the current statement
  std::int64_t max_number_ = 0;          ///< highest vertex number
  std::uint64_t max_line_ = 0;           ///< its line
};

}  // namespace

MeshTopology readObj(const std::filesystem::path& file, const PointSink& sink,
                     ImportSummary& summary) {
  ObjReader reader(file);
  reader.read();
  if (reader.points.empty()) {
    throw InputError(fmt::format("{}: no vertices: lines 'v x y z' are expected", file.string()));
  }
  summary.format = "Wavefront OBJ";
  if (reader.has_weights) summary.left_out.emplace_back("weights of vertices");
  if (!reader.left_out.empty()) {
    summary.left_out.push_back(fmt::format("statements {}", fmt::join(reader.left_out, ", ")));
  }
  sink(reader.points);
  return std::move(reader.mesh);
}

}  // namespace broadmark::imports
