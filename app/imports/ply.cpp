// The PLY format (Turk, "The PLY Polygon File Format", 1994): a header in text lists elements and
// their properties, the rows of each element follow, as text or binary. Used are the coordinates of
// `vertex`, the corners of `face`, strips of triangles of `tristrips`, and the ends of `edge`; the
// rows of other elements are skipped.

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "broadmark/error.h"
#include "broadmark/json_fields.h"
#include "imports/byte_reader.h"
#include "imports/mesh.h"
#include "support/line_reader.h"

namespace broadmark::imports {
namespace {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct PlyTypeNames {
  std::string_view name;
  std::string_view other_name;
  std::size_t bytes;
};
/// By PlyType.
constexpr std::array<PlyTypeNames, 8> kPlyTypes = {{{"char", "int8", 1},
                                                    {"uchar", "uint8", 1},
                                                    {"short", "int16", 2},
                                                    {"ushort", "uint16", 2},
                                                    {"int", "int32", 4},
                                                    {"uint", "uint32", 4},
                                                    {"float", "float32", 4},
                                                    {"double", "float64", 8}}};

const PlyTypeNames& namesOf(PlyType type) { return kPlyTypes[static_cast<std::size_t>(type)]; }

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;         ///< of a list's items
  std::optional<PlyType> count_type = {};  ///< only of lists
  bool is_used = false;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties = {};

  [[nodiscard]] std::optional<std::size_t> find(std::string_view property) const {
    const auto found = std::ranges::find(properties, property, &PlyProperty::name);
    if (found == properties.end()) return {};
    return static_cast<std::size_t>(found - properties.begin());
  }
  /// Bytes of each row, if all lists are empty.
  [[nodiscard]] std::uint64_t minRowBytes() const {
    std::uint64_t bytes = 0;
    for (const PlyProperty& property : properties) {
      bytes += namesOf(property.count_type.value_or(property.type)).bytes;
    }
    return bytes;
  }
  [[nodiscard]] bool hasLists() const {
    return std::ranges::any_of(properties,
                               [](const PlyProperty& p) { return p.count_type.has_value(); });
  }
};

/// Reads the header's lines. An end of line that is a carriage return alone is so in the whole
/// header: else a line feed that is the first byte of the data would be taken for a part of it.
class PlyHeaderReader {
 public:
  explicit PlyHeaderReader(ByteReader& bytes) : bytes_(bytes) {}

  void read() {
    if (!nextLine() || words_.size() != 1 || words_[0] != "ply") {
      fail("not a PLY file: the first line must be 'ply'");
    }
    while (true) {
      if (!nextLine()) fail("the file ends within the header: 'end_header' is expected");
      if (words_.empty() || words_[0] == "comment" || words_[0] == "obj_info") continue;
      if (words_[0] == "end_header") break;
      if (words_[0] == "format") {
        readFormat();
      } else if (words_[0] == "element") {
        addElement();
      } else if (words_[0] == "property") {
        addProperty();
      } else {
        fail(fmt::format("'{}': element, property, comment or end_header is expected",
                         onOneLine(std::string(words_[0].substr(0, 40)))));
      }
    }
    if (!has_format_) fail("a line 'format' is missing");
  }

  /// Order of the bytes; nothing: text.
  std::optional<std::endian> order;
  std::vector<PlyElement> elements;

 private:
  bool nextLine() {
    constexpr std::size_t kMaxHeaderLine = 1 << 16;
    line_.clear();
    ++number_;
    for (int byte = bytes_.get(); byte != '\n'; byte = bytes_.get()) {
      if (byte == ByteReader::kEnd) return false;
      if (byte == '\r' && (ends_with_return_ || (number_ == 1 && bytes_.peek() != '\n'))) {
        ends_with_return_ = true;
        break;
      }
      if (line_.size() == kMaxHeaderLine) fail("is too long: not a PLY file?");
      line_.push_back(static_cast<char>(byte));
    }
    while (line_.ends_with('\r')) line_.pop_back();
    splitWords(line_, words_);
    return true;
  }

