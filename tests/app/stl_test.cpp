// STL files: what is read, and what is refused.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "app/mesh_imports.h"

namespace broadmark::tests {
namespace {

using imports::readStl;
using imports::Triangle;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

using StlImports = MeshImports;

std::string facetText(const std::string& corners, const std::string& normal = "0 0 1") {
  return "facet normal " + normal + "\nouter loop\n" + corners + "endloop\nendfacet\n";
}
const std::string kFacets =
    facetText("vertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\n") +
    facetText("vertex 0 0 0\nvertex 1 1 0\nvertex 0 1 0\n", "-nan(ind) 0 0");

TEST_F(StlImports, TextOfStlIsReadHoweverItBegins) {
  const std::string plain = "solid s t\n" + kFacets + "endsolid s t\n";
  std::string capitals = plain;
  for (char& c : capitals) c = static_cast<char>(std::toupper(c));
  std::string returns = plain;
  std::ranges::replace(returns, '\n', '\r');
  for (const std::string& text :
       {plain, capitals, returns, "\n\r\n  " + plain, "\xEF\xBB\xBF" + plain,
        "solid\n" + kFacets + "endsolid\n\n \n", "solid solid facet\n" + kFacets + "\t endsolid"}) {
    const MeshContents mesh = readWith(readStl, text);
    ASSERT_THAT(mesh.points, SizeIs(6)) << text;
    EXPECT_EQ(mesh.points[5], (imports::Point{0, 1, 0}));
    EXPECT_THAT(mesh.topology.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{3, 4, 5}));
    EXPECT_THAT(mesh.summary.left_out, IsEmpty());
    EXPECT_EQ(mesh.summary.format, "ascii STL");
  }
  EXPECT_THAT(readWith(readStl, plain + "\n" + capitals).points, SizeIs(12)) << "two solids";
  EXPECT_THAT(readWith(readStl, plain + "made by hand\n").summary.left_out,
              ElementsAre("13 bytes after the last solid"));
  const std::string square = facetText("vertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\n");
  EXPECT_THAT(readWith(readStl, "solid\n" + square + "endsolid\n").topology.triangles, SizeIs(2));
}

TEST_F(StlImports, BytesOfStlAreReadHoweverTheyBegin) {
  for (const std::string header : {"", "solid by some program", "solid\nfacet"}) {
    const std::string plain = stlBytes(header, 3);
    const MeshContents mesh = readWith(readStl, plain);
    ASSERT_THAT(mesh.points, SizeIs(9)) << header;
    EXPECT_EQ(mesh.points[8], (imports::Point{0, 1, 2}));
    EXPECT_THAT(mesh.summary.left_out, IsEmpty());
    EXPECT_EQ(mesh.summary.format, "binary STL");
  }
  for (const std::string header : {"", "solid by some program", "solid\n"}) {
    const std::string plain = stlBytes(header, 3);
    const MeshContents longer = readWith(readStl, plain + "trailer");
    EXPECT_THAT(longer.points, SizeIs(9));
    EXPECT_THAT(longer.summary.left_out, ElementsAre("7 bytes after the last facet"));
    for (std::size_t kept = 0; kept < plain.size(); ++kept) {
      EXPECT_THAT(refusal(readStl, plain.substr(0, kept)), HasSubstr(fmt::format("byte {}", kept)));
    }
  }
  EXPECT_THAT(readWith(readStl, stlBytes("", 0)).points, IsEmpty());
  EXPECT_THAT(refusal(readStl, stlBytes("", 0) + "x"), HasSubstr("no facets"));
}

TEST_F(StlImports, WhatIsWrongWithTextOfStl) {
  const std::string plain = "solid s\n" + kFacets + "endsolid";
  for (std::size_t kept = 0; kept < plain.size(); ++kept) {
    EXPECT_THAT(refusal(readStl, plain.substr(0, kept)), HasSubstr("byte")) << kept;
  }
  const auto wrong = [&](const std::string& facet) {
    return refusal(readStl, "solid s\n" + kFacets + facet + "endsolid\n");
  };
  EXPECT_THAT(wrong("facets\n"), AllOf(HasSubstr("line 16"), HasSubstr("'facet' or 'endsolid'")));
  EXPECT_THAT(wrong(facetText("vertex 0 0 0\nvertex 1 0 0\n")), HasSubstr("three corners"));
  EXPECT_THAT(wrong(facetText("vertex 0 0 nan\n")), HasSubstr("'nan'"));
  EXPECT_THAT(wrong(facetText("vertex 0 0\nvertex 0 0 1\n")), HasSubstr("'vertex'"));
  EXPECT_THAT(wrong("facet normal 0 0 1 0 0\nouter loop\n"), HasSubstr("'outer loop'"));
  EXPECT_THAT(complaint("a.stl", "solid s\nendsolid s\n"), HasSubstr("a.stl: no vertices"));
}

TEST_F(StlImports, CornersOfStlAreJoined) {
  const std::string stl = "solid s\n" + kFacets + "endsolid s\n";
  EXPECT_EQ(read("a.stl", stl, {{"elements", "vertices"}})->scene().objects, 4U);
  EXPECT_EQ(read("a.stl", stl, {{"elements", "edges"}})->scene().objects, 5U);
  EXPECT_EQ(pairsIn(*read("a.stl", stl), 0), (PairCounts{1, 0}));
  // Corners that part later are two vertices in all frames; 0 and -0 are the same position.
  write("parts/1.stl", stl);
  write("parts/2.stl", "solid s\n" + facetText("vertex 0 -0 0\nvertex 1 0 0\nvertex 1 1 0\n") +
                           facetText("vertex 0 0 0\nvertex 2 1 0\nvertex 0 1 0\n") +
                           "endsolid s\n");
  write("parts/3.stl", stl);
  for (const auto& [elements, objects] : {std::pair{"vertices", 5U}, {"edges", 6U}}) {
    const auto parts = importFrom(directory_ / "parts", {{"elements", elements}});
    EXPECT_EQ(parts->scene().objects, objects);
    EXPECT_TRUE(parts->scene().all_present);
  }
}

}  // namespace
}  // namespace broadmark::tests
