// Meshes read by assimp: animations, and damaged files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "app/import_files.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

using testing::HasSubstr;

using AssimpImports = Imports;

std::filesystem::path data(const std::string& name) { return places::source("tests/data/" + name); }

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

TEST_F(AssimpImports, NoDamageCrashesUs) {
  const std::string whole = readTextFile(data("skinned.gltf"));
  for (std::size_t i = 0; i < 24; ++i) {
    std::string bytes = whole;
    bytes[whole.size() * i / 24 + i % 7] ^= static_cast<char>(1 << i % 8);
    const auto damaged = write("damaged.gltf", bytes);
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

TEST_F(AssimpImports, FilesOfAnotherKind) {
  for (const char* name : {"a.gltf", "a.glb"}) {
    EXPECT_THAT(complaint(name, "nothing of the kind"), HasSubstr(name));
    EXPECT_THAT(complaint(name, ""), HasSubstr(name));
  }
  EXPECT_THAT(inputErrorOf([&] { importFrom(directory_ / "none.gltf"); }),
              HasSubstr("cannot read"));
}

}  // namespace
}  // namespace broadmark::tests