  void readFormat() {
    if (words_.size() != 3 || words_[2] != "1.0") fail("'format KIND 1.0' is expected");
    if (words_[1] == "binary_little_endian") {
      order = std::endian::little;
    } else if (words_[1] == "binary_big_endian") {
      order = std::endian::big;
    } else if (words_[1] != "ascii") {
      fail("ascii, binary_little_endian or binary_big_endian is expected");
    }
    if (std::exchange(has_format_, true)) fail("a second format");
  }

  void addElement() {
    if (words_.size() != 3) fail("'element NAME COUNT' is expected");
    PlyElement element{.name = std::string(words_[1])};
    const std::string_view count = words_[2];
    const auto [end, error] =
        std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (error != std::errc() || end != count.data() + count.size()) {
      fail("its count is not a number of rows");
    }
    if (std::ranges::find(elements, element.name, &PlyElement::name) != elements.end()) {
      fail(fmt::format("a second element '{}'", onOneLine(element.name)));
    }
    elements.push_back(std::move(element));
  }

  void addProperty() {
    if (elements.empty()) fail("a property before the first element");
    const bool is_list = words_.size() > 1 && words_[1] == "list";
    if (words_.size() != (is_list ? 5 : 3)) {
      fail("'property TYPE NAME' or 'property list TYPE TYPE NAME' is expected");
    }
    PlyProperty property{.name = std::string(words_.back()),
                         .type = typeOf(words_[words_.size() - 2])};
    if (is_list) {
      property.count_type = typeOf(words_[2]);
      if (*property.count_type >= PlyType::float32) {
        fail("the count of a list must have an integer type");
      }
    }
    if (elements.back().find(property.name)) {
      fail(fmt::format("a second property '{}' of '{}'", onOneLine(property.name),
                       onOneLine(elements.back().name)));
    }
    elements.back().properties.push_back(std::move(property));
  }

  PlyType typeOf(std::string_view name) const {
    for (std::size_t type = 0; type < kPlyTypes.size(); ++type) {
      if (name != kPlyTypes[type].name && name != kPlyTypes[type].other_name) continue;
      return static_cast<PlyType>(type);
    }
    fail(fmt::format("unknown type '{}': char, uchar, short, ushort, int, uint, float or double",
                     onOneLine(std::string(name.substr(0, 40)))));
  }

  [[noreturn]] void fail(std::string_view what) const {
    bytes_.fail(bytes_.offset(), fmt::format("header, line {}: {}", number_, what));
  }

  ByteReader& bytes_;
  bool ends_with_return_ = false;
  bool has_format_ = false;
  std::string line_;
  std::uint64_t number_ = 0;
  std::vector<std::string_view> words_;
};

class PlyReader {
 public:
  PlyReader(const std::filesystem::path& file, ImportSummary& summary)
      : path_(file.string()), bytes_(file), summary_(summary) {}

  void read() {
    bytes_.skipByteOrderMark();
    PlyHeaderReader header(bytes_);
    header.read();
    order_ = header.order;
    summary_.format = !order_                          ? "ascii PLY"
                      : *order_ == std::endian::little ? "binary PLY, little-endian"
                                                       : "binary PLY, big-endian";
    const auto vertex = std::ranges::find(header.elements, "vertex", &PlyElement::name);
    if (vertex == header.elements.end()) fail("no element 'vertex'");
    if (vertex->count > MeshTopology::kMaxVertices) fail("more than 2^31 - 1 vertices");
    mesh.vertices = static_cast<std::uint32_t>(vertex->count);
    for (PlyElement& element : header.elements) {
      if (element.count == 0) continue;
      requireRows(element);
      if (element.name == "vertex") {
        readVertices(element);
      } else if (element.name == "face") {
        readFaces(element);
      } else if (element.name == "tristrips") {
        readStrips(element);
      } else if (element.name == "edge") {
        readEdges(element);
      } else {
        skipRows(element);
        summary_.left_out.push_back(fmt::format("element '{}'", onOneLine(element.name)));
      }
    }
    if (!order_) {
      while (bytes_.bytesLeft() > 0 && bytes_.atLineEnd()) bytes_.get();
    }
    if (const std::uint64_t rest = bytes_.bytesLeft(); rest > 0) {
      summary_.left_out.push_back(fmt::format("{} bytes after the last element", rest));
    }
  }

