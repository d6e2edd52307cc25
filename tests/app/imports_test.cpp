// Text files of other programs: their contents, and their errors.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/import_files.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kOneParticle = "1\ncomment\nA 1 2 3\n";

TEST_F(Imports, BoxesOfCsv) {
  const auto frames = read("boxes.csv",
                           "frame, id, x0, y0, z0, x1, y1, z1\r\n"
                           "0,7,0,0,0,1,1,1\n"
                           "0,3, 2,2,2, 3,3,3\n"
                           "\n"
                           "2,7,0.5,-1e-3,+0,1,1,1\n"
                           "5,9,4,4,4,4,4,4");
  EXPECT_EQ(frames->scene().name, "boxes");
  EXPECT_EQ(frames->scene().objects, 3U);
  EXPECT_EQ(frames->scene().frames, 5U);
  EXPECT_FALSE(frames->scene().all_present);
  EXPECT_EQ(frames->scene().world, boxOf({0, -1e-3F, 0}, {4, 4, 4}));
  // Ids 3, 7 and 9 become bodies 0, 1 and 2.
  EXPECT_THAT(boxesOf(*frames, 0),
              ElementsAre(boxOf({2, 2, 2}, {3, 3, 3}), boxOf({0, 0, 0}, {1, 1, 1}), kEmptyBox));
  EXPECT_THAT(boxesOf(*frames, 1), ElementsAre(kEmptyBox, kEmptyBox, kEmptyBox));
  EXPECT_THAT(boxesOf(*frames, 2),
              ElementsAre(kEmptyBox, boxOf({0.5F, -1e-3F, 0}, {1, 1, 1}), kEmptyBox));
  EXPECT_THAT(boxesOf(*frames, 5), ElementsAre(kEmptyBox, kEmptyBox, boxOf({4, 4, 4}, {4, 4, 4})));
  EXPECT_EQ(boxesOf(*frames, 0).size(), 3U) << "backwards";
}

TEST_F(Imports, BoxesThatAreAlwaysThere) {
  const auto frames = read("boxes.csv", "0,0,0,0,0,1,1,1\n1,0,0,0,0,1,1,1\n");
  EXPECT_TRUE(frames->scene().all_present);
  EXPECT_FALSE(read("late.csv", "0,0,0,0,0,1,1,1\n1,1,0,0,0,1,1,1\n")->scene().all_present);
  EXPECT_FALSE(
      read("more.csv", "0,0,0,0,0,1,1,1\n1,0,0,0,0,1,1,1\n1,1,0,0,0,1,1,1\n")->scene().all_present);
}

TEST_F(Imports, WhatIsWrongWithCsv) {
  const std::string good = "0,0,0,0,0,1,1,1\n";
  const auto wrong = [&](const std::string& line) { return complaint("a.csv", good + line); };
  EXPECT_THAT(wrong("1,0,0,0,0,1,1"), AllOf(HasSubstr("a.csv: line 2: 7 values"), HasSubstr("8")));
  EXPECT_THAT(wrong("1,0,x,0,0,1,1,1"), HasSubstr("line 2: min_x is 'x'"));
  EXPECT_THAT(wrong("1,0,nan,0,0,1,1,1"), HasSubstr("finite"));
  EXPECT_THAT(wrong("1,0,0,0,0,1e39,1,1"), HasSubstr("32-bit"));
  EXPECT_THAT(wrong("1,0,0,5,0,1,1,1"), HasSubstr("line 2: min y = 5 is above max y = 1"));
  EXPECT_THAT(wrong("1.5,0,0,0,0,1,1,1"), HasSubstr("line 2: the frame is '1.5'"));
  EXPECT_THAT(wrong("0,0,0,0,0,1,1,1"), HasSubstr("line 2: 0 is already in this frame, in line 1"));
  EXPECT_THAT(wrong("1,0,0,0,0,1,1,1\n0,0,0,0,0,1,1,1"),
              HasSubstr("line 3: frame 0 after frame 1"));
  EXPECT_THAT(wrong("4000000000,0,0,0,0,1,1,1"), HasSubstr("line 2: more than 1000000 frames"));
  EXPECT_THAT(wrong("9223372036854775807,0,0,0,0,1,1,1"), HasSubstr("more than"));
  EXPECT_THAT(complaint("a.csv", ""), HasSubstr("holds no frame"));
  EXPECT_THAT(complaint("a.csv", "frame,id\n"), HasSubstr("no column min_x"));
  EXPECT_THAT(complaint("a.csv", std::string(2 << 20, ' ')), HasSubstr("line 1"));
}

