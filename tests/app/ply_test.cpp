// PLY files: what is read, and what is refused.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "app/mesh_imports.h"
#include "broadmark/recordings/swept_frames.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

using imports::readPly;
using imports::Triangle;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using Line = std::array<std::uint32_t, 2>;

using PlyImports = MeshImports;

std::filesystem::path plyData(const std::string& name) {
  return places::source("tests/data/" + name);
}

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
const std::string kThree = "0 0 0\n1 0 0\n0 1 0\n";

/// A PLY file as text with three vertices, and other elements.
std::string plyText(const std::string& elements, const std::string& rows) {
  return "ply\nformat ascii 1.0\nelement vertex 3\n" + kXyz + elements + "end_header\n" + kThree +
         rows;
}

TEST_F(PlyImports, TheFirstByteOfPlyDataMayBeAny) {
  for (const bool big_endian : {false, true}) {
    for (const std::string end : {"\n", "\r\n", "\r"}) {
      for (const int first : {0x0A, 0x0D, 0x20, 0x00, 0xFF}) {
        BinaryText bytes(big_endian);
        for (const char* line :
             {"ply",
              big_endian ? "format binary_big_endian 1.0" : "format binary_little_endian 1.0",
              "comment end_header", "obj_info\t1", "element vertex 1", "property uchar x",
              "property uchar y", "property float z", "end_header"}) {
          bytes.text += line + end;
        }
        bytes.integer(static_cast<std::uint64_t>(first), 1);
        bytes.integer(10, 1);
        bytes.real(2.5F);
        const MeshContents mesh = readWith(readPly, bytes.text);
        EXPECT_THAT(mesh.points, ElementsAre(imports::Point{static_cast<float>(first), 10, 2.5F}));
        EXPECT_THAT(mesh.summary.left_out, IsEmpty());
        EXPECT_EQ(mesh.summary.format,
                  big_endian ? "binary PLY, big-endian" : "binary PLY, little-endian");
      }
    }
  }
}

TEST_F(PlyImports, PlyStripsAreTriangles) {
  std::string rows;
  for (int i = 0; i < 12; ++i) rows += fmt::format("{} {} 0\n", i / 2, i % 2);
  const std::string header = "ply\nformat ascii 1.0\nelement vertex 12\n" + kXyz +
                             "element tristrips 1\nproperty list int int vertex_indices\n"
                             "end_header\n" +
                             rows;
  EXPECT_THAT(readWith(readPly, header + "12 0 1 2 3 4 5 6 7 8 9 10 11\n").topology.triangles,
              SizeIs(10));
  const auto cut = readWith(readPly, header + "11 0 1 2 3 -1 4 5 6 -1 7 8").topology.triangles;
  EXPECT_THAT(cut, ElementsAre(Triangle{0, 1, 2}, Triangle{1, 2, 3}, Triangle{4, 5, 6}));
  // A strip that turns repeats vertices.
  EXPECT_THAT(readWith(readPly, header + "6 0 1 2 2 3 4").topology.triangles,
              ElementsAre(Triangle{0, 1, 2}, Triangle{2, 3, 4}));
  EXPECT_THAT(refusal(readPly, header + "3 0 1 -2"),
              HasSubstr("names vertex -2, but there are 12"));
}

TEST_F(PlyImports, PlyEdgesAreLines) {
  const std::string text = plyText(
      "element edge 2\nproperty uchar red\nproperty int vertex2\n"
      "property int vertex1\n",
      "9 1 0\n9 2 1\n");
  EXPECT_THAT(readWith(readPly, text).topology.lines, ElementsAre(Line{0, 1}, Line{1, 2}));
  const auto edges = read("a.ply", text, {{"elements", "edges"}});
  EXPECT_EQ(edges->scene().objects, 2U);
  EXPECT_EQ(boxesOf(*edges, 0)[0], boxOf({0, 0, 0}, {1, 0, 0}));
  EXPECT_FALSE(edges->scene().filter.wanted(0, 1)) << "they share vertex 1";
  EXPECT_EQ(read("a.ply", text, {{"elements", "all"}})->scene().objects, 3U + 2);
  EXPECT_THAT(complaint("a.ply", text), HasSubstr("--elements"));
  EXPECT_THAT(refusal(readPly, plyText("element edge 1\nproperty int vertex1\n", "0\n")),
              HasSubstr("'edge' has no number 'vertex2'"));
}

