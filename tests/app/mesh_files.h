// Meshes, and an independent writer of mesh files: every variety that a format allows.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "imports/mesh.h"

namespace broadmark::tests {

using MeshReader = imports::MeshTopology(const std::filesystem::path&, const imports::PointSink&,
                                         imports::ImportSummary&);

/// What a reader makes of a file with one frame.
struct MeshContents {
  imports::MeshTopology topology;
  std::vector<imports::Point> points;
  imports::ImportSummary summary;
};
inline MeshContents meshIn(MeshReader& reader, const std::filesystem::path& file) {
  MeshContents contents;
  const auto keep = [&](std::span<const imports::Point> points) {
    contents.points.assign(points.begin(), points.end());
  };
  contents.topology = reader(file, keep, contents.summary);
  return contents;
}

/// Binary data, byte by byte.
class BinaryText {
 public:
  explicit BinaryText(bool big_endian) : big_endian_(big_endian) {}

  void integer(std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) {
      const int shift = 8 * (big_endian_ ? bytes - 1 - i : i);
      text.push_back(static_cast<char>(value >> shift & 0xFF));
    }
  }
  void real(float value) { integer(std::bit_cast<std::uint32_t>(value), 4); }
  void real(double value) { integer(std::bit_cast<std::uint64_t>(value), 8); }

  std::string text;

 private:
  bool big_endian_;
};

/// A binary STL file with that many facets at z = 0, 1, …
inline std::string stlBytes(std::string header, int facets) {
  BinaryText bytes(false);
  header.resize(80);
  bytes.text = header;
  bytes.integer(static_cast<std::uint64_t>(facets), 4);
  for (int i = 0; i < facets; ++i) {
    const auto z = static_cast<float>(i);
    for (const float value : {0.F, 0.F, 1.F, 0.F, 0.F, z, 1.F, 0.F, z, 0.F, 1.F, z}) {
      bytes.real(value);
    }
    bytes.integer(0, 2);
  }
  return bytes.text;
}

struct RandomMesh {
  std::vector<imports::Point> points;
  std::vector<std::vector<std::uint32_t>> faces;
  std::vector<std::array<std::uint32_t, 2>> lines;

  [[nodiscard]] std::vector<imports::Triangle> triangles() const {
    std::vector<imports::Triangle> triangles;
    for (const auto& face : faces) {
      for (std::size_t i = 1; i + 1 < face.size(); ++i) {
        triangles.push_back({face.front(), face[i], face[i + 1]});
      }
    }
    return triangles;
  }
};

/// A point anywhere: also far away, tiny, or -0.
inline imports::Point randomPoint(std::mt19937& random) {
  imports::Point point{};
  for (float& value : point) {
    const auto mantissa = static_cast<float>(static_cast<std::int32_t>(random()));
    value = mantissa * std::exp2(static_cast<float>(random() % 160) - 120);
    if (random() % 8 == 0) value = -0.F;
  }
  return point;
}

inline RandomMesh randomMesh(std::mt19937& random) {
  RandomMesh mesh;
  const auto vertices = static_cast<std::uint32_t>(3 + random() % 30);
  for (std::uint32_t i = 0; i < vertices; ++i) mesh.points.push_back(randomPoint(random));
  for (std::uint64_t faces = 1 + random() % 12; faces > 0; --faces) {
    auto& face = mesh.faces.emplace_back();
    const std::size_t corners = 3 + random() % 4;
    while (face.size() < corners) face.push_back(static_cast<std::uint32_t>(random() % vertices));
  }
  for (std::uint64_t lines = random() % 6; lines > 0; --lines) {
    mesh.lines.push_back({static_cast<std::uint32_t>(random() % vertices),
                          static_cast<std::uint32_t>(random() % vertices)});
  }
  return mesh;
}

/// A PLY file with properties and elements of other kinds between those of the mesh.
struct PlyFile {
  RandomMesh mesh;
  std::string encoding;  ///< "ascii", "little", "big"

