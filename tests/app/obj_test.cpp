// OBJ files: what is read, and what is refused.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/mesh_imports.h"

namespace broadmark::tests {
namespace {

using imports::readObj;
using imports::Triangle;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Line = std::array<std::uint32_t, 2>;

using ObjImports = MeshImports;

const std::string kFour = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST_F(ObjImports, CommentsAndContinuationsOfObj) {
  const std::vector<Triangle> square = {{0, 1, 2}, {0, 2, 3}};
  for (const std::string text :
       {"f 1 2 3 # first\nf 1 3 4 # second\n", "# C:\\models\\\nf 1 2 3 4\n", "f 1 2 \\\n 3 4\n",
        "f 1/1 2/1/1 \\ # more\n\t3//1 \\\r\n4/\r\n", "f -4 -3 -2 -1#all\n",
        "g a b\\\nc\nf 1 2 3 4", "v 5 5 5 # not used\nfo 1 2 3 -2\n"}) {
    EXPECT_EQ(readWith(readObj, kFour + text).topology.triangles, square) << text;
  }
  EXPECT_THAT(refusal(readObj, kFour + "f 1 2 3 \\"), HasSubstr("cut short"));
  EXPECT_EQ(readWith(readObj, "f 1 2 3 4\n" + kFour).topology.triangles, square);
  EXPECT_THAT(refusal(readObj, "f 1 2 3\nf 1 2 5\nf 4 3 2\n" + kFour),
              HasSubstr("line 2: no vertex 5: there are 4"));
  EXPECT_THAT(refusal(readObj, "f -1 -2 -3\n" + kFour), HasSubstr("line 1: no vertex -1"));
}

TEST_F(ObjImports, LinesAndPointsOfObj) {
  const MeshContents mesh =
      readWith(readObj, kFour + "l 1 2\nl 2/1 3/2 -1/4\np 1 2\np -1\nf 1 2 3\n");
  EXPECT_THAT(mesh.topology.lines, ElementsAre(Line{0, 1}, Line{1, 2}, Line{2, 3}));
  EXPECT_THAT(mesh.summary.left_out, IsEmpty());
  const auto edges = read("line.obj", kFour + "l 1 2\nl 2 3 4\n", {{"elements", "edges"}});
  EXPECT_EQ(edges->scene().objects, 3U);
  EXPECT_EQ(boxesOf(*edges, 0)[1], boxOf({1, 0, 0}, {1, 1, 0}));
  EXPECT_THAT(refusal(readObj, kFour + "l 1\n"), HasSubstr("line 5: a line needs at least two"));
  EXPECT_THAT(refusal(readObj, kFour + "p 5\n"), HasSubstr("no vertex 5"));
  EXPECT_THAT(refusal(readObj, kFour + "p\n"), HasSubstr("line 5"));
}

TEST_F(ObjImports, ColoursAndWeightsOfObj) {
  const MeshContents mesh = readWith(
      readObj, "v 1 2 3 1\nv 1 2 4 0.5 0.25 1\nv 1 2 5 1 .5 .5 .5\nv 1 2 6 0.1 0.1 0.1 1\n");
  EXPECT_THAT(mesh.points, ElementsAre(imports::Point{1, 2, 3}, imports::Point{1, 2, 4},
                                       imports::Point{1, 2, 5}, imports::Point{1, 2, 6}));
  EXPECT_THAT(mesh.summary.left_out, IsEmpty());
  EXPECT_THAT(readWith(readObj, "v 1 2 3 0.5\n").summary.left_out,
              ElementsAre(HasSubstr("weight")));
  EXPECT_THAT(refusal(readObj, "v 1 2 3 1 2 3 4 5\n"), HasSubstr("three coordinates"));
}

TEST_F(ObjImports, WhatObjHoldsBesidesIsToldOrRefused) {
  EXPECT_THAT(
      readWith(readObj, kFour + "vn 0 0 1\nvt 0 0\ns off\nusemtl m\nf 1 2 3\n").summary.left_out,
      IsEmpty());
  EXPECT_THAT(readWith(readObj, kFour + "vp 0 1\ncstype bezier\ncurv 0 1 1 2\nsurf 0 1 0 1 1\n")
                  .summary.left_out,
              ElementsAre("statements cstype, curv, surf, vp"));
  EXPECT_THAT(refusal(readObj, "V 0 0 0\n" + kFour), AllOf(HasSubstr("line 1"), HasSubstr("'V'")));
  EXPECT_THAT(refusal(readObj, "\xC2\xA0v 0 0 0\n" + kFour),
              AllOf(HasSubstr("line 1"), HasSubstr("'\\xC2\\xA0v'")));
}

}  // namespace
}  // namespace broadmark::tests