TEST_F(PlyImports, PlyElementsMayBeInAnyOrder) {
  const std::string text =
      "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nelement camera 1\r\n"
      "property list uchar float lens\r\nproperty float far\r\nelement face 2\r\n"
      "property list uchar double weights\r\nproperty list char uint vertex_index\r\n"
      "property uchar red\r\nelement nothing 7\r\nelement empty 0\r\nproperty int a\r\n"
      "element vertex 4\r\nproperty float nx\r\nproperty double z\r\nproperty float x\r\n"
      "property list int int rings\r\nproperty short y\r\nend_header\r\n"
      "2 1.5 nan 7\r\n0 3 0 1 2 255\r\n1 inf 4 0 1 2 3 255\r\n\r\n"
      "nan 1 2 0 3\r\n0 4 5 2 9 9 6\r\n0 7 8 1\r\n0 9\r\n0 1e-320 0.1 0 -5\r\n";
  const MeshContents mesh = readWith(readPly, text);
  EXPECT_THAT(mesh.points, ElementsAre(imports::Point{2, 3, 1}, imports::Point{5, 6, 4},
                                       imports::Point{8, 9, 7}, imports::Point{0.1F, -5, 0}));
  EXPECT_THAT(mesh.topology.triangles,
              ElementsAre(Triangle{0, 1, 2}, Triangle{0, 1, 2}, Triangle{0, 2, 3}));
  EXPECT_THAT(mesh.summary.left_out, ElementsAre("element 'camera'", "element 'nothing'"));
}

TEST_F(PlyImports, DoublesOfPlyAreRoundedToTheNearest) {
  const double above = 1.0 + 0x1p-24 + 0x1p-40;  // above the middle of two floats
  const double below = 1.0 + 0x1p-24 - 0x1p-40;
  BinaryText bytes(false);
  bytes.text =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty double x\n"
      "property double y\nproperty double z\nend_header\n";
  for (const double value : {above, below, 16777217.0}) bytes.real(value);
  const MeshContents mesh = readWith(readPly, bytes.text);
  EXPECT_THAT(mesh.points, ElementsAre(imports::Point{1 + 0x1p-23F, 1, 16777216}));
  EXPECT_THAT(mesh.summary.used, ElementsAre(HasSubstr("rounded")));
}

