// The shapes of each object type.

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "broadmark/scenes/registry.h"
#include "entries.h"

namespace broadmark::scenes {
namespace {

/// The shapes of the first bodies of a world.
std::vector<Shape> shapesOf(const std::string& id, std::size_t count, double scale = 1,
                            std::uint64_t seed = 1) {
  std::vector<Shape> shapes;
  Random random(seed);
  const ObjectType type = entryOf(objectTypes(), id, "object type");
  for (std::size_t i = 0; i < count; ++i) shapes.push_back(type.shape(i, scale, random));
  return shapes;
}

Vec3 edges(const Shape& shape) {
  Vec3 edges = std::get<BoxShape>(shape).half_extents;
  for (float& edge : edges) edge *= 2;
  return edges;
}

TEST(ObjectTypes, HaveTheOriginalsNames) {
  std::vector<std::string> names;
  for (const ObjectType& type : objectTypes()) names.push_back(type.listing.name);
  EXPECT_EQ(names, (std::vector<std::string>{"Cubes", "Spheres", "Assorted"}));
}

TEST(ObjectTypes, CubesAndSpheresAreOneScaleWide) {
  for (const Shape& cube : shapesOf("cubes", 100, 3)) EXPECT_EQ(edges(cube), (Vec3{3, 3, 3}));
  for (const Shape& sphere : shapesOf("spheres", 100, 3)) {
    EXPECT_EQ(std::get<SphereShape>(sphere).radius, 1.5F);
  }
}

TEST(ObjectTypes, AssortedBodiesFollowTheOriginalsTable) {
  const std::vector<Shape> shapes = shapesOf("assorted", 400);
  for (std::size_t start = 0; start < 400; start += 80) {
    const auto expect = [&](std::size_t first, std::size_t last, const Vec3& expected) {
      for (std::size_t i = first; i <= last; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_FLOAT_EQ(edges(shapes[start + i])[axis], expected[axis]) << "body " << start + i;
        }
      }
    };
    expect(0, 3, {0.5F, 0.5F, 0.5F});
    expect(4, 7, {1.9F, 1.9F, 1.9F});
    expect(8, 10, {15.2F, 0.4F, 0.4F});
    expect(11, 11, {0.4F, 15.2F, 0.4F});
    expect(12, 12, {0.4F, 0.4F, 15.2F});
    expect(13, 13, {1.9F, 5.7F, 0.1F});
    expect(14, 14, {1.9F, 0.1F, 5.7F});
    expect(15, 15, {0.1F, 1.9F, 0.3F});
    expect(16, 16, {3.8F, 3.8F, 0.1F});
    expect(17, 17, {3.8F, 0.1F, 3.8F});
    expect(18, 18, {0.1F, 3.8F, 3.8F});
  }
}

TEST(ObjectTypes, OtherAssortedBodiesHaveRandomEdges) {
  const std::vector<Shape> shapes = shapesOf("assorted", 8000);
  float least = 9;
  float most = 0;
  double sum = 0;
  std::set<float> different;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (i % 80 < 19) continue;
    for (const float edge : edges(shapes[i])) {
      least = std::min(least, edge);
      most = std::max(most, edge);
      sum += edge;
      different.insert(edge);
    }
  }
  EXPECT_GE(least, 0.0803F);
  EXPECT_LT(least, 0.082F);
  EXPECT_LE(most, 1.5257F);
  EXPECT_GT(most, 1.524F);
  EXPECT_NEAR(sum / (100 * 61 * 3), 0.803, 0.02);
  EXPECT_GT(different.size(), 18'000U);

  EXPECT_EQ(edges(shapesOf("assorted", 80)[50]), edges(shapes[50])) << "the same for the same seed";
  EXPECT_NE(edges(shapesOf("assorted", 80, 1, 2)[50]), edges(shapes[50]));
  EXPECT_FLOAT_EQ(edges(shapesOf("assorted", 80, 2)[50])[0], 2 * edges(shapes[50])[0]);
}

}  // namespace
}  // namespace broadmark::scenes
