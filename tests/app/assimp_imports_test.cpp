// Meshes read by assimp: the vertices of each face, animations, and damaged files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "app/import_files.h"
#include "broadmark/recordings/swept_frames.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using AssimpImports = Imports;

std::filesystem::path data(const std::string& name) { return places::source("tests/data/" + name); }

/// Two triangles and a square beside them; vertices 1 and 4 have the same position.
constexpr const char* kPly =
    "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float "
    "z\n"
    "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n1 0 0\n2 2 2\n3 0 1 2\n4 0 4 2 3\n";

TEST_F(AssimpImports, VerticesAreThoseOfThePlyFile) {
  const auto vertices = read("a.ply", kPly, {{"elements", "vertices"}});
  EXPECT_EQ(vertices->scene().objects, 6U);
  EXPECT_EQ(boxesOf(*vertices, 0)[5], boxOf({2, 2, 2}, {2, 2, 2}));
  EXPECT_EQ(pairsIn(*vertices, 0), (PairCounts{1, 1}));
  const auto triangles = read("a.ply", kPly);
  EXPECT_EQ(triangles->scene().objects, 3U);
  // All triangles share vertex 0.
  EXPECT_EQ(pairsIn(*triangles, 0), (PairCounts{3, 0}));
}

TEST_F(AssimpImports, CornersOfStlAreJoined) {
  const auto facet = [](const std::string& corners) {
    return "facet normal 0 0 1\nouter loop\n" + corners + "endloop\nendfacet\n";
  };
  const std::string stl = "solid s\n" + facet("vertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\n") +
                          facet("vertex 0 0 0\nvertex 1 1 0\nvertex 0 1 0\n") + "endsolid s\n";
  EXPECT_EQ(read("a.stl", stl, {{"elements", "vertices"}})->scene().objects, 4U);
  EXPECT_EQ(read("a.stl", stl, {{"elements", "edges"}})->scene().objects, 5U);
  EXPECT_EQ(pairsIn(*read("a.stl", stl), 0), (PairCounts{1, 0}));
}

TEST_F(AssimpImports, AnimatedNodesMoveTheirMeshes) {
  // The node moves from x = 0 to x = 4 within a second.
  const auto frames = importFrom(data("moving.gltf"), {{"frame_rate", "2"}});
  ASSERT_EQ(frames->scene().frames, 2U);
  EXPECT_EQ(boxesOf(*frames, 0)[0], boxOf({0, 0, 0}, {1, 1, 0}));
  EXPECT_EQ(boxesOf(*frames, 1)[0], boxOf({2, 0, 0}, {3, 1, 0}));
  EXPECT_EQ(boxesOf(*frames, 2)[0], boxOf({4, 0, 0}, {5, 1, 0}));
  EXPECT_EQ(importFrom(data("moving.gltf"))->scene().frames, 30U);
}

TEST_F(AssimpImports, AnimatedBonesPullAtVertices) {
  // Only the second vertex is attached to the moving bone.
  const auto frames =
      importFrom(data("skinned.gltf"), {{"frame_rate", "1"}, {"elements", "vertices"}});
  EXPECT_THAT(boxesOf(*frames, 1),
              ElementsAre(boxOf({0, 0, 0}, {0, 0, 0}), boxOf({5, 0, 0}, {5, 0, 0}),
                          boxOf({0, 1, 0}, {0, 1, 0})));
}

TEST_F(AssimpImports, PairsOfAnExcerptOfRodTwist) {
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
    SweptFrames frames(importFrom(data("rod-twist-*.ply"), {{"elements", elements}}));
    EXPECT_EQ(frames.scene().name, "rod-twist swept");
    EXPECT_EQ(frames.scene().objects, bodies);
    EXPECT_EQ(pairsIn(frames, 1), pairs) << elements;
  }
  const auto still = importFrom(data("rod-twist-*.ply"), {{"elements", "edges"}});
  EXPECT_EQ(pairsIn(*still, 1), (PairCounts{6057, 6057 - 1048}));
}

TEST_F(AssimpImports, ACutPlyIsDamaged) {
  const std::string whole = readTextFile(data("rod-twist-3036.ply"));
  for (const std::size_t kept :
       {whole.size() - 1, whole.size() - 13, whole.size() / 2, std::size_t{300}}) {
    EXPECT_THAT(
        complaint("cut.ply", whole.substr(0, kept)),
        testing::AllOf(HasSubstr("cut.ply: "), HasSubstr("vertex"), HasSubstr("cut short")));
  }
}

TEST_F(AssimpImports, NoDamageCrashesUs) {
  for (const auto& file : {data("rod-twist-3036.ply"), data("skinned.gltf")}) {
    const std::string whole = readTextFile(file);
    for (std::size_t i = 0; i < 24; ++i) {
      std::string bytes = whole;
      bytes[whole.size() * i / 24 + i % 7] ^= static_cast<char>(1 << i % 8);
      const auto damaged = write("damaged" + file.extension().string(), bytes);
      try {
        const auto frames = importFrom(damaged);
        for (std::uint32_t frame = 0; frame <= frames->scene().frames; ++frame) frames->at(frame);
      } catch (const InputError& error) {
        const std::string what = error.what();
        EXPECT_THAT(what, HasSubstr("damaged"));
        EXPECT_EQ(std::ranges::count(what, '\n'), 0) << what;
      }
    }
  }
}

TEST_F(AssimpImports, FilesOfAnotherKind) {
  for (const char* name : {"a.ply", "a.stl", "a.gltf", "a.glb"}) {
    EXPECT_THAT(complaint(name, "nothing of the kind"), HasSubstr(name));
    EXPECT_THAT(complaint(name, ""), HasSubstr(name));
  }
  EXPECT_THAT(inputErrorOf([&] { importFrom(directory_ / "none.ply"); }), HasSubstr("cannot read"));
}

}  // namespace
}  // namespace broadmark::tests
