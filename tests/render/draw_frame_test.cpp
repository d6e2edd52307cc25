#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <limits>

#include "broadmark/render/camera.h"
#include "broadmark/render/gl.h"
#include "broadmark/render/offscreen_context.h"
#include "broadmark/render/picture.h"
#include "broadmark/render/scene_view.h"
#include "support/drawing.h"
#include "support/pictures.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr int kPictureWidth = 320;
constexpr int kPictureHeight = 240;

bool isInstalled(const std::string& library) {
  return dlopen(library.c_str(), RTLD_LAZY | RTLD_NODELETE) != nullptr;
}

SceneInfo sceneWithSide(std::size_t objects, float side) {
  return {"FreeFall", "Cubes", static_cast<std::uint32_t>(objects), 100, cube({0, 0, 0}, side)};
}

/// Draws these boxes and pairs in a world of side 10.
struct TestScene {
  explicit TestScene(std::size_t count) : boxes(randomCubes(count, 0.4F, 1.2F, 2026)) {
    for (std::uint32_t a = 0; a < count; ++a) {
      for (std::uint32_t b = a + 1; b < count; ++b) {
        if (overlaps(boxes[a], boxes[b])) pairs.push_back({a, b});
      }
    }
  }
  Picture draw(OffscreenContext& context) const {
    const PairRun pair_run = pairs;
    return drawFrame(context, sceneWithSide(boxes.size(), 10), {60, boxes}, {&pair_run, 1},
                     kPictureWidth, kPictureHeight);
  }

  std::vector<Aabb> boxes;
  std::vector<Pair> pairs;
};

Picture drawBoxes(OffscreenContext& context, const SceneInfo& scene, const std::vector<Aabb>& boxes,
                  const std::vector<Pair>& pairs = {}) {
  const PairRun pair_run = pairs;
  return drawFrame(context, scene, {1, boxes}, {&pair_run, 1}, kPictureWidth, kPictureHeight);
}

std::array<int, 3> colourAt(const Picture& picture, const SceneInfo& scene,
                            const std::array<float, 4>& world_point) {
  const ViewSpace space = viewSpaceOf(scene.world);
  const double aspect = static_cast<double>(picture.width) / picture.height;
  const Viewpoint viewpoint{figureCamera(space.toView(scene.world), aspect), picture.width,
                            picture.height};
  return tests::colourAt(picture, pixelOf(viewpoint, space.toView(world_point)));
}

bool isWarm(const std::array<int, 3>& rgb) { return rgb[0] > rgb[2] + 80; }
bool isCool(const std::array<int, 3>& rgb) { return rgb[2] > rgb[0] + 5; }

std::string messageOf(GlSource source, const OffscreenOptions& options) {
  try {
    makeOffscreenContext(source, options);
  } catch (const RenderError& error) {
    return error.what();
  }
  return "";
}

/// Runs with each installed source, and skips the others with the reason.
class EachSource : public testing::TestWithParam<GlSource> {
 protected:
  void SetUp() override {
    const OffscreenOptions options = softwareOnly();
    const std::string& library =
        GetParam() == GlSource::egl ? options.egl_library : options.osmesa_library;
    if (!isInstalled(library)) GTEST_SKIP() << library << " is not installed";
    context_ = makeOffscreenContext(GetParam(), options);
  }
  OffscreenContext& context() { return *context_; }

 private:
  std::unique_ptr<OffscreenContext> context_;
};
INSTANTIATE_TEST_SUITE_P(Render, EachSource, testing::Values(GlSource::egl, GlSource::osmesa),
                         [](const auto& source) {
                           return source.param == GlSource::egl ? "Egl" : "OsMesa";
                         });

TEST_P(EachSource, SaysWhatItIs) {
  EXPECT_THAT(
      context().description(),
      AllOf(HasSubstr(GetParam() == GlSource::egl ? "EGL" : "OSMesa"), HasSubstr("OpenGL")));
}

TEST_P(EachSource, DrawsTheGoldenPicture) {
  if (!hasGoldenLetters()) GTEST_SKIP() << "the golden pictures have other letters";
  EXPECT_TRUE(looksLikeGolden(TestScene(120).draw(context()),
                              places::source("tests/render/golden/boxes.png")));
}

TEST_P(EachSource, ColoursWhatOverlaps) {
  const SceneInfo scene = sceneWithSide(3, 10);
  const std::vector<Aabb> boxes = {cube({-3, 0, 3}, 2), cube({3, 0, -3}, 2), cube({0, 3, 0}, 2)};
  const Picture picture = drawBoxes(context(), scene, boxes, {{0, 1}});
  // A little above the middle of the face towards +z.
  const auto face = [&](std::size_t body) {
    const Aabb& box = boxes[body];
    return colourAt(picture, scene, {box.min[0] + 1, box.min[1] + 1.2F, box.max[2], 0});
  };
  EXPECT_TRUE(isWarm(face(0)));
  EXPECT_TRUE(isWarm(face(1)));
  EXPECT_TRUE(isCool(face(2)));
}

