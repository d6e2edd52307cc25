// Sequences of meshes, and random meshes as an independent writer writes them.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "app/mesh_imports.h"
#include "broadmark/recordings/swept_frames.h"

namespace broadmark::tests {
namespace {

using imports::readObj;
using imports::readPly;
using imports::readStl;
using imports::Triangle;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::SizeIs;

using MeshSequences = MeshImports;

/// An OBJ file of n triangles in a row; without `strip` they share no vertices.
std::string rowOfTriangles(int n, float x, bool strip = true) {
  std::string text;
  const int vertices = strip ? n + 2 : 3 * n;
  for (int i = 0; i < vertices; ++i)
    text += fmt::format("v {} {} 0\n", x + static_cast<float>(i), i % 2);
  for (int i = 0; i < n; ++i) {
    const int first = 1 + (strip ? i : 3 * i);
    text += fmt::format("f {} {} {}\n", first, first + 1, first + 2);
  }
  return text;
}

std::vector<std::uint32_t> bodiesPresentIn(IndexedFrames& frames, std::uint32_t index) {
  return frames.at(index).presentBodies();
}

TEST_F(MeshSequences, AMeshThatComesBackHasTheSameBodies) {
  for (int frame = 0; frame < 6; ++frame) {
    const bool other = frame == 2 || frame == 3;
    write(fmt::format("m/{}.obj", frame),
          rowOfTriangles(other ? 3 : 2, static_cast<float>(10 * frame), !other));
  }
  Source source = sequence("m");
  IndexedFrames& frames = *source.imported;
  EXPECT_EQ(frames.scene().objects, 5U);
  EXPECT_EQ(frames.scene().frames, 5U);
  EXPECT_FALSE(frames.scene().all_present);
  // In any order: what is absent is the empty box.
  for (const std::uint32_t frame : {0U, 2U, 3U, 5U, 1U, 2U, 4U, 0U}) {
    const bool other = frame == 2 || frame == 3;
    EXPECT_EQ(bodiesPresentIn(frames, frame),
              other ? (std::vector<std::uint32_t>{2, 3, 4}) : (std::vector<std::uint32_t>{0, 1}));
    const auto x = static_cast<float>(10 * frame);
    EXPECT_EQ(boxesOf(frames, frame)[1], other ? kEmptyBox : boxOf({x + 1, 0, 0}, {x + 3, 1, 0}));
    EXPECT_EQ(boxesOf(frames, frame)[3], other ? boxOf({x + 3, 0, 0}, {x + 5, 1, 0}) : kEmptyBox);
  }
  // Vertex 0 of a mesh is not that of another.
  EXPECT_FALSE(frames.scene().filter.wanted(0, 1));
  EXPECT_TRUE(frames.scene().filter.wanted(0, 2));
  EXPECT_TRUE(frames.scene().filter.wanted(2, 3));
  EXPECT_THAT(source.summary.used,
              Contains(HasSubstr("2 topologies: bodies 0..1 in frames 0..1, 4..5; bodies 2..4 in "
                                 "frames 2..3")));
  // A body that appears has only its current box.
  SweptFrames swept(std::move(source.imported));
  EXPECT_LT(boxesOf(swept, 2)[2].max[0], 24);
  EXPECT_GT(boxesOf(swept, 2)[2].min[0], 19);
  EXPECT_EQ(boxesOf(swept, 2)[0], kEmptyBox);
}

TEST_F(MeshSequences, AFileThatOnlyAddsToTheOneBeforeContinuesItsBodies) {
  write("m/1.obj", rowOfTriangles(2, 0));
  write("m/2.obj", rowOfTriangles(3, 0));
  write("m/3.obj", rowOfTriangles(4, 0));
  write("m/4.obj", rowOfTriangles(2, 0));  // known
  write("m/5.obj", rowOfTriangles(2, 0, false));
  Source source = sequence("m", {{"elements", "all"}});
  IndexedFrames& frames = *source.imported;
  // Vertices, edges and triangles of the strips: 4 + 5 + 2, 5 + 7 + 3, 6 + 9 + 4.
  EXPECT_THAT(bodiesPresentIn(frames, 0), SizeIs(11));
  EXPECT_THAT(bodiesPresentIn(frames, 1), SizeIs(15));
  EXPECT_THAT(bodiesPresentIn(frames, 2), SizeIs(19));
  EXPECT_THAT(bodiesPresentIn(frames, 4), SizeIs(6 + 6 + 2));
  EXPECT_EQ(frames.scene().objects, 19U + 14);
  const auto first = boxesOf(frames, 0);
  for (const std::uint32_t frame : {1U, 2U, 3U}) {
    const auto boxes = boxesOf(frames, frame);
    EXPECT_TRUE(std::equal(boxes.begin(), boxes.begin() + 11, first.begin())) << "nothing moves";
  }
  const auto last = boxesOf(frames, 2);
  EXPECT_EQ(last[11], boxOf({4, 0, 0}, {4, 0, 0})) << "the first new vertex";
  EXPECT_TRUE(frames.scene().filter.wanted(0, 11));
  EXPECT_FALSE(frames.scene().filter.wanted(3, 14)) << "the new triangle has vertex 3";
  EXPECT_THAT(source.summary.used, Contains(HasSubstr("bodies 0..14 in frames 1")));
  // Facets of STL have no numbers of their own: another count is another mesh.
  write("s/1.stl", stlBytes("", 2));
  write("s/2.stl", stlBytes("", 3));
  EXPECT_EQ(sequence("s").imported->scene().objects, 5U);
}

TEST_F(MeshSequences, AFileMayStateThatItIsEmpty) {
  const std::string full = stlBytes("", 2);
  write("m/1.stl", stlBytes("", 0));
  write("m/2.stl", full);
  write("m/3.stl", "solid\nendsolid\n");
  write("m/4.stl", full);
  Source source = sequence("m");
  IndexedFrames& frames = *source.imported;
  EXPECT_EQ(frames.scene().objects, 2U);
  EXPECT_FALSE(frames.scene().all_present);
  for (const std::uint32_t frame : {3U, 2U, 1U, 0U}) {
    EXPECT_THAT(bodiesPresentIn(frames, frame), SizeIs(frame % 2 == 0 ? 0 : 2));
  }
  EXPECT_THAT(source.summary.used, Contains(HasSubstr("bodies none in frames 0, 2; bodies 0..1")));
}

TEST_F(MeshSequences, PolygonsThatDeformAreCutAlike) {
  // A concave corner that moves around the square: no diagonal is good in all frames.
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::array<imports::Point, 5> corners = {
      {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 3, 0}, {0, 2, 0}}};
  for (std::size_t frame = 0; frame < 5; ++frame) {
    std::string rows;
    for (std::size_t i = 0; i < 5; ++i) {
      const auto& [x, y, z] = corners[i];
      rows += i == frame ? std::string("1 1.2 0\n") : fmt::format("{} {} {}\n", x, y, z);
    }
    write(fmt::format("m/{}.ply", frame), header + rows + "5 0 1 2 3 4\n");
  }
  const auto frames = importFrom(directory_ / "m");
  EXPECT_EQ(frames->scene().objects, 3U);
  EXPECT_TRUE(frames->scene().all_present);
  EXPECT_EQ(boxesOf(*frames, 4)[2], boxOf({0, 0, 0}, {1, 3, 0})) << "corners 0, 3 and 4";
}

TEST_F(MeshSequences, AFileOfASequenceWithoutElementsIsRefused) {
  write("m/1.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\n");
  write("m/2.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n");
  EXPECT_THAT(inputErrorOf([&] { sequence("m"); }),
              AllOf(HasSubstr("2.obj"), HasSubstr("no triangles")));
  EXPECT_EQ(sequence("m", {{"elements", "vertices"}}).imported->scene().objects, 4U + 4);
}

TEST_F(MeshSequences, RandomMeshesAreReadAsTheyWereWritten) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    std::mt19937 random(seed);
    const RandomMesh mesh = randomMesh(random);
    const char* encodings[] = {"ascii", "little", "big"};
    const PlyFile ply{.mesh = mesh, .encoding = encodings[seed % 3]};
    const MeshContents from_ply = readWith(readPly, ply.bytes(random));
    EXPECT_EQ(from_ply.points, mesh.points) << "PLY, seed " << seed;
    EXPECT_EQ(from_ply.topology.triangles, mesh.triangles()) << "PLY, seed " << seed;
    EXPECT_EQ(from_ply.topology.lines, mesh.lines) << "PLY, seed " << seed;
    const MeshContents from_obj = readWith(readObj, objText(mesh, random));
    EXPECT_EQ(from_obj.points, mesh.points) << "OBJ, seed " << seed;
    EXPECT_EQ(from_obj.topology.triangles, mesh.triangles()) << "OBJ, seed " << seed;
    EXPECT_EQ(from_obj.topology.lines, mesh.lines) << "OBJ, seed " << seed;
    std::vector<imports::Point> corners;
    for (const Triangle& triangle : mesh.triangles()) {
      for (const std::uint32_t vertex : triangle) corners.push_back(mesh.points[vertex]);
    }
    const std::string stl = seed % 2 == 0 ? stlText(corners, random) : stlBinary(corners, random);
    EXPECT_EQ(readWith(readStl, stl).points, corners) << "STL, seed " << seed;
  }
}