  MeshTopology mesh;
  std::vector<Point> points;

 private:
  /// Throws InputError if the file is too short for the rows of an element.
  void requireRows(const PlyElement& element) const {
    // As text, a row has a character and white space for each property.
    const std::uint64_t row = order_ ? element.minRowBytes() : 2 * element.properties.size();
    const std::uint64_t left = bytes_.bytesLeft() + (order_ ? 0 : 1);
    if (row == 0 || element.count <= left / row) return;
    bytes_.fail(bytes_.offset(),
                fmt::format("{} rows of '{}' take {} bytes each or more, {} are left: cut short?",
                            element.count, onOneLine(element.name), row, bytes_.bytesLeft()));
  }

  void readVertices(PlyElement& element) {
    std::array<std::size_t, 3> axes{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      axes[axis] = requireProperty(element, std::string_view("xyz").substr(axis, 1), false);
    }
    const auto is_rounded = [&](std::size_t property) {
      const PlyType type = element.properties[property].type;
      return type == PlyType::int32 || type == PlyType::uint32 || type == PlyType::float64;
    };
    if (std::ranges::any_of(axes, is_rounded)) {
      summary_.used.emplace_back("coordinates rounded to 32-bit floats");
    }
    points.reserve(element.count);
    Point point{};
    readRows(
        element,
        [&](std::size_t property, double value) {
          for (std::size_t axis = 0; axis < 3; ++axis) {
            if (axes[axis] == property) point[axis] = static_cast<float>(value);
          }
        },
        [&] { points.push_back(point); });
  }

  void readFaces(PlyElement& element) {
    requireCorners(element);
    std::vector<std::uint32_t> corners;
    std::uint64_t too_small = 0;
    readRows(
        element, [&](std::size_t, double value) { corners.push_back(vertexOf(element, value)); },
        [&] {
          if (corners.size() < 3) ++too_small;
          mesh.addPolygon(corners);
          corners.clear();
        });
    if (too_small == 0) return;
    summary_.left_out.push_back(fmt::format("faces of fewer than three corners: {}", too_small));
  }

  void readStrips(PlyElement& element) {
    requireCorners(element);
    std::vector<std::uint32_t> strip;
    readRows(
        element,
        [&](std::size_t, double value) {
          constexpr double kUnsignedCut = std::numeric_limits<std::uint32_t>::max();
          if (value == -1 || value == kUnsignedCut) return strip.clear();
          strip.push_back(vertexOf(element, value));
          if (strip.size() < 3) return;
          const Triangle triangle = {strip.end()[-3], strip.end()[-2], strip.end()[-1]};
          // A strip repeats a vertex where it turns: these triangles are no part of the surface.
          const auto& [a, b, c] = triangle;
          if (a != b && b != c && a != c) mesh.triangles.push_back(triangle);
        },
        [&] { strip.clear(); });
  }

  void readEdges(PlyElement& element) {
    const std::size_t first = requireProperty(element, "vertex1", false);
    requireProperty(element, "vertex2", false);
    std::array<std::uint32_t, 2> line{};
    readRows(
        element,
        [&](std::size_t property, double value) {
          line[property == first ? 0 : 1] = vertexOf(element, value);
        },
        [&] { mesh.lines.push_back(line); });
  }

  void skipRows(const PlyElement& element) {
    if (element.properties.empty()) return;
    if (order_ && !element.hasLists()) {
      return bytes_.seek(bytes_.offset() + element.count * element.minRowBytes());
    }
    readRows(element, [](std::size_t, double) {}, [] {});
  }

  /// Calls value(property, number) for the used numbers of each row, then row_end().
  template <class Value, class RowEnd>
  void readRows(const PlyElement& element, Value&& value, RowEnd&& row_end) {
    for (row_ = 0; row_ < element.count; ++row_) {
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        if (!property.count_type) {
          readItem(element, i, value);
          continue;
        }
        for (std::uint64_t items = readCount(property, element); items > 0; --items) {
          readItem(element, i, value);
        }
      }
      if (!order_ && !bytes_.atLineEnd()) {
        failAtNumber(fmt::format("row {} of '{}' has more numbers than properties", row_,
                                 onOneLine(element.name)));
      }
      row_end();
    }
  }