TEST_P(EachSource, AbsentBodiesAreNeitherDrawnNorCounted) {
  const SceneInfo scene = sceneWithSide(2, 10);
  const std::vector<Aabb> two = {cube({-3, 0, 3}, 2), cube({3, 0, -3}, 2)};
  const std::vector<Aabb> four = {kEmptyBox, two[0], kEmptyBox, two[1]};
  EXPECT_EQ(drawBoxes(context(), scene, four, {{1, 3}}).rgba,
            drawBoxes(context(), scene, two, {{0, 1}}).rgba);
}

TEST_P(EachSource, DrawsTheNearerBoxInFront) {
  const SceneInfo scene = sceneWithSide(2, 10);
  const std::vector<Aabb> boxes = {cube({1.14F, 0.4F, 1.2F}, 2), cube({-2.28F, -0.8F, -2.4F}, 2)};
  for (const bool reversed : {false, true}) {
    auto ordered = boxes;
    if (reversed) std::swap(ordered[0], ordered[1]);
    const std::uint32_t near = reversed ? 1 : 0;
    // A pair of the near body with a non-existing body colours only the near one.
    const Picture picture = drawBoxes(context(), scene, ordered, {{near, 99}});
    EXPECT_TRUE(isWarm(colourAt(picture, scene, {1.14F, 0.6F, 2.2F, 0})));
  }
}

TEST_P(EachSource, BatchesDoNotShow) {
  const TestScene scene(120);
  const std::vector<Rgb> colours(scene.boxes.size(), kLightPalette.free);
  const Aabb world = sceneWithSide(scene.boxes.size(), 10).world;
  SceneViewContent content;
  content.space = viewSpaceOf(world);
  content.world = world;
  content.boxes = scene.boxes;
  content.colours = colours;
  const Gl gl(context());
  const auto draw = [&](SceneViewOptions options) {
    options.technique = Technique::gl;
    SceneView view(gl, options);
    view.resize(kPictureWidth, kPictureHeight);
    const double aspect = static_cast<double>(kPictureWidth) / kPictureHeight;
    view.draw(content, figureCamera(content.space.toView(world), aspect));
    return view.read();
  };
  const Picture whole = draw({});
  for (const std::size_t batch :
       {std::size_t{1}, std::size_t{7}, std::size_t{119}, std::size_t{120}}) {
    EXPECT_EQ(draw({.max_batch = batch}).rgba, whole.rgba) << "batches of " << batch;
  }
}

TEST_P(EachSource, EmptyAndOddScenesAreDrawn) {
  constexpr float kHuge = std::numeric_limits<float>::max();
  const Aabb everything{{-kHuge, -kHuge, -kHuge}, {kHuge, kHuge, kHuge}};
  const std::vector<std::vector<Aabb>> cases = {
      {},
      {cube({0, 0, 0}, 0)},
      {Aabb{{-1, 0, -1}, {1, 0, 1}}, Aabb{{0, -1, 0}, {0, 1, 0}}},
      {cube({1e30F, -1e30F, 1e30F}, 1), cube({0, 0, 0}, 1)},
      {everything},
      {cube({1e7F, 1e7F, 1e7F}, 4)}};
  for (const Aabb& world : {cube({0, 0, 0}, 10), Aabb{}, everything, cube({1e6F, 0, 0}, 0),
                            Aabb{{-5, 0, -5}, {5, 0, 5}}, Aabb{{1, 1, 1}, {-1, -1, -1}}}) {
    for (const std::vector<Aabb>& boxes : cases) {
      SceneInfo scene = sceneWithSide(boxes.size(), 1);
      scene.world = world;
      const Picture picture = drawBoxes(context(), scene, boxes, {{0, 5}, {7, 9}});
      EXPECT_EQ(picture.rgba.size(), std::size_t{4} * kPictureWidth * kPictureHeight);
      EXPECT_EQ(picture.rgba[3], 255);
    }
  }
}

TEST_P(EachSource, BodiesOutsideTheWorldAreSeen) {
  SceneInfo scene = sceneWithSide(1, 0);
  const std::vector<Aabb> boxes = {cube({500, 500, 500}, 3)};
  const Picture picture = drawBoxes(context(), scene, boxes);
  scene.world = boxes[0];  // the camera's target
  EXPECT_TRUE(isCool(colourAt(picture, scene, {500, 500.3F, 501.5F, 0})));
}