TEST_F(Imports, ParticlesOfXyz) {
  const auto frames = read("p.xyz", "2\n\nA 0 0 0\nB 1 2 3\n\n2\nnext\nA 4 4 4 9 9\nB 5 5 5\n\n",
                           {{"radius", "0.5"}});
  EXPECT_EQ(frames->scene().object_type, "Particles");
  EXPECT_EQ(frames->scene().frames, 1U);
  EXPECT_TRUE(frames->scene().all_present);
  EXPECT_THAT(boxesOf(*frames, 0), ElementsAre(boxOf({-.5F, -.5F, -.5F}, {.5F, .5F, .5F}),
                                               boxOf({.5F, 1.5F, 2.5F}, {1.5F, 2.5F, 3.5F})));
  EXPECT_EQ(boxesOf(*frames, 1)[0], boxOf({3.5F, 3.5F, 3.5F}, {4.5F, 4.5F, 4.5F}));
}

TEST_F(Imports, ABallLiesInItsBox) {
  std::string text = "30\n\n";
  for (int i = 0; i < 30; ++i) text += fmt::format("A {0} -{0} {1}\n", 0.1 * i, 16777216 + i);
  const auto frames = read("p.xyz", text, {{"radius", "0.7"}});
  const auto boxes = boxesOf(*frames, 0);
  for (int i = 0; i < 30; ++i) {
    const double centre[] = {0.1 * i, -0.1 * i, 16777216.0 + i};
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(double{boxes[i].min[axis]}, centre[axis] - 0.7);
      EXPECT_GE(double{boxes[i].max[axis]}, centre[axis] + 0.7);
    }
  }
}

TEST_F(Imports, ColumnsOfExtendedXyz) {
  const auto frames = read("p.xyz",
                           "1\nLattice=\"1 0 0\" Properties=radius:R:1:species:S:1:pos:R:3 Time=1\n"
                           "0.5 A 1 2 3\n");
  EXPECT_EQ(boxesOf(*frames, 0)[0], boxOf({.5F, 1.5F, 2.5F}, {1.5F, 2.5F, 3.5F}));
}

TEST_F(Imports, WhatIsWrongWithXyz) {
  const auto wrong = [&](const std::string& text, const std::string& radius = "1") {
    return complaint("a.xyz", text, {{"radius", radius}});
  };
  EXPECT_THAT(wrong(kOneParticle, "0"), AllOf(HasSubstr("line 3"), HasSubstr("--radius")));
  EXPECT_THAT(wrong("x\n\n"), HasSubstr("line 1: the number of particles is 'x'"));
  EXPECT_THAT(wrong("-1\n\n"), HasSubstr("negative"));
  EXPECT_THAT(wrong("\v\n"), HasSubstr("holds no frame"));
  EXPECT_THAT(wrong("9000000000000\n\nA 1 2 3\n"),
              AllOf(HasSubstr("line 3"), HasSubstr("9000000000000")));
  EXPECT_THAT(wrong("1\n"), HasSubstr("a comment is expected"));
  EXPECT_THAT(wrong("1\n\nA 1 2\n"), HasSubstr("line 3: 3 columns: 4 are expected"));
  EXPECT_THAT(wrong("1\n\nA 1 2 1e300\n"), HasSubstr("32-bit"));
  EXPECT_THAT(wrong("1\nProperties=species:S:1\nA\n"), HasSubstr("pos:R:3"));
  EXPECT_THAT(wrong("1\nProperties=a:R:99999999999:pos:R:3\nA\n"), HasSubstr("columns"));
}

/// A frame of a LAMMPS dump.
std::string dump(const std::string& step, const std::string& count, const std::string& atoms) {
  return "ITEM: TIMESTEP\n" + step + "\nITEM: NUMBER OF ATOMS\n" + count +
         "\nITEM: BOX BOUNDS pp pp ff\n0 10\n-10 10\n0 1\nITEM: ATOMS " + atoms;
}

