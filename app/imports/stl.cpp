// STL files, as text or binary. Each facet has corners of its own; which of them are one vertex
// follows from their positions.
//
// Text:   solid NAME, then 'facet normal X Y Z', 'outer loop', 'vertex X Y Z' for each corner,
//         'endloop', 'endfacet' for each facet, then endsolid; in any case, with any white space
// Binary: 80 bytes, the number of facets (32 bits), then for each facet 12 floats (its normal and
//         three corners) and 16 bits; little-endian. The 80 bytes may begin with 'solid', too.

#include <fmt/format.h>

#include "broadmark/error.h"
#include "broadmark/json_fields.h"
#include "imports/byte_reader.h"
#include "imports/mesh.h"

namespace broadmark::imports {
namespace {

constexpr std::uint64_t kStlHeaderBytes = 84;
constexpr std::uint64_t kStlFacetBytes = 50;

class StlReader {
 public:
  StlReader(const std::filesystem::path& file, ImportSummary& summary)
      : bytes_(file), size_(bytes_.bytesLeft()), summary_(summary) {
    mesh.joined_by_position = true;
  }

  void read() {
    const std::uint64_t facets = binaryFacets();
    const bool fits_exactly =
        size_ >= kStlHeaderBytes && size_ - kStlHeaderBytes == facets * kStlFacetBytes;
    if (!fits_exactly && isText()) {
      readText();
    } else {
      readBinary(facets);
    }
    mesh.vertices = static_cast<std::uint32_t>(points.size());
    summary_.used.emplace_back("corners at the same position in every frame as one vertex");
  }

  MeshTopology mesh;
  std::vector<Point> points;

 private:
  std::uint64_t binaryFacets() {
    if (size_ < kStlHeaderBytes) return 0;
    bytes_.seek(kStlHeaderBytes - sizeof(std::uint32_t));
    return bytes_.number<std::uint32_t>(std::endian::little, "the number of facets");
  }

  /// Whether a line 'solid' is followed by a facet, or by the end of the solid.
  bool isText() {
    bytes_.seek(0);
    bytes_.skipByteOrderMark();
    if (!startsWithWord("solid")) return false;
    while (!bytes_.atLineEnd()) {
      if (bytes_.get() == 0) return false;
    }
    return startsWithWord("facet") || startsWithWord("endsolid") ||
           (bytes_.atLineEnd() && bytes_.peek() == ByteReader::kEnd);
  }

  /// Whether the next bytes, after white space, are this text in any case. Reads them as far as
  /// they agree.
  bool startsWithWord(std::string_view text) {
    while (bytes_.atLineEnd() && bytes_.peek() != ByteReader::kEnd) bytes_.get();
    for (const char expected : text) {
      if (bytes_.peek() == ByteReader::kEnd) return false;
      const auto byte = static_cast<char>(bytes_.peek());
      if (!sameWord({&byte, 1}, {&expected, 1})) return false;
      bytes_.get();
    }
    return true;
  }

  void readText() {
    summary_.format = "ascii STL";
    bytes_.seek(0);
    bytes_.skipByteOrderMark();
    for (std::string_view word = bytes_.word(); sameWord(word, "solid"); word = bytes_.word()) {
      readSolid();
      behind_ = bytes_.offset();
    }
    bytes_.seek(behind_);
    while (bytes_.atLineEnd() && bytes_.peek() != ByteReader::kEnd) bytes_.get();
    noteRest("the last solid");
  }

  /// Reads a solid behind its first word.
  void readSolid() {
    bytes_.skipLine();
    while (true) {
      const std::string_view word = nextWord("a solid");
      if (sameWord(word, "endsolid")) return bytes_.skipLine();
      if (!sameWord(word, "facet")) failExpecting("'facet' or 'endsolid'");
      readFacet();
    }
  }

  /// Reads a facet behind its first word. Its normal is not read: that of a degenerate facet may be
  /// no number.
  void readFacet() {
    constexpr int kNormalWords = 4;
    int words = 0;
    while (!sameWord(nextWord("a facet"), "outer")) {
      if (++words > kNormalWords) failExpecting("'outer loop'");
    }
    if (!sameWord(nextWord("a facet"), "loop")) failExpecting("'loop'");
    std::vector<std::uint32_t> corners;
    while (sameWord(nextWord("a facet"), "vertex")) {
      Point point{};
      for (float& value : point) value = static_cast<float>(bytes_.realNumber("a coordinate"));
      corners.push_back(addPoint(point));
    }
    if (!sameWord(last_word_, "endloop")) failExpecting("'vertex' or 'endloop'");
    if (corners.size() < 3) bytes_.failAtWord("a facet needs at least three corners");
    if (!sameWord(nextWord("a facet"), "endfacet")) failExpecting("'endfacet'");
    mesh.addPolygon(corners);
  }

  std::string_view nextWord(std::string_view within) {
    last_word_ = bytes_.word();
    if (last_word_.empty()) bytes_.failCutShort(within);
    return last_word_;
  }
  [[noreturn]] void failExpecting(std::string_view expected) const {
    bytes_.failAtWord(fmt::format("'{}': {} is expected",
                                  onOneLine(std::string(last_word_.substr(0, 40))), expected));
  }

  void readBinary(std::uint64_t facets) {
    summary_.format = "binary STL";
    if (size_ < kStlHeaderBytes) {
      bytes_.fail(size_, fmt::format("too short: an STL file must begin with 'solid', or with a "
                                     "header of {} bytes",
                                     kStlHeaderBytes));
    }
    const std::uint64_t room = (size_ - kStlHeaderBytes) / kStlFacetBytes;
    if (facets > room) {
      bytes_.fail(size_,
                  fmt::format("the file ends after {} of {} facets: cut short?", room, facets));
    }
    if (facets == 0 && size_ > kStlHeaderBytes) {
      bytes_.fail(kStlHeaderBytes, "bytes after the header, which states no facets");
    }
    points.reserve(3 * facets);
    bytes_.seek(kStlHeaderBytes);
    for (std::uint64_t facet = 0; facet < facets; ++facet) {
      std::array<float, 12> numbers{};
      for (float& number : numbers) {
        number = bytes_.number<float>(std::endian::little, "a facet");
      }
      bytes_.number<std::uint16_t>(std::endian::little, "a facet");
      std::array<std::uint32_t, 3> corners{};
      for (std::size_t i = 0; i < 3; ++i) {
        corners[i] = addPoint({numbers[3 * i + 3], numbers[3 * i + 4], numbers[3 * i + 5]});
      }
      mesh.addPolygon(corners);
    }
    noteRest("the last facet");
  }

  std::uint32_t addPoint(const Point& point) {
    if (points.size() >= MeshTopology::kMaxVertices) {
      bytes_.fail(bytes_.offset(), "more than 2^31 - 1 corners");
    }
    points.push_back(point);
    return static_cast<std::uint32_t>(points.size() - 1);
  }

  void noteRest(std::string_view behind) {
    const std::uint64_t rest = bytes_.bytesLeft();
    if (rest == 0) return;
    summary_.left_out.push_back(fmt::format("{} bytes after {}", rest, behind));
  }

  ByteReader bytes_;
  std::uint64_t size_;
  ImportSummary& summary_;
  std::string_view last_word_;
  std::uint64_t behind_ = 0;  ///< offset behind the last solid
};

}  // namespace

MeshTopology readStl(const std::filesystem::path& file, const PointSink& sink,
                     ImportSummary& summary) {
  StlReader reader(file, summary);
  reader.read();
  sink(reader.points);
  return std::move(reader.mesh);
}

}  // namespace broadmark::imports