  template <class Value>
  void readItem(const PlyElement& element, std::size_t i, Value&& value) {
    const PlyProperty& property = element.properties[i];
    if (property.is_used) {
      value(i, readNumber(property.type, element));
    } else if (order_) {
      readNumber(property.type, element);
    } else if (bytes_.word().empty()) {  // as text, a normal of no length may be no number
      bytes_.failCutShort(element.name);
    }
  }

  std::uint64_t readCount(const PlyProperty& property, const PlyElement& element) {
    const double count = readNumber(*property.count_type, element);
    const std::uint64_t left = bytes_.bytesLeft() + (order_ ? 0 : 1);
    const std::uint64_t most = left / (order_ ? namesOf(property.type).bytes : 2);
    if (count >= 0 && count == std::floor(count) && count <= static_cast<double>(most)) {
      return static_cast<std::uint64_t>(count);
    }
    failAtNumber(
        fmt::format("row {} of '{}' claims a list of {:g}, {} bytes are left: damaged, or "
                    "cut short?",
                    row_, onOneLine(element.name), count, bytes_.bytesLeft()));
  }

  double readNumber(PlyType type, const PlyElement& element) {
    if (!order_) return bytes_.realNumber(element.name);
    switch (type) {
      case PlyType::int8:
        return bytes_.number<std::int8_t>(*order_, element.name);
      case PlyType::uint8:
        return bytes_.number<std::uint8_t>(*order_, element.name);
      case PlyType::int16:
        return bytes_.number<std::int16_t>(*order_, element.name);
      case PlyType::uint16:
        return bytes_.number<std::uint16_t>(*order_, element.name);
      case PlyType::int32:
        return bytes_.number<std::int32_t>(*order_, element.name);
      case PlyType::uint32:
        return bytes_.number<std::uint32_t>(*order_, element.name);
      case PlyType::float32:
        return bytes_.number<float>(*order_, element.name);
      case PlyType::float64:
        return bytes_.number<double>(*order_, element.name);
    }
    return 0;
  }

  std::uint32_t vertexOf(const PlyElement& element, double value) const {
    if (value >= 0 && value < mesh.vertices && value == std::floor(value)) {
      return static_cast<std::uint32_t>(value);
    }
    failAtNumber(
        fmt::format("row {} of '{}' names vertex {:.10g}, but there are {}: damaged, or "
                    "cut short?",
                    row_, element.name, value, mesh.vertices));
  }

  /// Returns the index of a property, which will be used. Throws InputError if there is none.
  std::size_t requireProperty(PlyElement& element, std::string_view name, bool is_list) const {
    const auto property = element.find(name);
    if (property && element.properties[*property].count_type.has_value() == is_list) {
      element.properties[*property].is_used = true;
      return *property;
    }
    fail(fmt::format("element '{}' has no {} '{}'", element.name, is_list ? "list" : "number",
                     name));
  }
  void requireCorners(PlyElement& element) const {
    requireProperty(element, element.find("vertex_index") ? "vertex_index" : "vertex_indices",
                    true);
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw InputError(fmt::format("{}: {}", path_, what));
  }
  /// Throws InputError about the last number.
  [[noreturn]] void failAtNumber(std::string_view what) const {
    if (!order_) bytes_.failAtWord(what);
    bytes_.fail(bytes_.offset(), what);
  }

  std::string path_;
  ByteReader bytes_;
  ImportSummary& summary_;
  std::optional<std::endian> order_;  ///< nothing: text
  std::uint64_t row_ = 0;             ///< of the current element
};

}  // namespace

MeshTopology readPly(const std::filesystem::path& file, const PointSink& sink,
                     ImportSummary& summary) {
  PlyReader reader(file, summary);
  reader.read();
  sink(reader.points);
  return std::move(reader.mesh);
}

}  // namespace broadmark::imports