TEST_F(Imports, AtomsOfLammps) {
  const auto frames =
      read("a.lammpstrj",
           dump("0", "3", "id type x y z radius\n5 1 1 1 1 .5\n1 1 2 2 2 .25\n2 1 3 3 3 1\n") +
               dump("10", "2", "type id diameter x y z\n1 1 1 2 2 2\n1 5 2 1 1 1\n"));
  EXPECT_EQ(frames->scene().objects, 3U);
  EXPECT_FALSE(frames->scene().all_present) << "atom 2 is lost";
  EXPECT_THAT(boxesOf(*frames, 0),
              ElementsAre(boxOf({1.75F, 1.75F, 1.75F}, {2.25F, 2.25F, 2.25F}),
                          boxOf({2, 2, 2}, {4, 4, 4}), boxOf({.5F, .5F, .5F}, {1.5F, 1.5F, 1.5F})));
  EXPECT_THAT(boxesOf(*frames, 1), ElementsAre(boxOf({1.5F, 1.5F, 1.5F}, {2.5F, 2.5F, 2.5F}),
                                               kEmptyBox, boxOf({0, 0, 0}, {2, 2, 2})));
}

TEST_F(Imports, ScaledAtomsOfLammps) {
  const auto frames =
      read("a.dump", dump("0", "1", "id xs ys zs\n1 0.5 0.25 1\n"), {{"radius", "1"}});
  EXPECT_EQ(boxesOf(*frames, 0)[0], boxOf({4, -6, 0}, {6, -4, 2}));
}

TEST_F(Imports, WhatIsWrongWithLammps) {
  const auto wrong = [&](const std::string& text) { return complaint("a.dump", text); };
  EXPECT_THAT(wrong("hello\n"), HasSubstr("line 1: 'ITEM: …' is expected"));
  EXPECT_THAT(wrong(dump("0", "1", "id x y z\n1 0 0 0\n")), HasSubstr("--radius"));
  EXPECT_THAT(wrong(dump("0", "1", "id x y radius\n1 0 0 0\n")),
              HasSubstr("line 9: no position columns"));
  EXPECT_THAT(wrong(dump("0", "2", "id x y z radius\n1 0 0 0 1\n")), HasSubstr("atom 2 of 2"));
  EXPECT_THAT(wrong(dump("0", "2", "id x y z radius\n1 0 0 0 1\n1 0 0 0 1\n")),
              HasSubstr("line 11: 1 is already in this frame"));
  EXPECT_THAT(wrong(dump("0", "1", "id x y z radius\n1 0 0 0 -1\n")), HasSubstr("negative"));
  EXPECT_THAT(wrong(dump("0", "1", "id x y z radius\n1 0 0\n")), HasSubstr("3 columns: 5"));
  EXPECT_THAT(wrong("ITEM: ATOMS id x y z\n"), HasSubstr("NUMBER OF ATOMS"));
  EXPECT_THAT(wrong("ITEM: TIMESTEP\n"), HasSubstr("ends after line 1"));
  EXPECT_THAT(wrong("ITEM: NUMBER OF ATOMS\n5\nITEM: ATOMS id xs ys zs radius\n1 0 0 0 1\n"),
              HasSubstr("BOX BOUNDS"));
}

TEST_F(Imports, ASequenceIsInNaturalOrder) {
  for (const int frame : {10, 9, 1}) {
    write(fmt::format("run/frame{}.xyz", frame), fmt::format("1\n\nA {} 0 0\n", frame));
  }
  write("run/notes.txt", "not of this");
  for (const char* name : {"run", "run/*.xyz", "run/frame*"}) {
    const auto frames = importFrom(directory_ / name, {{"radius", "1"}});
    EXPECT_EQ(frames->scene().name, "frame");
    ASSERT_EQ(frames->scene().frames, 2U) << name;
    EXPECT_EQ(boxesOf(*frames, 0)[0].min[0], 0) << name;
    EXPECT_EQ(boxesOf(*frames, 1)[0].min[0], 8) << name;
    EXPECT_EQ(boxesOf(*frames, 2)[0].min[0], 9) << name;
  }
  EXPECT_FALSE(importOf((directory_ / "run/nothing*").string()));
}