TEST_P(EachSource, SizesAreObeyedOrRefused) {
  const std::vector<Aabb> boxes = {cube({0, 0, 0}, 1)};
  const SceneInfo scene = sceneWithSide(1, 4);
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 200}, {501, 7}}) {
    const Picture picture = drawFrame(context(), scene, {1, boxes}, {}, width, height);
    EXPECT_EQ(picture.width, width);
    EXPECT_EQ(picture.height, height);
    EXPECT_EQ(picture.rgba.size(), std::size_t{4} * static_cast<std::size_t>(width * height));
  }
  for (const auto& [width, height] :
       {std::pair{0, 10}, {10, 0}, {-1, 10}, {kMaxPictureSide + 1, 10}}) {
    EXPECT_THROW(drawFrame(context(), scene, {1, boxes}, {}, width, height), RenderError);
  }
}

TEST_P(EachSource, ShaderErrorsAreReported) {
  const Gl gl(context());
  try {
    makeProgram(gl, "void main() { nonsense = 1; }", "");
    FAIL() << "nonsense was compiled";
  } catch (const RenderError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("vertex shader"), HasSubstr("nonsense")));
  }
}

TEST_P(EachSource, GlErrorsAreReported) {
  const Gl gl(context());
  gl.Enable(0xFFFF);
  try {
    gl.check("testing");
    FAIL() << "no error";
  } catch (const RenderError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("invalid enum"), HasSubstr("testing")));
  }
  EXPECT_NO_THROW(gl.check("testing again"));
}

TEST(OffscreenContext, SourcesGiveTheSamePicture) {
  const OffscreenOptions options = softwareOnly();
  for (const std::string& library : {options.egl_library, options.osmesa_library}) {
    if (!isInstalled(library)) GTEST_SKIP() << library << " is not installed";
  }
  const TestScene scene(200);
  const Picture egl = scene.draw(*makeOffscreenContext(GlSource::egl, options));
  const Picture osmesa = scene.draw(*makeOffscreenContext(GlSource::osmesa, options));
  EXPECT_TRUE(looksLike(egl, osmesa, "egl-osmesa"));
}

TEST(OffscreenContext, CanBeMadeAgainAndAgain) {
  if (!isInstalled(softwareOnly().egl_library)) GTEST_SKIP() << "libEGL.so.1 is not installed";
  const TestScene scene(10);
  const Picture first = scene.draw(*makeOffscreenContext(GlSource::egl, softwareOnly()));
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(scene.draw(*makeOffscreenContext(GlSource::egl, softwareOnly())).rgba, first.rgba);
  }
}

TEST(OffscreenContext, WithoutLibrariesNamesEachSourceAndWhy) {
  OffscreenOptions none;
  none.egl_library = "libNoSuchEGL.so.1";
  none.osmesa_library = "libNoSuchOSMesa.so.8";
  const auto egl = HasSubstr("EGL: libNoSuchEGL.so.1");
  const auto osmesa = HasSubstr("OSMesa: libNoSuchOSMesa.so.8");
  EXPECT_THAT(messageOf(GlSource::automatic, none), AllOf(egl, osmesa));
  EXPECT_THAT(messageOf(GlSource::egl, none), AllOf(egl, Not(osmesa)));
  EXPECT_THAT(messageOf(GlSource::osmesa, none), AllOf(osmesa, Not(egl)));
}

TEST(OffscreenContext, ALibraryThatIsNoGlIsRefused) {
  OffscreenOptions wrong;
  wrong.egl_library = wrong.osmesa_library = "libc.so.6";
  EXPECT_THAT(messageOf(GlSource::automatic, wrong),
              AllOf(HasSubstr("EGL: libc.so.6 lacks egl"), HasSubstr("libc.so.6 lacks OSMesa")));
}

TEST(OffscreenContext, AutomaticFallsBackToOsmesa) {
  OffscreenOptions options = softwareOnly();
  if (!isInstalled(options.osmesa_library)) GTEST_SKIP() << "libOSMesa.so.8 is not installed";
  options.egl_library = "libNoSuchEGL.so.1";
  EXPECT_THAT(makeOffscreenContext(GlSource::automatic, options)->description(),
              HasSubstr("OSMesa"));
}

// EGL without drivers. In a separate process, because Mesa reads its environment only once.
TEST(OffscreenContextDeathTest, WithoutDriversNamesEachDisplayAndWhy) {
  if (!isInstalled(softwareOnly().egl_library)) GTEST_SKIP() << "libEGL.so.1 is not installed";
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  EXPECT_EXIT(
      {
        setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent", 1);
        std::cerr << messageOf(GlSource::egl, {});
        std::_Exit(0);
      },
      testing::ExitedWithCode(0), "EGL: .*surfaceless platform: .*failed.*default display: ");
}

}  // namespace
}  // namespace broadmark::tests