  [[nodiscard]] std::string bytes(std::mt19937& random) const {
    Writer writer{.is_text = encoding == "ascii", .data = BinaryText(encoding == "big")};
    const std::string end = std::array{"\n", "\r\n", "\r"}[random() % 3];
    std::string header = "ply" + end + "format " +
                         (writer.is_text ? encoding : fmt::format("binary_{}_endian", encoding)) +
                         " 1.0" + end;
    std::vector<int> order = {0, 1, 2, 3};
    std::shuffle(order.begin(), order.end(), random);
    for (const int element : order) {
      header += element == 0   ? vertices(writer, end, random)
                : element == 1 ? faces(writer, end, random)
                : element == 2 ? edges(writer, end)
                               : others(writer, end, random);
      if (random() % 3 == 0) header += "comment " + std::string(random() % 5, '#') + end;
    }
    return header + "end_header" + end + (writer.is_text ? writer.text : writer.data.text);
  }

 private:
  struct Integer {
    const char* name;
    int bytes;
  };
  static constexpr std::array<Integer, 12> kIntegers = {{{"char", 1},
                                                         {"int8", 1},
                                                         {"uchar", 1},
                                                         {"uint8", 1},
                                                         {"short", 2},
                                                         {"int16", 2},
                                                         {"ushort", 2},
                                                         {"uint16", 2},
                                                         {"int", 4},
                                                         {"int32", 4},
                                                         {"uint", 4},
                                                         {"uint32", 4}}};

  struct Writer {
    bool is_text;
    BinaryText data;
    std::string text = {};

    void integer(std::uint64_t value, int bytes) {
      text += fmt::format("{} ", static_cast<std::int64_t>(value));
      data.integer(value, bytes);
    }
    template <class Real>
    void real(Real value) {
      text += fmt::format("{} ", value);
      data.real(value);
    }
    void endRow() { text.back() = '\n'; }
  };

  static std::string line(const std::string& words, const std::string& end) {
    return "property " + words + end;
  }

  std::string vertices(Writer& writer, const std::string& end, std::mt19937& random) const {
    const bool is_double = random() % 2 == 0;
    const bool has_list = random() % 2 == 0;
    const std::string type = is_double ? "double " : "float ";
    for (const auto& [x, y, z] : mesh.points) {
      writer.integer(random() % 100, 1);
      for (const float value : {z, x}) {
        is_double ? writer.real(double{value}) : writer.real(value);
      }
      if (has_list) {
        const std::uint64_t items = random() % 4;
        writer.integer(items, 2);
        for (std::uint64_t i = 0; i < items; ++i) writer.real(1e300);
      }
      writer.real(y);
      writer.endRow();
    }
    return fmt::format("element vertex {}{}", mesh.points.size(), end) + line("uchar red", end) +
           line(type + "z", end) + line(type + "x", end) +
           (has_list ? line("list ushort double rings", end) : "") + line("float32 y", end);
  }

  std::string faces(Writer& writer, const std::string& end, std::mt19937& random) const {
    const Integer count = kIntegers[random() % kIntegers.size()];
    const Integer item = kIntegers[random() % kIntegers.size()];
    const bool is_float = random() % 5 == 0;
    for (const auto& face : mesh.faces) {
      writer.real(std::numeric_limits<float>::quiet_NaN());
      writer.integer(face.size(), count.bytes);
      for (const std::uint32_t vertex : face) {
        is_float ? writer.real(static_cast<float>(vertex)) : writer.integer(vertex, item.bytes);
      }
      writer.integer(7, 1);
      writer.endRow();
    }
    return fmt::format("element face {}{}", mesh.faces.size(), end) + line("float quality", end) +
           line(fmt::format("list {} {} vertex_{}", count.name, is_float ? "float" : item.name,
                            random() % 2 == 0 ? "index" : "indices"),
                end) +
           line("char flags", end);
  }