TEST_F(PlyImports, WhatIsWrongWithPly) {
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
  const auto wrong = [&](const std::string& elements, const std::string& rows) {
    return refusal(readPly, plyText(elements, rows));
  };
  EXPECT_THAT(wrong(face, "3 0 1 3\n"),
              AllOf(HasSubstr("line 13"), HasSubstr("vertex 3, but there are 3")));
  EXPECT_THAT(wrong(face, "3 0 1 -1\n"), HasSubstr("vertex -1"));
  EXPECT_THAT(wrong(face, "3 0 1 1.5\n"), HasSubstr("vertex 1.5"));
  EXPECT_THAT(wrong(face, "3 0 1 2 0\n"), HasSubstr("row 0 of 'face' has more numbers"));
  EXPECT_THAT(wrong(face, "-1 0 1 2\n"), HasSubstr("a list of -1"));
  EXPECT_THAT(wrong(face, "200 0 1 2\n"),
              AllOf(HasSubstr("a list of 200"), HasSubstr("cut short")));
  EXPECT_THAT(wrong(face, "4 0 1 2\n"), HasSubstr("cut short"));
  EXPECT_THAT(wrong(face, "3 0 1 x\n"), HasSubstr("'x'"));
  EXPECT_THAT(wrong("element face 1\nproperty list uchar int corners\n", "3 0 1 2\n"),
              HasSubstr("'face' has no list 'vertex_indices'"));
  EXPECT_THAT(wrong("element face 1\nproperty int vertex_index\n", "3\n"), HasSubstr("no list"));
  EXPECT_THAT(wrong("element face 4000000000\nproperty list uchar int vertex_index\n", "3 0 1 2\n"),
              HasSubstr("4000000000 rows of 'face'"));
  EXPECT_THAT(wrong("element face -1\nproperty list uchar int vertex_index\n", ""),
              AllOf(HasSubstr("line 7"), HasSubstr("count")));
  EXPECT_THAT(wrong("property half w\n", ""), HasSubstr("unknown type 'half'"));
  EXPECT_THAT(wrong("property float x\n", ""), HasSubstr("a second property 'x'"));
  EXPECT_THAT(wrong("property list float int a\n", ""), HasSubstr("integer type"));
  EXPECT_THAT(wrong("property list uchar a\n", ""), HasSubstr("property list TYPE TYPE NAME"));
  EXPECT_THAT(wrong("element vertex 1\n", ""), HasSubstr("a second element 'vertex'"));
  EXPECT_THAT(wrong("elements 1\n", ""), HasSubstr("'elements'"));
  EXPECT_THAT(refusal(readPly, ""), HasSubstr("'ply'"));
  EXPECT_THAT(refusal(readPly, "PLY2\n"), HasSubstr("'ply'"));
  EXPECT_THAT(refusal(readPly, std::string(100'000, 'p')), HasSubstr("too long"));
  EXPECT_THAT(refusal(readPly, "ply\nelement vertex 1\nend_header\n"), HasSubstr("format"));
  EXPECT_THAT(refusal(readPly, "ply\nformat ascii 2.0\n"), HasSubstr("format KIND 1.0"));
  EXPECT_THAT(refusal(readPly, "ply\nformat binary_middle_endian 1.0\n"), HasSubstr("big_endian"));
  EXPECT_THAT(refusal(readPly, "ply\nformat ascii 1.0\nelement vertex 1\n"),
              HasSubstr("'end_header' is expected"));
  EXPECT_THAT(
      complaint("a.ply", "ply\nformat ascii 1.0\nelement vertex 0\n" + kXyz + "end_header\n"),
      HasSubstr("a.ply: no vertices"));
  EXPECT_THAT(refusal(readPly, "ply\nformat ascii 1.0\nend_header\n"),
              HasSubstr("no element 'vertex'"));
  EXPECT_THAT(refusal(readPly,
                      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                      "property float y\nend_header\n1 2\n"),
              HasSubstr("'vertex' has no number 'z'"));
  EXPECT_THAT(refusal(readPly,
                      "ply\nformat ascii 1.0\nelement vertex 3000000000\n" + kXyz + "end_header\n"),
              HasSubstr("2^31"));
  EXPECT_THAT(readWith(readPly, plyText(face, "2 0 1\n")).summary.left_out,
              ElementsAre("faces of fewer than three corners: 1"));
  EXPECT_THAT(readWith(readPly, plyText(face, "3 0 1 2\n9 9\n")).summary.left_out,
              ElementsAre("4 bytes after the last element"));
}

TEST_F(PlyImports, ACutPlyIsRefusedWhereverItIsCut) {
  for (const bool big_endian : {false, true}) {
    std::mt19937 random(7);
    const PlyFile ply{.mesh = randomMesh(random), .encoding = big_endian ? "big" : "little"};
    const std::string whole = ply.bytes(random);
    ASSERT_THAT(readWith(readPly, whole).points, SizeIs(ply.mesh.points.size()));
    for (std::size_t kept = 0; kept < whole.size(); ++kept) {
      EXPECT_THAT(refusal(readPly, whole.substr(0, kept)), HasSubstr("byte")) << kept;
    }
  }
  const std::string rod = readTextFile(plyData("rod-twist-3036.ply"));
  for (const std::size_t kept :
       {rod.size() - 1, rod.size() - 13, rod.size() / 2, std::size_t{300}}) {
    EXPECT_THAT(complaint("cut.ply", rod.substr(0, kept)),
                AllOf(HasSubstr("cut.ply: byte"), HasSubstr("cut short")));
  }
}

TEST_F(PlyImports, VerticesAreThoseOfThePlyFile) {
  // Two triangles and a square beside them; vertices 1 and 4 have the same position.
  const std::string ply = "ply\nformat ascii 1.0\nelement vertex 6\n" + kXyz +
                          "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
                          "0 0 0\n1 0 0\n1 1 0\n0 1 0\n1 0 0\n2 2 2\n3 0 1 2\n4 0 4 2 3\n";
  const auto vertices = read("a.ply", ply, {{"elements", "vertices"}});
  EXPECT_EQ(vertices->scene().objects, 6U);
  EXPECT_EQ(boxesOf(*vertices, 0)[5], boxOf({2, 2, 2}, {2, 2, 2}));
  EXPECT_EQ(pairsIn(*vertices, 0), (PairCounts{1, 1}));
  const auto triangles = read("a.ply", ply);
  EXPECT_EQ(triangles->scene().objects, 3U);
  // All triangles share vertex 0.
  EXPECT_EQ(pairsIn(*triangles, 0), (PairCounts{3, 0}));
}

TEST_F(PlyImports, PairsOfAnExcerptOfRodTwist) {
  // Reference counts from an independent tool; docs/import.md has those of the whole meshes.
  struct Expected {
    const char* elements;
    std::uint32_t bodies;
    PairCounts pairs;
  };
  for (const auto& [elements, bodies, pairs] :
       {Expected{"vertices", 177, {1, 1}}, Expected{"edges", 332, {7847, 7847 - 1048}},
        Expected{"triangles", 160, {4173, 4173 - 398}},
        Expected{"all", 669, {29083, 29083 - 4168}}}) {
    SweptFrames frames(importFrom(plyData("rod-twist-*.ply"), {{"elements", elements}}));
    EXPECT_EQ(frames.scene().name, "rod-twist swept");
    EXPECT_EQ(frames.scene().objects, bodies);
    EXPECT_EQ(pairsIn(frames, 1), pairs) << elements;
  }
  const auto still = importFrom(plyData("rod-twist-*.ply"), {{"elements", "edges"}});
  EXPECT_EQ(pairsIn(*still, 1), (PairCounts{6057, 6057 - 1048}));
}

TEST_F(PlyImports, NoDamageCrashesPly) {
  const std::string whole = readTextFile(plyData("rod-twist-3036.ply"));
  for (std::size_t i = 0; i < 200; ++i) {
    std::string bytes = whole;
    bytes[whole.size() * i / 200 + i % 7] ^= static_cast<char>(1 << i % 8);
    try {
      const MeshContents mesh = readWith(readPly, bytes);
      for (const Triangle& triangle : mesh.topology.triangles) {
        for (const std::uint32_t vertex : triangle) ASSERT_LT(vertex, mesh.points.size());
      }
    } catch (const InputError& error) {
      EXPECT_EQ(std::ranges::count(std::string(error.what()), '\n'), 0) << error.what();
    }
  }
}

TEST_F(PlyImports, FilesOfAnotherKind) {
  for (const char* name : {"a.ply", "a.stl", "a.obj"}) {
    EXPECT_THAT(complaint(name, "nothing of the kind"), HasSubstr(name));
    EXPECT_THAT(complaint(name, ""), HasSubstr(name));
    EXPECT_THAT(inputErrorOf([&] { importFrom(directory_ / "none" / name); }),
                HasSubstr("cannot read"));
  }
}

}  // namespace
}  // namespace broadmark::tests