TEST_F(MeshSequences, RandomSequencesHaveTheBoxesOfTheirMeshes) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    std::mt19937 random(seed);
    std::vector<RandomMesh> meshes;
    for (int i = 0; i < 3; ++i) meshes.push_back(randomMesh(random));
    std::vector<std::vector<Aabb>> expected;
    std::vector<std::size_t> chosen;
    const std::string folder = fmt::format("s{}", seed);
    for (int frame = 0; frame < 6; ++frame) {
      chosen.push_back(random() % meshes.size());
      RandomMesh& mesh = meshes[chosen.back()];
      for (imports::Point& point : mesh.points) point = randomPoint(random);
      const std::string name = fmt::format("{}/m{}", folder, frame);
      if (random() % 2 == 0) {
        write(name + ".obj", objText(mesh, random));
      } else {
        write(name + ".ply", PlyFile{.mesh = mesh, .encoding = "big"}.bytes(random));
      }
      auto& boxes = expected.emplace_back();
      for (const auto& [a, b, c] : mesh.triangles()) {
        Aabb box = kEmptyBox;
        for (const std::uint32_t v : {a, b, c}) {
          box = merged(box, boxOf(mesh.points[v], mesh.points[v]));
        }
        boxes.push_back(box);
      }
    }
    const auto frames = importFrom(directory_ / folder);
    std::map<std::size_t, std::vector<std::uint32_t>> bodies;
    std::set<std::uint32_t> all;
    for (std::uint32_t frame = 0; frame < 6; ++frame) {
      const std::vector<std::uint32_t> present = bodiesPresentIn(*frames, frame);
      all.insert(present.begin(), present.end());
      const auto boxes = boxesOf(*frames, frame);
      ASSERT_EQ(present.size(), expected[frame].size());
      for (std::size_t i = 0; i < present.size(); ++i) {
        EXPECT_EQ(boxes[present[i]], expected[frame][i]) << "seed " << seed;
      }
      const auto known = bodies.try_emplace(chosen[frame], present).first;
      EXPECT_EQ(known->second, present) << "seed " << seed;
    }
    EXPECT_EQ(all.size(), frames->scene().objects) << "no body is never there";
  }
}

}  // namespace
}  // namespace broadmark::tests