constexpr const char* kSquare =
    "# two triangles and a vertex of their own\n"
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 2\nv 5 5 5\nv 0 0 0\n"
    "vn 0 0 1\n"
    "f 1/1/1 2/2/1 \\\n 3/3/1 4//1\n";

TEST_F(Imports, ElementsOfObj) {
  const auto elements = [&](const std::string& which) {
    return read("square.obj", kSquare, {{"elements", which}});
  };
  const auto triangles = elements("triangles");
  EXPECT_EQ(triangles->scene().object_type, "Triangles");
  EXPECT_THAT(boxesOf(*triangles, 0),
              ElementsAre(boxOf({0, 0, 0}, {1, 1, 0}), boxOf({0, 0, 0}, {1, 1, 2})));
  EXPECT_FALSE(triangles->scene().filter.wanted(0, 1));
  // 1-2, 1-3, 1-4, 2-3, 3-4
  const auto edges = elements("edges");
  EXPECT_EQ(edges->scene().objects, 5U);
  EXPECT_EQ(boxesOf(*edges, 0)[2], boxOf({0, 0, 0}, {0, 1, 2}));
  EXPECT_TRUE(edges->scene().filter.wanted(0, 4));
  EXPECT_FALSE(edges->scene().filter.wanted(0, 1));
  // The file's vertices, two of them at the same position.
  const auto vertices = elements("vertices");
  EXPECT_EQ(vertices->scene().objects, 6U);
  EXPECT_TRUE(vertices->scene().filter.wantsAll());
  EXPECT_EQ(pairsIn(*vertices, 0), (PairCounts{1, 1}));
  const auto all = elements("all");
  EXPECT_EQ(all->scene().objects, 6U + 5 + 2);
  EXPECT_FALSE(all->scene().filter.wanted(0, 12)) << "a vertex and its triangle";
  EXPECT_TRUE(all->scene().filter.wanted(5, 12)) << "another vertex at the same place";
  const auto kept = read("square.obj", kSquare, {{"keep", "shared-vertices"}});
  EXPECT_TRUE(kept->scene().filter.wantsAll());
}

TEST_F(Imports, MovingMeshes) {
  write("m/a1.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n");
  write("m/a2.obj", "v 2 0 0\nv 3 0 0\nv 2 1 0\nf 1 2 3\n");
  const auto frames = importFrom(directory_ / "m");
  EXPECT_EQ(frames->scene().frames, 1U);
  EXPECT_EQ(boxesOf(*frames, 0)[0], boxOf({0, 0, 0}, {1, 1, 0}));
  EXPECT_EQ(boxesOf(*frames, 1)[0], boxOf({2, 0, 0}, {3, 1, 0}));
  EXPECT_EQ(frames->scene().world, boxOf({0, 0, 0}, {3, 1, 0}));
}

TEST_F(Imports, WhatIsWrongWithObj) {
  const auto wrong = [&](const std::string& text) { return complaint("a.obj", text); };
  EXPECT_THAT(wrong(""), HasSubstr("no vertices"));
  EXPECT_THAT(wrong("v 1 2\n"), HasSubstr("line 1: a vertex needs three"));
  EXPECT_THAT(wrong("v 1 2 x\n"), HasSubstr("'x'"));
  EXPECT_THAT(wrong("v 1 2 1e60\n"), HasSubstr("vertex 0"));
  EXPECT_THAT(wrong("v 1 2 3\nf 1 1 2\n"), HasSubstr("line 2: no vertex 2: there are 1"));
  EXPECT_THAT(wrong("v 1 2 3\nf 1 1 -2\n"), HasSubstr("no vertex -2"));
  EXPECT_THAT(wrong("v 1 2 3\nf 0 1 1\n"), HasSubstr("no vertex 0"));
  EXPECT_THAT(wrong("v 1 2 3\nf 1 1\n"), HasSubstr("at least three vertices"));
  EXPECT_THAT(wrong("v 1 2 3\n"), HasSubstr("--elements"));
}

}  // namespace
}  // namespace broadmark::tests
