// glTF files: what each part of the format means, and what is refused.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "app/import_files.h"
#include "imports/mesh.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

using imports::ImportSummary;
using imports::MeshTopology;
using imports::Point;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Json = nlohmann::ordered_json;

template <class T>
constexpr int kComponentType = std::is_same_v<T, std::int8_t>     ? 5120
                               : std::is_same_v<T, std::uint8_t>  ? 5121
                               : std::is_same_v<T, std::int16_t>  ? 5122
                               : std::is_same_v<T, std::uint16_t> ? 5123
                               : std::is_same_v<T, std::uint32_t> ? 5125
                               : std::is_same_v<T, float>         ? 5126
                                                                  : 0;

std::string base64(const std::string& bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t j = i; j < i + 3; ++j) {
      bits = bits << 8 | (j < bytes.size() ? static_cast<unsigned char>(bytes[j]) : 0U);
    }
    for (std::size_t j = 0; j < 4; ++j) {
      text += i + j > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * j) & 63];
    }
  }
  return text;
}

/// A glTF file that is put together; its accessors share one buffer.
class GltfFile {
 public:
  Json json = {{"asset", {{"version", "2.0"}}}};
  std::string bytes;

  /// Adds to one of the outermost lists. Returns the index.
  std::size_t add(const char* list, const Json& item) {
    json[list].push_back(item);
    return json[list].size() - 1;
  }
  template <class T>
  std::size_t view(const std::vector<T>& values, const Json& more = Json::object()) {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    Json view = {
        {"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(T)}};
    view.update(more);
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    return add("bufferViews", view);
  }
  template <class T>
  std::size_t accessor(const std::string& type, const std::vector<T>& values,
                       const Json& more = Json::object()) {
    const std::size_t width = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : type.back() - '0';
    Json accessor = {{"bufferView", view(values)},
                     {"componentType", kComponentType<T>},
                     {"count", values.size() / width},
                     {"type", type}};
    accessor.update(more);
    return add("accessors", accessor);
  }
  std::size_t floats(const std::string& type, const std::vector<float>& values) {
    return accessor<float>(type, values);
  }
  /// A mesh of one primitive without indices.
  std::size_t mesh(const Json& attributes, const Json& more = Json::object()) {
    Json primitive = {{"attributes", attributes}};
    primitive.update(more);
    return add("meshes", {{"primitives", {primitive}}});
  }
  /// The triangle 0 0 0, 1 0 0, 0 1 0.
  std::size_t triangle() {
    return mesh({{"POSITION", floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0})}});
  }
  /// A triangle at a node.
  std::size_t triangleNode(const Json& more = Json::object()) {
    Json node = {{"mesh", triangle()}};
    node.update(more);
    return add("nodes", node);
  }
  /// Adds a channel to an animation, with its sampler; a new animation if it does not exist.
  void animate(std::size_t node, const std::string& path, std::size_t times, std::size_t values,
               const std::string& interpolation = "LINEAR", std::size_t animation = 0) {
    while (json["animations"].size() <= animation) {
      add("animations", {{"channels", Json::array()}, {"samplers", Json::array()}});
    }
    Json& target = json["animations"][animation];
    target["channels"].push_back(
        {{"sampler", target["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
    target["samplers"].push_back(
        {{"input", times}, {"output", values}, {"interpolation", interpolation}});
  }
  /// Moves a node from 0 along x, within a second.
  void move(std::size_t node, float x, std::size_t animation = 0) {
    animate(node, "translation", floats("SCALAR", {0, 1}), floats("VEC3", {0, 0, 0, x, 0, 0}),
            "LINEAR", animation);
  }

  [[nodiscard]] std::string text() const { return withBuffer(embedded()); }
  /// The text, with these properties of the buffer.
  [[nodiscard]] std::string withBuffer(const Json& more) const {
    Json whole = json;
    whole["buffers"] = {{{"byteLength", bytes.size()}}};
    whole["buffers"][0].update(more);
    return whole.dump();
  }
  [[nodiscard]] Json embedded() const {
    return {{"uri", "data:application/octet-stream;base64," + base64(bytes)}};
  }
  /// The binary form; `json_padding` ends the JSON chunk.
  [[nodiscard]] std::string binary(const std::string& json_padding = "") const {
    std::string text = withBuffer(Json::object()) + json_padding;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string chunk = bytes;
    chunk.resize((chunk.size() + 3) / 4 * 4);
    const std::string chunks = number(text.size()) + "JSON" + text + number(chunk.size()) +
                               std::string("BIN\0", 4) + chunk;
    return "glTF" + number(2) + number(12 + chunks.size()) + chunks;
  }
  static std::string number(std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    std::string bytes(4, '\0');
    std::memcpy(bytes.data(), &word, 4);
    return bytes;
  }
};

/// What is in a file.
struct Contents {
  MeshTopology topology;
  std::vector<std::vector<Point>> frames;
  ImportSummary summary;

  /// A coordinate of one vertex in all frames.
  [[nodiscard]] std::vector<float> track(std::size_t vertex, std::size_t axis) const {
    std::vector<float> values;
    for (const auto& frame : frames) values.push_back(frame.at(vertex).at(axis));
    return values;
  }
};

class GltfImports : public Imports {
 protected:
  static Contents contentsOf(const std::filesystem::path& file,
                             const ParameterValues& options = {}) {
    ReadingOptions reading;
    setParameters(reading, options);
    Contents contents;
    contents.topology = imports::readGltf(
        file, reading,
        [&](std::span<const Point> points) {
          contents.frames.emplace_back(points.begin(), points.end());
        },
        contents.summary);
    for (const auto& frame : contents.frames) EXPECT_EQ(frame.size(), contents.topology.vertices);
    return contents;
  }
  [[nodiscard]] Contents contents(const GltfFile& file, const ParameterValues& options = {}) const {
    return contentsOf(overwrite("a.gltf", file.text()), options);
  }
  [[nodiscard]] std::vector<Point> pointsOf(const GltfFile& file) const {
    return contents(file).frames.at(0);
  }
  [[nodiscard]] std::string refusal(const GltfFile& file,
                                    const ParameterValues& options = {}) const {
    return refusalOf(file.text(), options);
  }
  [[nodiscard]] std::string refusalOf(const std::string& text,
                                      const ParameterValues& options = {}) const {
    const auto path = overwrite("a.gltf", text);
    return inputErrorOf([&] { contentsOf(path, options); });
  }
  /// Like write(), without waiting for the disc.
  [[nodiscard]] std::filesystem::path overwrite(const std::string& name,
                                                const std::string& bytes) const {
    const auto path = directory_ / name;
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
};

using Index = std::uint32_t;

TEST_F(GltfImports, AnimatedNodesMoveTheirMeshes) {
  // The node moves from x = 0 to x = 4 within a second.
  const auto file = places::source("tests/data/moving.gltf");
  const auto frames = importFrom(file, {{"frame_rate", "2"}});
  ASSERT_EQ(frames->scene().frames, 2U);
  EXPECT_EQ(boxesOf(*frames, 0)[0], boxOf({0, 0, 0}, {1, 1, 0}));
  EXPECT_EQ(boxesOf(*frames, 1)[0], boxOf({2, 0, 0}, {3, 1, 0}));
  EXPECT_EQ(boxesOf(*frames, 2)[0], boxOf({4, 0, 0}, {5, 1, 0}));
  EXPECT_EQ(importFrom(file)->scene().frames, 30U);
}

TEST_F(GltfImports, AnimatedBonesPullAtVertices) {
  // Only the second vertex is attached to the moving bone.
  const auto frames = importFrom(places::source("tests/data/skinned.gltf"),
                                 {{"frame_rate", "1"}, {"elements", "vertices"}});
  EXPECT_THAT(boxesOf(*frames, 1),
              ElementsAre(boxOf({0, 0, 0}, {0, 0, 0}), boxOf({5, 0, 0}, {5, 0, 0}),
                          boxOf({0, 1, 0}, {0, 1, 0})));
}

// ---- Accessors.

TEST_F(GltfImports, IntegersArePositions) {
  GltfFile raw;
  // Each element has 8 bytes, the last two unused.
  const std::size_t view =
      raw.view<std::uint16_t>({0, 0, 0, 9, 100, 0, 0, 9, 0, 65535, 0, 9}, {{"byteStride", 8}});
  raw.add("nodes", {{"mesh", raw.mesh({{"POSITION", raw.add("accessors", {{"bufferView", view},
                                                                          {"componentType", 5123},
                                                                          {"count", 3},
                                                                          {"type", "VEC3"}})}})}});
  raw.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  EXPECT_THAT(pointsOf(raw), ElementsAre(Point{0, 0, 0}, Point{100, 0, 0}, Point{0, 65535, 0}));

  const Json normalized = {{"normalized", true}};
  GltfFile shorts;
  const auto positions = shorts.accessor<std::int16_t>(
      "VEC3", {-32768, 0, 0, 32767, 0, 0, 16384, -32767, 1}, normalized);
  shorts.add("nodes", {{"mesh", shorts.mesh({{"POSITION", positions}})}, {"scale", {2, 2, 2}}});
  EXPECT_THAT(pointsOf(shorts), ElementsAre(Point{-2, 0, 0}, Point{2, 0, 0},
                                            Point{static_cast<float>(32768 / 32767.0), -2,
                                                  static_cast<float>(2 / 32767.0)}));

  GltfFile small;
  const auto unsigned_bytes =
      small.accessor<std::uint8_t>("VEC3", {0, 255, 51, 255, 0, 0, 0, 0, 0}, normalized);
  const auto bytes =
      small.accessor<std::int8_t>("VEC3", {-128, -127, 127, 0, 0, 0, 1, 1, 1}, normalized);
  const auto raw_bytes = small.accessor<std::int8_t>("VEC3", {-128, -127, 127, 0, 0, 0, 1, 1, 1});
  const auto words = small.accessor<Index>("VEC3", {4294967295, 1, 0, 0, 0, 0, 0, 1, 0});
  for (const auto accessor : {unsigned_bytes, bytes, raw_bytes, words}) {
    small.add("nodes", {{"mesh", small.mesh({{"POSITION", accessor}})}});
  }
  const std::vector<Point> points = pointsOf(small);
  EXPECT_EQ(points[0], (Point{0, 1, 0.2F}));
  EXPECT_EQ(points[3], (Point{-1, -1, 1}));
  EXPECT_EQ(points[6], (Point{-128, -127, 127}));
  EXPECT_EQ(points[9], (Point{4294967296.F, 1, 0}));
}

TEST_F(GltfImports, SparseAccessorsReplaceElements) {
  const auto sparse = [](GltfFile& file, const std::vector<std::uint8_t>& indices) {
    return Json{{"count", 2},
                {"indices", {{"bufferView", file.view(indices)}, {"componentType", 5121}}},
                {"values", {{"bufferView", file.view<float>({9, 9, 9, 7, 8, 9})}}}};
  };
  GltfFile file;
  const auto accessor =
      file.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, {{"sparse", sparse(file, {0, 2})}});
  file.add("nodes", {{"mesh", file.mesh({{"POSITION", accessor}})}});
  EXPECT_THAT(pointsOf(file), ElementsAre(Point{9, 9, 9}, Point{1, 0, 0}, Point{7, 8, 9}));
  // Without a buffer view, other elements are 0.
  GltfFile zeros = file;
  zeros.json["accessors"][0].erase("bufferView");
  EXPECT_THAT(pointsOf(zeros), ElementsAre(Point{9, 9, 9}, Point{0, 0, 0}, Point{7, 8, 9}));
  zeros.json["accessors"][0].erase("sparse");
  EXPECT_THAT(pointsOf(zeros), ElementsAre(Point{0, 0, 0}, Point{0, 0, 0}, Point{0, 0, 0}));

  for (const auto& [indices, what] :
       {std::pair(std::vector<std::uint8_t>{0, 3}, "index 3, but there are 3 elements"),
        std::pair(std::vector<std::uint8_t>{2, 1}, "index 1 after 2"),
        std::pair(std::vector<std::uint8_t>{1, 1}, "index 1 after 1"),
        std::pair(std::vector<std::uint8_t>{1}, "2 indices need 2 bytes")}) {
    GltfFile bad;
    const auto positions = bad.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0},
                                               {{"sparse", sparse(bad, indices)}});
    bad.add("nodes", {{"mesh", bad.mesh({{"POSITION", positions}})}});
    EXPECT_THAT(refusal(bad), AllOf(HasSubstr("a.gltf: accessors[0]: sparse"), HasSubstr(what)));
  }
}

// ---- Primitives.

/// A file with the vertices (0, 0, 0), (1, 0, 0), (2, 0, 0), … in one primitive.
GltfFile rowOf(int vertices, const Json& primitive) {
  GltfFile file;
  std::vector<float> positions;
  for (int i = 0; i < vertices; ++i)
    positions.insert(positions.end(), {static_cast<float>(i), 0, 0});
  file.add("nodes",
           {{"mesh", file.mesh({{"POSITION", file.floats("VEC3", positions)}}, primitive)}});
  return file;
}

TEST_F(GltfImports, PrimitivesOfEachMode) {
  using Triangles = std::vector<imports::Triangle>;
  using Lines = std::vector<std::array<Index, 2>>;
  const auto topology = [&](int vertices, int mode) {
    return contents(rowOf(vertices, {{"mode", mode}})).topology;
  };
  EXPECT_EQ(topology(6, 4).triangles, (Triangles{{0, 1, 2}, {3, 4, 5}}));
  EXPECT_EQ(topology(5, 5).triangles, (Triangles{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
  EXPECT_EQ(topology(5, 6).triangles, (Triangles{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
  EXPECT_EQ(topology(4, 1).lines, (Lines{{0, 1}, {2, 3}}));
  EXPECT_EQ(topology(3, 2).lines, (Lines{{0, 1}, {1, 2}, {2, 0}}));
  EXPECT_EQ(topology(3, 3).lines, (Lines{{0, 1}, {1, 2}}));
  const Contents points = contents(rowOf(3, {{"mode", 0}}));
  EXPECT_EQ(points.topology.vertices, 3U);
  EXPECT_THAT(points.topology.triangles, IsEmpty());
  EXPECT_THAT(points.summary.left_out, ElementsAre("3 points: --elements vertices has them"));
  EXPECT_THAT(refusal(rowOf(5, {{"mode", 4}})), HasSubstr("5 vertices: a multiple of 3"));
  EXPECT_THAT(refusal(rowOf(5, {{"mode", 1}})), HasSubstr("a multiple of 2"));
  EXPECT_THAT(refusal(rowOf(3, {{"mode", 7}})), HasSubstr("mode: an integer from 0 to 6"));
}

TEST_F(GltfImports, IndicesOfEachType) {
  const auto read = [&](GltfFile file, std::size_t accessor) {
    file.json["meshes"][0]["primitives"][0]["indices"] = accessor;
    return contents(file).topology.triangles;
  };
  const std::vector<imports::Triangle> expected = {{2, 1, 0}};
  GltfFile file = rowOf(3, Json::object());
  const auto bytes = file.accessor<std::uint8_t>("SCALAR", {2, 1, 0});
  const auto shorts = file.accessor<std::uint16_t>("SCALAR", {2, 1, 0});
  const auto words = file.accessor<Index>("SCALAR", {2, 1, 0});
  EXPECT_EQ(read(file, bytes), expected);
  EXPECT_EQ(read(file, shorts), expected);
  EXPECT_EQ(read(file, words), expected);
  for (const auto accessor :
       {file.accessor<float>("SCALAR", {0, 1, 2}), file.accessor<std::int16_t>("SCALAR", {0, 1, 2}),
        file.accessor<std::uint8_t>("SCALAR", {0, 1, 2}, {{"normalized", true}})}) {
    GltfFile bad = file;
    bad.json["meshes"][0]["primitives"][0]["indices"] = accessor;
    EXPECT_THAT(refusal(bad), HasSubstr("indices must be unsigned integers"));
  }
  GltfFile beyond = file;
  beyond.json["meshes"][0]["primitives"][0]["indices"] =
      beyond.accessor<Index>("SCALAR", {0, 1, 3});
  EXPECT_THAT(refusal(beyond),
              HasSubstr("a.gltf: meshes[0]: primitives[0]: index 2 is 3, but there are 3 ver"));
}

TEST_F(GltfImports, ARepeatedVertexJoinsStrips) {
  GltfFile file = rowOf(6, {{"mode", 5}});
  file.json["meshes"][0]["primitives"][0]["indices"] =
      file.accessor<std::uint8_t>("SCALAR", {0, 1, 2, 2, 3, 3, 4, 5});
  EXPECT_EQ(contents(file).topology.triangles,
            (std::vector<imports::Triangle>{{0, 1, 2}, {3, 5, 4}}));
}

TEST_F(GltfImports, PrimitivesThatShareAccessorsShareVertices) {
  GltfFile file;
  const auto positions = file.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 7, 7, 7, 1, 1, 0});
  const auto primitive = [&](const std::vector<std::uint8_t>& corners) {
    return Json{{"attributes", {{"POSITION", positions}}},
                {"indices", file.accessor<std::uint8_t>("SCALAR", corners)}};
  };
  const Json primitives = {primitive({0, 1, 2}), primitive({2, 1, 4})};
  file.add("meshes", {{"primitives", primitives}});
  file.add("nodes", {{"mesh", 0}});
  const Contents whole = contents(file);
  // No primitive uses 7 7 7.
  EXPECT_EQ(whole.topology.vertices, 4U);
  EXPECT_EQ(whole.topology.triangles, (std::vector<imports::Triangle>{{0, 1, 2}, {2, 1, 3}}));
  EXPECT_EQ(whole.frames[0][3], (Point{1, 1, 0}));
  const auto triangles = importFrom(write("b.gltf", file.text()));
  EXPECT_EQ(pairsIn(*triangles, 0), (PairCounts{1, 0}));
}

// ---- Nodes and scenes.

TEST_F(GltfImports, NodesPlaceMeshes) {
  GltfFile file;
  const auto triangle = file.triangle();
  // Column by column: x becomes 2 y, y becomes -x; moved by 10 along z.
  const Json turn = {0, 2, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 10, 1};
  const double half = std::numbers::sqrt2 / 2;
  file.add("nodes", {{"mesh", triangle}, {"matrix", turn}, {"children", {1}}});
  file.add("nodes", {{"mesh", triangle}, {"translation", {1, 2, 3}}, {"scale", {-1, 3, 1}}});
  file.add("nodes", {{"mesh", triangle}, {"rotation", {0, 0, half, half}}, {"scale", {2, 1, 1}}});
  const std::vector<Point> points = pointsOf(file);
  ASSERT_EQ(points.size(), 9U);
  EXPECT_EQ(points[1], (Point{0, 2, 10}));
  EXPECT_EQ(points[2], (Point{-1, 0, 10}));
  EXPECT_EQ(points[3], (Point{-2, 2, 13}));
  EXPECT_EQ(points[4], (Point{-2, 0, 13}));
  EXPECT_EQ(points[5], (Point{-5, 2, 13}));
  EXPECT_NEAR(points[7][0], 0, 1e-6);
  EXPECT_NEAR(points[7][1], 2, 1e-6);
  EXPECT_NEAR(points[8][0], -1, 1e-6);
}

TEST_F(GltfImports, OneSceneIsShown) {
  GltfFile file;
  for (const int x : {0, 10, 20}) file.triangleNode({{"translation", {x, 0, 0}}});
  const auto xs = [&] {
    std::vector<float> all;
    const std::vector<Point> points = pointsOf(file);
    for (std::size_t i = 0; i < points.size(); i += 3) all.push_back(points[i][0]);
    return all;
  };
  EXPECT_THAT(xs(), ElementsAre(0, 10, 20)) << "all roots";
  file.json["scenes"] = {{{"nodes", {2}}}, {{"name", "other"}, {"nodes", {1, 0}}}};
  EXPECT_THAT(xs(), ElementsAre(20)) << "the first one";
  file.json["scene"] = 1;
  EXPECT_THAT(xs(), ElementsAre(10, 0));
  const ImportSummary summary = contents(file).summary;
  EXPECT_EQ(summary.units, "m");
  EXPECT_THAT(summary.used, ElementsAre("scene 'other'", "2 meshes at 2 nodes"));
  EXPECT_THAT(summary.left_out, ElementsAre("scene 0", "1 node with a mesh, outside of the scene"));
  file.json["scenes"][1]["nodes"] = Json::array();
  EXPECT_THAT(refusal(file), HasSubstr("no vertices"));
}

TEST_F(GltfImports, DamagedNodes) {
  const auto refused = [&](const Json& nodes, const Json& more = Json::object()) {
    GltfFile file;
    file.triangle();
    file.json["nodes"] = nodes;
    file.json.update(more);
    return refusal(file);
  };
  EXPECT_THAT(refused({{{"mesh", 0}, {"children", {0}}}}), HasSubstr("nodes[0]: is its own desc"));
  EXPECT_THAT(refused({{{"mesh", 0}}, {{"children", {2}}}, {{"children", {1}}}}),
              HasSubstr("is its own descendant"));
  EXPECT_THAT(refused({{{"children", {1}}}, {{"mesh", 0}}, {{"children", {1}}}}),
              HasSubstr("nodes[2]: nodes[1] is its child, but also one of nodes[0]"));
  EXPECT_THAT(refused({{{"children", {1, 1}}}, {{"mesh", 0}}}), HasSubstr("but also one of"));
  EXPECT_THAT(refused({{{"children", {1}}}, {{"mesh", 0}}}, {{"scenes", {{{"nodes", {1}}}}}}),
              HasSubstr("scenes[0]: nodes[1] is not a root: it is a child of nodes[0]"));
  EXPECT_THAT(refused({{{"mesh", 0}}}, {{"scenes", {{{"nodes", {0, 0}}}}}}),
              HasSubstr("scenes[0]: lists nodes[0] twice"));
  EXPECT_THAT(refused({{{"mesh", 0}, {"children", {5}}}}),
              HasSubstr("children: nodes[5] does not"));
  EXPECT_THAT(refused({{{"mesh", 1}}}), HasSubstr("nodes[0]: mesh: meshes[1] does not exist"));
  EXPECT_THAT(refused({{{"mesh", -1}}}), HasSubstr("nodes[0]: mesh: an integer from 0"));
  EXPECT_THAT(refused({{{"mesh", 0.5}}}), HasSubstr("nodes[0]: mesh: an integer from 0"));
  EXPECT_THAT(refused({{{"mesh", 0}, {"skin", 0}}}), HasSubstr("skins[0] does not exist"));
  EXPECT_THAT(refused({{{"mesh", 0}, {"translation", {1, 2}}}}), HasSubstr("3 are expected"));
  EXPECT_THAT(refused({{{"mesh", 0}, {"rotation", {0, 0, 0, 2}}}}), HasSubstr("of length 2"));
  EXPECT_THAT(refused({{{"mesh", 0}, {"rotation", {0, 0, 0, 0}}}}), HasSubstr("of length 0"));
  const Json projection = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_THAT(refused({{{"mesh", 0}, {"matrix", projection}}}), HasSubstr("last row"));
  const Json unit = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_THAT(refused({{{"mesh", 0}, {"matrix", unit}, {"scale", {1, 1, 1}}}}),
              HasSubstr("a matrix, or translation, rotation and scale"));
  GltfFile file;
  file.triangle();
  file.json["nodes"] = {{{"mesh", 0.0}, {"matrix", unit}}};
  EXPECT_EQ(pointsOf(file).size(), 3U) << "integers may be written as 0.0";
}

TEST_F(GltfImports, ADeepHierarchyNeedsNoStack) {
  GltfFile file;
  file.triangle();
  constexpr int kDepth = 100'000;
  for (int i = 0; i < kDepth; ++i) file.add("nodes", {{"children", {i + 1}}});
  file.add("nodes", {{"mesh", 0}});
  EXPECT_EQ(pointsOf(file).size(), 3U);
}

TEST_F(GltfImports, InstancesOfAnExtension) {
  GltfFile file;
  const Json attributes = {
      {"TRANSLATION", file.floats("VEC3", {0, 0, 0, 5, 0, 0})},
      {"ROTATION",
       file.accessor<std::int8_t>("VEC4", {0, 0, 0, 127, 0, 0, 127, 0}, {{"normalized", true}})},
      {"SCALE", file.floats("VEC3", {1, 1, 1, 2, 2, 2})},
      {"_ID", 99}};
  file.triangleNode({{"translation", {0, 0, 1}},
                     {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}});
  file.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  const Contents read = contents(file);
  EXPECT_EQ(read.topology.triangles, (std::vector<imports::Triangle>{{0, 1, 2}, {3, 4, 5}}));
  EXPECT_EQ(read.frames[0][1], (Point{1, 0, 1}));
  EXPECT_EQ(read.frames[0][4], (Point{3, 0, 1}));
  EXPECT_EQ(read.frames[0][5], (Point{5, -2, 1}));
  Json& instancing = file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"];
  instancing["attributes"]["SCALE"] = file.floats("VEC3", {1, 1, 1});
  EXPECT_THAT(refusal(file), HasSubstr("2 and 1 instances"));
  instancing["attributes"] = {{"_ID", 0}};
  EXPECT_THAT(refusal(file), HasSubstr("TRANSLATION, ROTATION or SCALE is expected"));
}

TEST_F(GltfImports, HiddenNodesAreLeftOut) {
  GltfFile file;
  const Json hidden = {{"KHR_node_visibility", {{"visible", false}}}};
  file.triangleNode({{"extensions", hidden}, {"children", {1}}});
  file.triangleNode();
  file.triangleNode();
  EXPECT_EQ(pointsOf(file).size(), 3U);
  EXPECT_THAT(contents(file).summary.left_out, ElementsAre("2 nodes with a mesh, hidden"));
}

// ---- Skins and morph targets.

/// A triangle whose vertices follow joints 0, 1 and 0: nodes 1 and 2, the second one moves to
/// x = 10 within a second. The node of the mesh is elsewhere, in vain.
template <class Joint, class Weight>
GltfFile skinnedFile(const std::vector<Weight>& weights, const Json& more = Json::object()) {
  GltfFile file;
  const std::vector<Joint> joints = {0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0};
  const Json attributes = {{"POSITION", file.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0})},
                           {"JOINTS_0", file.accessor<Joint>("VEC4", joints)},
                           {"WEIGHTS_0", file.accessor<Weight>("VEC4", weights, more)}};
  file.add("nodes", {{"mesh", file.mesh(attributes)}, {"skin", 0}, {"translation", {500, 0, 0}}});
  file.add("nodes", Json::object());
  file.add("nodes", Json::object());
  file.add("skins", {{"joints", {1, 2}}});
  file.move(2, 10);
  return file;
}

TEST_F(GltfImports, WeightsOfEachTypeAttachVertices) {
  const Json normalized = {{"normalized", true}};
  const ParameterValues rate = {{"frame_rate", "1"}};
  const std::vector<Point> expected = {{0, 0, 0}, {11, 0, 0}, {5, 1, 0}};
  const auto last = [&](const GltfFile& file) { return contents(file, rate).frames.at(1); };
  EXPECT_EQ(last(skinnedFile<std::uint8_t, float>({1, 0, 0, 0, 1, 0, 0, 0, .5F, .5F, 0, 0})),
            expected);
  const auto bytes = last(skinnedFile<std::uint8_t, std::uint8_t>(
      {255, 0, 0, 0, 255, 0, 0, 0, 128, 127, 0, 0}, normalized));
  EXPECT_EQ(bytes[1], expected[1]);
  EXPECT_FLOAT_EQ(bytes[2][0], static_cast<float>(10 * 127 / 255.0));
  const auto shorts = last(skinnedFile<std::uint16_t, std::uint16_t>(
      {65535, 0, 0, 0, 65535, 0, 0, 0, 32767, 32768, 0, 0}, normalized));
  EXPECT_EQ(shorts[1], expected[1]);
  EXPECT_FLOAT_EQ(shorts[2][0], static_cast<float>(10 * 32768 / 65535.0));
}

TEST_F(GltfImports, SkinsHaveInverseBindMatricesAndSeveralSets) {
  GltfFile file = skinnedFile<std::uint8_t, float>({.5F, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  // The first vertex follows joint 1 by half, in a second set.
  Json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_1"] =
      file.accessor<std::uint16_t>("VEC4", {1, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9});
  attributes["WEIGHTS_1"] = file.floats("VEC4", {.5F, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  file.json["skins"][0]["inverseBindMatrices"] =
      file.floats("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,  //
                           2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 7, 1});
  const auto frame = contents(file, {{"frame_rate", "1"}}).frames.at(1);
  EXPECT_EQ(frame, (std::vector<Point>{{5, 0, 3.5F}, {12, 0, 7}, {0, 1, 0}}));
  EXPECT_THAT(contents(file).summary.left_out, IsEmpty());

  GltfFile short_matrices = file;
  short_matrices.json["accessors"].back()["count"] = 1;
  EXPECT_THAT(refusal(short_matrices),
              HasSubstr("skins[0]: 1 inverse bind matrices, but 2 joints"));
  attributes["WEIGHTS_1"] = file.floats("VEC4", {.5F, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0});
  EXPECT_THAT(refusal(file), HasSubstr("element 1: joint 9, but there are 2"));
  attributes.erase("WEIGHTS_1");
  EXPECT_THAT(refusal(file), HasSubstr("'WEIGHTS_1' is missing"));
  attributes.erase("JOINTS_1");
  EXPECT_THAT(refusal(file), HasSubstr("element 0: weights whose sum is 0.5: 1 is expected"));
  attributes.erase("JOINTS_0");
  EXPECT_THAT(refusal(file), HasSubstr("'JOINTS_0' is missing"));
}

TEST_F(GltfImports, MorphTargetsDisplaceVertices) {
  GltfFile file;
  const auto positions = file.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
  const Json targets = {
      {{"POSITION", file.floats("VEC3", {0, 0, 0, 3, 0, 0, 0, 0, 0})}},
      {{"NORMAL", 77}},
      {{"POSITION", file.accessor<std::int8_t>("VEC3", {0, 0, 0, 0, 0, 0, 0, 2, -4})}}};
  file.mesh({{"POSITION", positions}}, {{"targets", targets}});
  file.add("nodes", {{"mesh", 0}});
  const std::vector<Point> plain = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(pointsOf(file), plain) << "weights are 0 by default";
  file.json["meshes"][0]["weights"] = {1, 1, 0};
  EXPECT_EQ(pointsOf(file)[1], (Point{4, 0, 0}));
  file.json["nodes"][0]["weights"] = {0, 0, 0.5};
  EXPECT_EQ(pointsOf(file), (std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {0, 2, -2}}));

  GltfFile animated = file;
  animated.animate(0, "weights", animated.floats("SCALAR", {0, 1}),
                   animated.floats("SCALAR", {0, 0, 0, 2, 0, 1}));
  EXPECT_THAT(contents(animated, {{"frame_rate", "2"}}).track(1, 0), ElementsAre(1, 4, 7));
  EXPECT_THAT(contents(animated, {{"frame_rate", "2"}}).track(2, 2), ElementsAre(0, -2, -4));
  // For each key: in-tangents, values and out-tangents, each of all targets.
  GltfFile cubic = file;
  cubic.animate(0, "weights", cubic.accessor<std::uint8_t>("SCALAR", {0, 2}),
                cubic.accessor<std::uint8_t>(
                    "SCALAR", {9, 9, 9, 0, 0, 0, 4, 0, 0, 0, 0, 0, 1, 0, 0, 9, 9, 9}),
                "CUBICSPLINE");
  // At half the time: 4 * 2 s / 8 of the tangent, half of the value 1.
  EXPECT_THAT(contents(cubic, {{"frame_rate", "1"}}).track(1, 0), ElementsAre(1, 5.5F, 4));

  file.json["nodes"][0]["weights"] = {1};
  EXPECT_THAT(refusal(file), HasSubstr("nodes[0]: 1 weights, but 3 morph targets"));
  const std::size_t output = animated.json["animations"][0]["samplers"][0]["output"];
  animated.json["accessors"][output]["count"] = 4;
  EXPECT_THAT(refusal(animated), HasSubstr("nodes[0]: 2 weights, but 3 morph targets"));
  file.json["nodes"][0].erase("weights");
  file.json["meshes"][0]["weights"] = {1, 1};
  EXPECT_THAT(refusal(file), HasSubstr("meshes[0]: 2 weights, but 3 morph targets"));
}

// ---- Animations.

TEST_F(GltfImports, StepsHoldTheirValue) {
  GltfFile file;
  file.triangleNode();
  file.animate(0, "translation", file.floats("SCALAR", {0, 1, 2}),
               file.floats("VEC3", {0, 0, 0, 10, 0, 0, 20, 0, 0}), "STEP");
  EXPECT_THAT(contents(file, {{"frame_rate", "4"}}).track(0, 0),
              ElementsAre(0, 0, 0, 0, 10, 10, 10, 10, 20));
}

TEST_F(GltfImports, FramesHitKeysThatWereRounded) {
  // As 32-bit floats, some keys are later than the frame's time, others earlier.
  for (const int rate : {3, 7, 10, 24, 30, 60, 1000}) {
    GltfFile file;
    file.triangleNode();
    std::vector<float> times;
    std::vector<float> positions;
    for (int key = 0; key <= 100; ++key) {
      times.push_back(static_cast<float>(key) * (1.F / static_cast<float>(rate)));
      positions.insert(positions.end(), {static_cast<float>(key), 0, 0});
    }
    file.animate(0, "translation", file.floats("SCALAR", times), file.floats("VEC3", positions),
                 "STEP");
    const std::vector<float> track =
        contents(file, {{"frame_rate", std::to_string(rate)}}).track(0, 0);
    ASSERT_EQ(track.size(), 101U) << rate;
    for (std::size_t frame = 0; frame <= 100; ++frame) {
      EXPECT_EQ(track[frame], static_cast<float>(frame)) << rate;
    }
  }
}

TEST_F(GltfImports, NodesOfOneNameAreTwo) {
  GltfFile file;
  file.triangleNode({{"name", "Cube"}});
  file.triangleNode({{"name", "Cube"}, {"translation", {0, 5, 0}}});
  file.move(0, 10);
  const Contents read = contents(file, {{"frame_rate", "2"}});
  EXPECT_THAT(read.track(0, 0), ElementsAre(0, 5, 10));
  EXPECT_THAT(read.track(3, 0), ElementsAre(0, 0, 0));
  EXPECT_THAT(read.track(3, 1), ElementsAre(5, 5, 5));
}

TEST_F(GltfImports, RotationsTakeTheShortWay) {
  const float half = std::numbers::sqrt2_v<float> / 2;
  const auto turned = [&](auto add_values, const std::string& interpolation) {
    GltfFile file;
    file.triangleNode();
    file.animate(0, "rotation", file.floats("SCALAR", {0, 1}), add_values(file), interpolation);
    return contents(file, {{"frame_rate", "3"}}).frames;
  };
  // A quarter turn about z; the second quaternion has the other sign.
  const auto linear =
      turned([&](GltfFile& file) { return file.floats("VEC4", {0, 0, 0, 1, 0, 0, -half, -half}); },
             "LINEAR");
  const auto shorts = turned(
      [&](GltfFile& file) {
        return file.accessor<std::int16_t>("VEC4", {0, 0, 0, 32767, 0, 0, 23170, 23170},
                                           {{"normalized", true}});
      },
      "LINEAR");
  for (std::size_t frame = 0; frame <= 3; ++frame) {
    const double angle = static_cast<double>(frame) * std::numbers::pi / 6;
    for (const auto& frames : {linear, shorts}) {
      EXPECT_NEAR(frames.at(frame)[1][0], std::cos(angle), 1e-6);
      EXPECT_NEAR(frames.at(frame)[1][1], std::sin(angle), 1e-6);
    }
  }
  // Values between keys are normalised: tangents of 0 make no other length.
  const auto cubic = turned(
      [&](GltfFile& file) {
        return file.floats("VEC4", {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0,  //
                                    0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0});
      },
      "CUBICSPLINE");
  const double t = 1 / 3.0;
  const double b = 3 * t * t - 2 * t * t * t;
  const double angle = 2 * std::atan2(b, 1 - b);
  EXPECT_NEAR(cubic.at(1)[1][0], std::cos(angle), 1e-6);
  EXPECT_NEAR(cubic.at(1)[1][1], std::sin(angle), 1e-6);
  EXPECT_NEAR(cubic.at(3)[1][0], -1, 1e-6);
}

TEST_F(GltfImports, CubicSplinesHaveTangents) {
  GltfFile file;
  file.triangleNode();
  file.animate(0, "translation", file.floats("SCALAR", {1, 3}),
               file.floats("VEC3", {99, 99, 99, 1, 0, 0, 4, 0, 0,  //
                                    2, 0, 0, 5, 0, 0, 99, 99, 99}),
               "CUBICSPLINE");
  const auto at = [](double t) {
    const double cubed = t * t * t;
    return static_cast<float>((2 * cubed - 3 * t * t + 1) * 1 + 2 * (cubed - 2 * t * t + t) * 4 +
                              (3 * t * t - 2 * cubed) * 5 + 2 * (cubed - t * t) * 2);
  };
  // Before its first key an animation stands still.
  EXPECT_THAT(contents(file, {{"frame_rate", "2"}}).track(0, 0),
              ElementsAre(1, 1, 1, at(0.25), at(0.5), at(0.75), 5));
}

TEST_F(GltfImports, AllAnimationsPlayTogether) {
  GltfFile file;
  file.triangleNode();
  file.triangleNode({{"scale", {2, 2, 2}}});
  file.move(0, 10, 0);
  file.animate(1, "translation", file.floats("SCALAR", {0, 2}),
               file.floats("VEC3", {0, 0, 0, 0, 20, 0}), "LINEAR", 1);
  file.json["animations"][0]["name"] = "walk";
  const ParameterValues rate = {{"frame_rate", "1"}};
  const Contents all = contents(file, rate);
  EXPECT_THAT(all.track(0, 0), ElementsAre(0, 10, 10)) << "the shorter one stays at its end";
  EXPECT_THAT(all.track(3, 1), ElementsAre(0, 10, 20));
  EXPECT_THAT(all.track(4, 0), ElementsAre(2, 2, 2));
  EXPECT_THAT(all.summary.used, AllOf(Contains("animation 'walk'"), Contains("animation 1")));
  const auto with = [&](const std::string& animation) {
    return ParameterValues{{"frame_rate", "1"}, {"animation", animation}};
  };
  EXPECT_THAT(contents(file, with("walk")).track(0, 0), ElementsAre(0, 10));
  EXPECT_THAT(contents(file, with("0")).track(0, 0), ElementsAre(0, 10));
  const Contents second = contents(file, with("1"));
  EXPECT_THAT(second.track(0, 0), ElementsAre(0, 0, 0));
  EXPECT_THAT(second.track(3, 1), ElementsAre(0, 10, 20));
  EXPECT_THAT(second.summary.used, Contains("animation 1 of 2"));
  EXPECT_THAT(refusal(file, with("run")),
              HasSubstr("no --animation 'run': the file has 'walk', 1"));
  EXPECT_THAT(refusal(file, with("2")), HasSubstr("no --animation '2'"));
  file.json["animations"][1]["name"] = "walk";
  EXPECT_THAT(refusal(file, with("walk")), HasSubstr("choose --animation 0 or 1"));
  file.json.erase("animations");
  EXPECT_THAT(refusal(file, with("walk")), HasSubstr("the file has none"));
  EXPECT_THAT(complaint("a.obj", "v 0 0 0\n", {{"animation", "walk"}}), HasSubstr("--animation"));
}

TEST_F(GltfImports, AnimationsThatDriveTheSame) {
  GltfFile file;
  file.triangleNode();
  file.move(0, 1, 0);
  file.move(0, 2, 1);
  file.json["animations"][0]["name"] = "walk";
  file.json["animations"][1]["name"] = "run";
  EXPECT_THAT(refusal(file),
              HasSubstr("animations 'walk' and 'run' both drive nodes[0].translation:"
                        " choose one by --animation: 'walk', 'run'"));
  EXPECT_THAT(contents(file, {{"frame_rate", "1"}, {"animation", "run"}}).track(0, 0),
              ElementsAre(0, 2));
  file.move(0, 3, 1);
  EXPECT_THAT(refusal(file, {{"animation", "run"}}),
              HasSubstr("animations[1]: drives nodes[0].translation twice"));
}

TEST_F(GltfImports, DamagedAnimations) {
  const auto refused = [&](const std::string& path, const std::vector<float>& times,
                           const std::string& type, const std::vector<float>& values,
                           const std::string& interpolation = "LINEAR") {
    GltfFile file;
    file.triangleNode();
    file.animate(0, path, file.floats("SCALAR", times), file.floats(type, values), interpolation);
    return refusal(file);
  };
  const std::vector<float> two = {0, 0, 0, 1, 1, 1};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(refused("translation", {1, 0}, "VEC3", two), HasSubstr("key 1 is at 0 s: ascending"));
  EXPECT_THAT(refused("translation", {1, 1}, "VEC3", two), HasSubstr("key 1 is at 1 s"));
  EXPECT_THAT(refused("translation", {-1, 1}, "VEC3", two), HasSubstr("key 0 is at -1 s"));
  EXPECT_THAT(refused("translation", {0, nan}, "VEC3", two), HasSubstr("key 1 is at nan s"));
  EXPECT_THAT(refused("translation", {}, "VEC3", {}), HasSubstr("has no keys"));
  EXPECT_THAT(refused("translation", {0, 1, 2}, "VEC3", two), HasSubstr("3 keys need 3 elements"));
  EXPECT_THAT(refused("translation", {0, 1}, "VEC3", two, "CUBICSPLINE"),
              HasSubstr("2 keys need 6 elements of output, but there are 2"));
  EXPECT_THAT(refused("translation", {0, 1}, "VEC3", two, "SMOOTH"), HasSubstr("'SMOOTH'"));
  EXPECT_THAT(refused("rotation", {0, 1}, "VEC3", two), HasSubstr("VEC4 is expected"));
  EXPECT_THAT(refused("rotation", {0}, "VEC4", {1, 1, 1, 1}), HasSubstr("of length 2"));
  EXPECT_THAT(refused("color", {0, 1}, "VEC3", two), HasSubstr("path 'color'"));
  EXPECT_THAT(refused("translation", {0, 1e30F}, "VEC3", two), HasSubstr("--frame-rate"));
  EXPECT_THAT(refused("weights", {0, 1}, "SCALAR", {0, 1}), HasSubstr("1 weights, but 0 morph"));
  GltfFile matrix;
  matrix.triangleNode({{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}});
  matrix.move(0, 1);
  EXPECT_THAT(refusal(matrix), HasSubstr("nodes[0]: is animated, but has a matrix"));
  GltfFile sampler;
  sampler.triangleNode();
  sampler.move(0, 1);
  sampler.json["animations"][0]["channels"][0]["sampler"] = 1;
  EXPECT_THAT(refusal(sampler), HasSubstr("sampler 1 does not exist: there are 1"));
}

TEST_F(GltfImports, ChannelsOfNoNode) {
  GltfFile file;
  file.triangleNode();
  file.move(0, 1);
  const auto target = [&](const std::string& pointer) {
    file.json["animations"][0]["channels"][0]["target"] = {
        {"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
  };
  target("/materials/0/alphaCutoff");
  EXPECT_THAT(contents(file).summary.left_out,
              ElementsAre("animation of /materials/0/alphaCutoff"));
  target("/nodes/0/translation");
  EXPECT_THAT(refusal(file), HasSubstr("KHR_animation_pointer, which is not supported"));
  file.json["animations"][0]["channels"][0]["target"] = {{"path", "translation"}};
  EXPECT_THAT(contents(file).summary.left_out, ElementsAre("an animation channel without a node"));
}

// ---- Files.

TEST_F(GltfImports, BinaryFiles) {
  GltfFile file;
  file.triangleNode();
  const std::vector<Point> expected = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  for (const std::string padding : {"", "   ", "\n", "\t\n "}) {
    const Contents read = contentsOf(write("a.glb", file.binary(padding)));
    EXPECT_EQ(read.frames.at(0), expected);
    EXPECT_EQ(read.summary.format, "binary glTF 2.0");
    EXPECT_THAT(read.summary.left_out, IsEmpty());
  }
  // The kind is in the first bytes, not in the name.
  EXPECT_EQ(contentsOf(write("a.gltf", file.binary())).frames.at(0), expected);
  EXPECT_EQ(contentsOf(write("a.glb", file.text())).frames.at(0), expected);
  EXPECT_EQ(contentsOf(write("a.gltf", "\xEF\xBB\xBF" + file.text())).frames.at(0), expected);
  EXPECT_THAT(contentsOf(write("a.glb", file.binary() + "more")).summary.left_out,
              ElementsAre("4 bytes after the end"));
  // Unknown chunks are skipped.
  std::string more = file.binary() + GltfFile::number(4) + "MOREdata";
  more.replace(8, 4, GltfFile::number(more.size()));
  EXPECT_EQ(contentsOf(write("a.glb", more)).frames.at(0), expected);
}

TEST_F(GltfImports, ACutFileIsRefusedWhereverItEnds) {
  GltfFile file;
  file.triangleNode();
  const std::string binary = file.binary();
  const std::string text = file.text();
  for (std::size_t size = 0; size < binary.size(); ++size) {
    std::string cut = binary.substr(0, size);
    EXPECT_THAT(refusalOf(cut), HasSubstr("a.gltf: ")) << size;
    if (size < 12) continue;
    // A file whose header states its length.
    cut.replace(8, 4, GltfFile::number(size));
    EXPECT_THAT(refusalOf(cut), HasSubstr("a.gltf: ")) << size;
  }
  for (std::size_t size = 0; size < text.size(); ++size) {
    EXPECT_THAT(refusalOf(text.substr(0, size)), HasSubstr("a.gltf: ")) << size;
  }
}

TEST_F(GltfImports, BuffersInOtherFiles) {
  GltfFile file;
  file.triangleNode();
  const auto with = [&](const std::string& uri) { return file.withBuffer({{"uri", uri}}); };
  const auto read = [&](const std::string& uri) {
    return contentsOf(write("sub/a.gltf", with(uri))).frames.at(0).size();
  };
  write("sub/my buf.bin", file.bytes);
  write("sub/100%.bin", file.bytes + "and more");
  write("sub/a%20b.bin", file.bytes);
  write("sub/\xC3\xA4.bin", file.bytes);
  write("other/b.bin", file.bytes);
  EXPECT_EQ(read("my%20buf.bin"), 3U);
  EXPECT_EQ(read("my buf.bin"), 3U);
  EXPECT_EQ(read("./my%20buf.bin"), 3U);
  EXPECT_EQ(read("100%25.bin"), 3U);
  EXPECT_EQ(read("100%.bin"), 3U);
  EXPECT_EQ(read("a%20b.bin"), 3U) << "a file of that very name";
  EXPECT_EQ(read("%c3%A4.bin"), 3U);
  EXPECT_EQ(read("../other/b.bin"), 3U);
  const auto refused = [&](const std::string& uri) { return refusalOf(with(uri)); };
  EXPECT_THAT(refused("none.bin"), AllOf(HasSubstr("a.gltf: buffers[0]: "), HasSubstr("none.bin")));
  EXPECT_THAT(refused("https://host/b.bin"), HasSubstr("'https://host/b.bin' is not read"));
  EXPECT_THAT(refused("file:///etc/passwd"), HasSubstr("is not read"));
  EXPECT_THAT(refused("/etc/passwd"), HasSubstr("is not read"));
  EXPECT_THAT(refused("%2Fetc%2Fpasswd"), HasSubstr("is not the name of a file"));
  EXPECT_THAT(refused("b%00.bin"), HasSubstr("is not the name of a file"));
  EXPECT_THAT(refused(""), HasSubstr("is not the name of a file"));
  EXPECT_THAT(refused("../other"), HasSubstr("buffers[0]: "));
  write("short.bin", file.bytes.substr(1));
  EXPECT_THAT(refused("short.bin"), HasSubstr("buffers[0]: 36 bytes are stated, but there are 35"));
}

TEST_F(GltfImports, BuffersInDataUris) {
  GltfFile file;
  file.triangleNode();
  const std::string digits = base64(file.bytes);
  const auto read = [&](const std::string& uri) {
    return contentsOf(write("a.gltf", file.withBuffer({{"uri", uri}}))).frames.at(0).size();
  };
  EXPECT_EQ(read("data:;base64," + digits), 3U);
  EXPECT_EQ(read("data:application/gltf-buffer;base64," + digits), 3U);
  std::string escaped;
  for (const char c : file.bytes) escaped += fmt::format("%{:02x}", static_cast<unsigned char>(c));
  EXPECT_EQ(read("data:application/octet-stream," + escaped), 3U);
  const auto refused = [&](const std::string& uri) {
    return refusalOf(file.withBuffer({{"uri", uri}}));
  };
  EXPECT_THAT(refused("data:;base64," + digits.substr(4)), HasSubstr("36 bytes are stated"));
  EXPECT_THAT(refused("data:;base64,!" + digits), HasSubstr("damaged base 64"));
  EXPECT_THAT(refused("data:;base64," + digits + "A"), HasSubstr("damaged base 64"));
  EXPECT_THAT(refused("data:nothing"), HasSubstr("without a comma"));
  EXPECT_THAT(refusalOf(file.withBuffer(Json::object())), HasSubstr("has no bytes"));
}

TEST_F(GltfImports, ExtensionsAreSupportedOrRefused) {
  const auto file_with = [](const Json& more) {
    GltfFile file;
    file.triangleNode();
    file.json.update(more);
    return file;
  };
  for (const char* name : {"EXT_meshopt_compression", "KHR_draco_mesh_compression", "ACME_new"}) {
    EXPECT_THAT(refusal(file_with({{"extensionsRequired", {name}}})),
                HasSubstr(fmt::format("requires the extension {}, which is not supported", name)));
  }
  const Contents used = contents(file_with(
      {{"extensionsUsed", {"ACME_new", "KHR_materials_unlit", "KHR_texture_transform"}},
       {"extensionsRequired", {"KHR_texture_transform"}},
       {"cameras", {Json::object()}},
       {"extensions", {{"KHR_lights_punctual", {{"lights", {Json::object(), Json::object()}}}}}}}));
  EXPECT_THAT(used.summary.left_out, ElementsAre("extension ACME_new", "1 camera", "2 lights"));
  // Compressed, though another copy may be there.
  GltfFile meshopt = file_with({{"extensionsUsed", {"EXT_meshopt_compression"}}});
  meshopt.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0}};
  EXPECT_THAT(refusal(meshopt), HasSubstr("bufferViews[0]: its bytes are compressed with "
                                          "EXT_meshopt_compression, which is not supported"));
  GltfFile draco = file_with({{"extensionsUsed", {"KHR_draco_mesh_compression"}}});
  draco.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", 0}};
  EXPECT_THAT(refusal(draco), HasSubstr("primitives[0]: is compressed with "
                                        "KHR_draco_mesh_compression"));
  EXPECT_THAT(refusal(file_with({{"asset", {{"version", "1.0"}}}})), HasSubstr("glTF 1.0: 2.0 is"));
  EXPECT_THAT(refusal(file_with({{"asset", {{"version", "2.1"}, {"minVersion", "2.1"}}}})),
              HasSubstr("glTF 2.1: 2.0 is"));
  EXPECT_EQ(contents(file_with({{"asset", {{"version", "2.1"}}}})).topology.vertices, 3U);
}

TEST_F(GltfImports, DamagedAccessors) {
  const auto refused = [&](const char* list, const Json& more) {
    GltfFile file;
    file.triangleNode();
    file.json[list][0].update(more);
    return refusal(file);
  };
  EXPECT_THAT(refused("accessors", {{"count", 4}}),
              HasSubstr("accessors[0]: 4 elements need 48 bytes, but its buffer view has 36"));
  EXPECT_THAT(refused("accessors", {{"byteOffset", 4}}), HasSubstr("but its buffer view has 32"));
  EXPECT_THAT(refused("accessors", {{"byteOffset", 1ULL << 61}}),
              HasSubstr("is beyond its buffer"));
  EXPECT_THAT(refused("accessors", {{"byteOffset", ~0ULL}}), HasSubstr("an integer from 0"));
  EXPECT_THAT(refused("accessors", {{"count", 1ULL << 32}}), HasSubstr("count: an integer from 0"));
  EXPECT_THAT(refused("accessors", {{"count", 4294967295}}), HasSubstr("cut short"));
  EXPECT_THAT(refused("accessors", {{"componentType", 5130}}), HasSubstr("componentType 5130"));
  EXPECT_THAT(refused("accessors", {{"type", "VEC4"}}), HasSubstr("48 bytes"));
  EXPECT_THAT(refused("accessors", {{"type", "VEC2"}}), HasSubstr("type 'VEC2' is not read here"));
  EXPECT_THAT(refused("accessors", {{"type", "SCALAR"}}),
              HasSubstr("POSITION: VEC3 is expected, not accessors[0] of SCALAR"));
  EXPECT_THAT(refused("bufferViews", {{"byteLength", 37}}),
              HasSubstr("bufferViews[0]: 37 bytes at 0 are beyond buffers[0], which has 36"));
  EXPECT_THAT(refused("bufferViews", {{"byteOffset", 1ULL << 61}}), HasSubstr("are beyond"));
  EXPECT_THAT(refused("bufferViews", {{"byteStride", 8}}), HasSubstr("the byteStride is 8"));
  EXPECT_THAT(refused("bufferViews", {{"buffer", 1}}), HasSubstr("buffers[1] does not exist"));
  EXPECT_THAT(refused("meshes", {{"primitives", 3}}),
              HasSubstr("primitives: an array is expected"));
}

TEST_F(GltfImports, AFewBytesTakeLittleMemory) {
  // 4 billion vertices, without a byte of them.
  GltfFile file;
  const auto zeros =
      file.add("accessors", {{"componentType", 5126}, {"count", 4294967295}, {"type", "VEC3"}});
  file.add("nodes", {{"mesh", file.mesh({{"POSITION", zeros}})}});
  EXPECT_THAT(refusal(file), HasSubstr("takes more than 4096 MiB to read"));
  // Few vertices, at many places.
  GltfFile instances;
  const auto places = instances.add(
      "accessors", {{"componentType", 5126}, {"count", 4000000000}, {"type", "VEC3"}});
  instances.triangleNode(
      {{"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", places}}}}}}}});
  EXPECT_THAT(refusal(instances), HasSubstr("takes more than"));
}

TEST_F(GltfImports, NoDamageCrashesUs) {
  GltfFile file = skinnedFile<std::uint8_t, std::uint8_t>(
      {255, 0, 0, 0, 255, 0, 0, 0, 128, 127, 0, 0}, {{"normalized", true}});
  const std::string whole = file.binary();
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string bytes = whole;
    bytes[i] ^= static_cast<char>(1 << i % 8);
    const auto damaged = overwrite("damaged.glb", bytes);
    try {
      const Contents read = contentsOf(damaged, {{"frame_rate", "2"}});
      for (const imports::Triangle& triangle : read.topology.triangles) {
        for (const Index vertex : triangle) ASSERT_LT(vertex, read.topology.vertices);
      }
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("damaged.glb: "));
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  }
  for (const char* nothing : {"", "nothing of the kind", "{}", "[]", "null", "{\"asset\": 1}"}) {
    EXPECT_THAT(refusalOf(nothing), HasSubstr("a.gltf")) << nothing;
  }
  EXPECT_THAT(inputErrorOf([&] { contentsOf(directory_ / "none.gltf"); }),
              HasSubstr("cannot read"));
}

}  // namespace
}  // namespace broadmark::tests
