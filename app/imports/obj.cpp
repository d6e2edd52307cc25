// Wavefront OBJ: 'v x y z' is a vertex, 'f a b c…' a face. Corners of a face are vertex numbers,
// counted from 1, or backwards from the last vertex if negative; text after a slash is ignored.

#include <fmt/format.h>

#include "broadmark/error.h"
#include "imports/line_reader.h"
#include "imports/mesh.h"

namespace broadmark::imports {
namespace {

class ObjReader {
 public:
  explicit ObjReader(const std::filesystem::path& file) : lines_(file) {}

  void read() {
    while (nextLine()) {
      if (words_.empty()) continue;
      if (words_[0] == "v") addVertex();
      if (words_[0] == "f") addFace();
    }
    mesh.vertices = static_cast<std::uint32_t>(points.size());
  }

  MeshTopology mesh;
  std::vector<Point> points;

 private:
  /// Reads a line with its continuation lines: a backslash at the end continues a line.
  bool nextLine() {
    if (!lines_.next()) return false;
    line_ = lines_.line();
    while (line_.ends_with('\\') && line_.size() < kMaxLineLength && lines_.next()) {
      line_.back() = ' ';
      line_ += lines_.line();
    }
    splitWords(line_, words_);
    return true;
  }

  void addVertex() {
    if (words_.size() < 4) lines_.fail("a vertex has three coordinates");
    if (points.size() >= kMaxVertices) lines_.fail("more than 2^31 - 1 vertices");
    Point point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      point[axis] = static_cast<float>(lines_.realNumber(words_[1 + axis], "a coordinate"));
    }
    points.push_back(point);
  }

  void addFace() {
    if (words_.size() < 4) lines_.fail("a face has three vertices or more");
    const std::uint32_t first = vertex(words_[1]);
    std::uint32_t previous = vertex(words_[2]);
    for (std::size_t i = 3; i < words_.size(); ++i) {
      const std::uint32_t next = vertex(words_[i]);
      mesh.triangles.push_back({first, previous, next});
      previous = next;
    }
  }

  std::uint32_t vertex(std::string_view corner) {
    const auto count = static_cast<std::int64_t>(points.size());
    const std::int64_t number = lines_.integer(corner.substr(0, corner.find('/')), "a vertex");
    const std::int64_t index = number < 0 ? count + number : number - 1;
    if (index < 0 || index >= count) {
      lines_.fail(fmt::format("no vertex {}: there are {} up to here", number, count));
    }
    return static_cast<std::uint32_t>(index);
  }

  static constexpr std::size_t kMaxLineLength = 1 << 20;
  static constexpr std::size_t kMaxVertices = (std::size_t{1} << 31) - 1;

  LineReader lines_;
  std::string line_;
  std::vector<std::string_view> words_;
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
  sink(reader.points);
  return std::move(reader.mesh);
}

}  // namespace broadmark::imports