  std::string edges(Writer& writer, const std::string& end) const {
    for (const auto& [a, b] : mesh.lines) {
      writer.integer(b, 4);
      writer.integer(a, 1);
      writer.endRow();
    }
    return fmt::format("element edge {}{}", mesh.lines.size(), end) + line("int vertex2", end) +
           line("uchar vertex1", end);
  }

  static std::string others(Writer& writer, const std::string& end, std::mt19937& random) {
    const std::uint64_t rows = random() % 3;
    const bool has_list = random() % 2 == 0;
    for (std::uint64_t row = 0; row < rows; ++row) {
      writer.real(1.5);
      if (has_list) {
        writer.integer(2, 1);
        writer.integer(10, 2);
        writer.integer(13, 2);
      }
      writer.endRow();
    }
    return fmt::format("element material {}{}", rows, end) + line("double shine", end) +
           (has_list ? line("list uchar short vertex_indices", end) : "");
  }
};

inline std::string objText(const RandomMesh& mesh, std::mt19937& random) {
  const std::string end = random() % 2 == 0 ? "\n" : "\r\n";
  const auto white = [&] {
    const auto kind = random() % 12;
    return kind == 0 ? " \\" + end + "  " : kind == 1 ? std::string("\t ") : std::string(" ");
  };
  const auto line_end = [&] {
    return (random() % 5 == 0 ? std::string(" # a \\ comment") : std::string()) + end;
  };
  std::string text = "# a mesh \\" + end + "o mesh" + end + "vt 0 0" + end;
  std::size_t written = 0;
  const auto number = [&](std::uint32_t vertex) {
    const auto index = static_cast<std::int64_t>(vertex);
    const std::string place = random() % 2 == 0
                                  ? fmt::format("{}", index + 1)
                                  : fmt::format("{}", index - static_cast<std::int64_t>(written));
    return place + std::array{"", "/1", "//1", "/1/1", "/"}[random() % 5];
  };
  // A face may follow as soon as its vertices are there.
  const auto statement = [&](const char* word, const auto& vertices) {
    text += word;
    for (const std::uint32_t vertex : vertices) text += white() + number(vertex);
    text += line_end();
  };
  for (const imports::Point& point : mesh.points) {
    text += "v";
    for (const float value : point) text += white() + fmt::format("{}", value);
    if (random() % 4 == 0) text += " 0.5 0.25 1";
    text += line_end();
    ++written;
    if (random() % 6 == 0) text += "vn 0 0 1" + line_end() + end;
  }
  for (const auto& face : mesh.faces) statement("f", face);
  for (const auto& line : mesh.lines) statement("l", line);
  return text;
}

/// A facet for every three corners, in one solid or several.
inline std::string stlText(const std::vector<imports::Point>& corners, std::mt19937& random) {
  const std::string end = std::array{"\n", "\r\n", "\r"}[random() % 3];
  std::string text = random() % 2 == 0 ? "solid" + end : end + "\tSolid a b" + end;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (i % 3 == 0 && i > 0 && random() % 4 == 0) text += "endsolid" + end + "solid b" + end;
    if (i % 3 == 0) text += "facet normal 0 nan 1e99" + end + " OUTER  loop" + end;
    text += fmt::format("vertex {} {:.9e} {}{}", corners[i][0], corners[i][1], corners[i][2], end);
    if (i % 3 == 2) text += "\tendloop" + end + "EndFacet" + end;
  }
  return text + "endsolid a b" + end;
}

inline std::string stlBinary(const std::vector<imports::Point>& corners, std::mt19937& random) {
  BinaryText bytes(false);
  bytes.text = std::array{"solid facet", "", "binary"}[random() % 3];
  bytes.text.resize(80, random() % 2 == 0 ? ' ' : '\0');
  bytes.integer(corners.size() / 3, 4);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (int axis = 0; i % 3 == 0 && axis < 3; ++axis) bytes.integer(random(), 4);  // any normal
    for (const float value : corners[i]) bytes.real(value);
    if (i % 3 == 2) bytes.integer(random() % 65536, 2);
  }
  return bytes.text;
}

}  // namespace broadmark::tests
