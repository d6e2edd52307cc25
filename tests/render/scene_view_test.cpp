#include "broadmark/render/scene_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <random>

#include "broadmark/render/framebuffer.h"
#include "broadmark/render/offscreen_context.h"
#include "software_rasterizer.h"
#include "support/drawing.h"
#include "support/pictures.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr double kAspect = static_cast<double>(kWidth) / kHeight;
constexpr Rgb kBlue = 0x3366CC;
constexpr Rgb kRed = 0xCC3322;

const Aabb kWorld = cube({0, 0, 0}, 10);

struct Bodies {
  std::vector<Aabb> boxes;
  std::vector<Rgb> colours;
};

Bodies randomBodies(std::size_t count, float smallest, float largest) {
  Bodies bodies{randomCubes(count, smallest, largest, 77), {}};
  for (std::size_t i = 0; i < count; ++i) bodies.colours.push_back(i % 3 == 0 ? kRed : kBlue);
  return bodies;
}

/// Short and long lines in all three styles, some of which extend out of the world.
std::vector<SceneLine> randomLines(std::size_t count) {
  std::mt19937 random(99);
  std::uniform_real_distribution<float> place(-6, 6);
  std::uniform_real_distribution<float> step(-1, 1);
  std::vector<SceneLine> lines;
  for (std::size_t i = 0; i < count; ++i) {
    const std::array from = {place(random), place(random), place(random)};
    std::array to = from;
    for (float& at : to) at += (i % 10 == 0 ? 10 : 1) * step(random);
    const OcclusionStyle behind =
        std::array{OcclusionStyle::hidden, OcclusionStyle::faint, OcclusionStyle::shown}[i % 3];
    lines.push_back(
        {from, to, i % 2 == 0 ? 0x7A2BBFU : 0x2A9D8FU, static_cast<float>(1 + i % 3), behind});
  }
  return lines;
}

SceneViewContent contentOf(const Bodies& bodies) {
  SceneViewContent content;
  content.space = viewSpaceOf(kWorld);
  content.world = kWorld;
  content.boxes = bodies.boxes;
  content.colours = bodies.colours;
  return content;
}

OrbitCamera wholeWorld(Direction direction = Direction::figure) {
  return focusedOn(viewedFrom({}, direction), viewSpaceOf(kWorld).toView(kWorld), kAspect);
}

std::array<int, 3> colourAt(const Picture& picture, const Viewpoint& viewpoint,
                            const std::array<float, 4>& world_point) {
  return tests::colourAt(picture, pixelOf(viewpoint, viewSpaceOf(kWorld).toView(world_point)));
}

std::array<int, 3> colourInTheMiddle(const SceneView& view) {
  return tests::colourAt(view.read(), {kWidth / 2.0F, kHeight / 2.0F});
}

bool isRed(const std::array<int, 3>& rgb) { return rgb[0] > rgb[2] + 60; }
bool isBlue(const std::array<int, 3>& rgb) { return rgb[2] > rgb[0] + 60; }

/// Expects equal pictures except at borders of bodies, where fading and rounding differ slightly.
void expectAlike(const Picture& a, const Picture& b) {
  ASSERT_EQ(a.rgba.size(), b.rgba.size());
  std::size_t different = 0;
  double sum = 0;
  for (std::size_t pixel = 0; pixel < a.rgba.size(); pixel += 4) {
    int most = 0;
    for (std::size_t i = pixel; i < pixel + 3; ++i) {
      most = std::max(most, std::abs(a.rgba[i] - b.rgba[i]));
    }
    different += most > 24 ? 1 : 0;
    sum += most;
  }
  const auto pixels = static_cast<double>(a.rgba.size()) / 4;
  EXPECT_LT(static_cast<double>(different) / pixels, 0.01);
  EXPECT_LT(sum / pixels, 1.0);
}

class SceneViewTest : public testing::TestWithParam<Technique> {
 protected:
  SceneViewTest()
      : context_(makeOffscreenContext(GlSource::automatic, softwareOnly())), gl_(*context_) {}

  std::unique_ptr<SceneView> makeView(Technique technique, int threads = 2) {
    SceneViewOptions options;
    options.technique = technique;
    options.threads = threads;
    auto view = std::make_unique<SceneView>(gl_, options);
    view->resize(kWidth, kHeight);
    return view;
  }
  std::unique_ptr<SceneView> makeView() { return makeView(GetParam()); }
  const Gl& gl() const { return gl_; }

 private:
  std::unique_ptr<OffscreenContext> context_;
  Gl gl_;
};
INSTANTIATE_TEST_SUITE_P(Render, SceneViewTest, testing::Values(Technique::gl, Technique::splat),
                         [](const auto& technique) {
                           return technique.param == Technique::gl ? "Gl" : "Splat";
                         });

TEST_P(SceneViewTest, DrawsTheGoldenPictures) {
  const Bodies bodies = randomBodies(60, 0.5F, 1.5F);
  const std::vector<std::uint32_t> selected = {5, 40};
  const std::vector<SceneLine> lines = {
      {{-4, -4, 4}, {4, 4, -4}, 0x7A2BBF, 2, OcclusionStyle::faint},
      {{-4, 4, 4}, {4, -4, 4}, 0x2A9D8F, 3, OcclusionStyle::shown}};
  const std::vector<SceneWireBox> wire_boxes = {{cube({0, 0, 0}, 6), 0x2A9D8F}};
  SceneViewContent content = contentOf(bodies);
  content.selected = selected;
  content.lines = lines;
  content.wire_boxes = wire_boxes;
  content.shows_axes = true;
  const auto view = makeView();
  const auto golden = [](const std::string& name) {
    return places::source("tests/render/golden/" + name);
  };
  view->draw(content, wholeWorld());
  EXPECT_TRUE(looksLikeGolden(view->read(), golden("scene-light.png")));
  content.theme = kDarkPalette;
  view->draw(content, wholeWorld());
  EXPECT_TRUE(looksLikeGolden(view->read(), golden("scene-dark.png")));
}

TEST_P(SceneViewTest, TheNearerBodyIsInFront) {
  Bodies bodies{{cube({0, 0, 3}, 2), cube({0, 0, -3}, 3)}, {kRed, kBlue}};
  const auto view = makeView();
  for (const bool reversed : {false, true}) {
    if (reversed) {
      std::swap(bodies.boxes[0], bodies.boxes[1]);
      std::swap(bodies.colours[0], bodies.colours[1]);
    }
    SceneViewContent content = contentOf(bodies);
    content.bodies_revision = reversed ? 2 : 1;
    view->draw(content, wholeWorld(Direction::front));
    EXPECT_TRUE(isRed(colourInTheMiddle(*view)));
    view->draw(content, wholeWorld(Direction::back));
    EXPECT_TRUE(isBlue(colourInTheMiddle(*view)));
  }
}

TEST_P(SceneViewTest, OnlyVisibleBodiesAreDrawn) {
  const Bodies bodies{{cube({0, 0, 3}, 2), cube({0, 0, -3}, 3)}, {kRed, kBlue}};
  const std::vector<std::uint8_t> visible = {0, 1};
  SceneViewContent content = contentOf(bodies);
  content.visible = visible;
  const auto view = makeView();
  view->draw(content, wholeWorld(Direction::front));
  EXPECT_TRUE(isBlue(colourInTheMiddle(*view)));
}

TEST_P(SceneViewTest, AbsentBodiesAreNotDrawn) {
  const Bodies both{{cube({0, 0, 3}, 2), cube({0, 0, -3}, 3)}, {kRed, kBlue}};
  const Bodies second_only{{kEmptyBox, both.boxes[1], kEmptyBox}, {kRed, kBlue, kRed}};
  const std::vector<std::uint32_t> selected = {0};
  const auto picture = [&](const Bodies& bodies, std::span<const std::uint32_t> which) {
    SceneViewContent content = contentOf(bodies);
    content.selected = which;
    const auto view = makeView();
    view->draw(content, wholeWorld(Direction::front));
    return view->read();
  };
  const Bodies alone{{both.boxes[1]}, {kBlue}};
  EXPECT_EQ(picture(second_only, selected).rgba, picture(alone, {}).rgba);
}

TEST_P(SceneViewTest, TheSmallestBodyIsSeen) {
  const std::array<float, 4> somewhere = {1.7F, 2.3F, -0.9F, 0};
  for (const Aabb& box : {cube({1.7F, 2.3F, -0.9F}, 0), cube({1.7F, 2.3F, -0.9F}, 1e-5F),
                          Aabb{{-4, 2.3F, -4, 0}, {4, 2.3F, 4, 0}}}) {
    const Bodies bodies{{box}, {kRed}};
    SceneViewContent content = contentOf(bodies);
    const auto view = makeView();
    // The plate is seen edge-on.
    view->draw(content, wholeWorld(Direction::front));
    const Picture picture = view->read();
    bool seen = false;
    const std::array at = pixelOf(view->viewpoint(), content.space.toView(somewhere));
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        const std::array near = {at[0] + static_cast<float>(dx), at[1] + static_cast<float>(dy)};
        seen = seen || isRed(tests::colourAt(picture, near));
      }
    }
    EXPECT_TRUE(seen);
  }
}

TEST_P(SceneViewTest, ABodyAroundTheEyeIsNotDrawn) {
  const Bodies bodies{{cube({0, 0, 0}, 1000), cube({0, 0, 0}, 3)}, {kRed, kBlue}};
  const auto view = makeView();
  view->draw(contentOf(bodies), wholeWorld(Direction::front));
  EXPECT_TRUE(isBlue(colourInTheMiddle(*view)));
}

TEST_P(SceneViewTest, BodiesAcrossTheNearPlaneAreDrawn) {
  // A beam beside the view axis, from behind the eye to far in front of it.
  const Bodies bodies{{{{0.2F, -1, -100, 0}, {3, 1, 100, 0}}}, {kRed}};
  const auto view = makeView();
  view->draw(contentOf(bodies), wholeWorld(Direction::front));
  const Picture picture = view->read();
  EXPECT_TRUE(isRed(tests::colourAt(picture, {kWidth * 0.7F, kHeight / 2.0F})));
  EXPECT_FALSE(isRed(tests::colourAt(picture, {kWidth * 0.3F, kHeight / 2.0F})));
}

TEST_P(SceneViewTest, BodiesHideLinesUnlessTheyAreToBeShown) {
  const Bodies bodies{{cube({0, 0, 0}, 4)}, {kBlue}};
  std::vector<SceneLine> lines = {{{-4, 0, -4}, {4, 0, -4}, 0xE00000, 3, OcclusionStyle::hidden}};
  SceneViewContent content = contentOf(bodies);
  const auto view = makeView();
  const auto drawnWith = [&](OcclusionStyle behind) {
    lines[0].behind = behind;
    content.lines = lines;
    ++content.lines_revision;
    view->draw(content, wholeWorld(Direction::front));
    const Picture picture = view->read();
    EXPECT_TRUE(isRed(colourAt(picture, view->viewpoint(), {3.9F, 0, -4, 0})));
    return colourAt(picture, view->viewpoint(), {0, 0, -4, 0});
  };
  const auto hidden = drawnWith(OcclusionStyle::hidden);
  const auto faint = drawnWith(OcclusionStyle::faint);
  EXPECT_TRUE(isBlue(hidden));
  EXPECT_GT(faint[0], hidden[0] + 20);
  EXPECT_FALSE(isRed(faint));
  EXPECT_TRUE(isRed(drawnWith(OcclusionStyle::shown)));
}

TEST_P(SceneViewTest, BodiesAreSeenThroughGlass) {
  const Bodies bodies{{cube({0, 0, -3}, 3), cube({0, 0, 3}, 2)}, {kRed, kBlue}};
  const std::vector<std::uint8_t> glass = {0, 1};
  SceneViewContent content = contentOf(bodies);
  const auto view = makeView();
  view->draw(content, wholeWorld(Direction::front));
  EXPECT_TRUE(isBlue(colourInTheMiddle(*view)));
  content.glass = glass;
  ++content.bodies_revision;
  view->draw(content, wholeWorld(Direction::front));
  const std::array<int, 3> through = colourInTheMiddle(*view);
  EXPECT_TRUE(isRed(through));
  view->draw(content, wholeWorld(Direction::back));  // behind the other body
  EXPECT_TRUE(isRed(colourInTheMiddle(*view)));
  const std::vector<std::uint8_t> visible = {1, 0};
  content.visible = visible;
  ++content.bodies_revision;
  view->draw(content, wholeWorld(Direction::front));
  const std::array<int, 3> alone = colourInTheMiddle(*view);
  EXPECT_GT(through[2], alone[2]) << "the glass tints what is behind it";
}

TEST_P(SceneViewTest, SelectionIsSeenThroughOtherBodies) {
  const Bodies bodies{{cube({0, 0, -2}, 2), cube({0, 0, 2}, 4)}, {kBlue, kBlue}};
  const std::vector<std::uint32_t> selected = {0, 99};  // body 99 does not exist
  SceneViewContent content = contentOf(bodies);
  const auto view = makeView();
  view->draw(content, wholeWorld(Direction::front));
  const Picture before = view->read();
  content.selected = selected;
  ++content.bodies_revision;
  view->draw(content, wholeWorld(Direction::front));
  EXPECT_NE(view->read().rgba, before.rgba);
}

TEST_P(SceneViewTest, DrawsAnewOnlyWhatHasChanged) {
  Bodies bodies{{cube({0, 0, 0}, 4)}, {kBlue}};
  SceneViewContent content = contentOf(bodies);
  const auto view = makeView();
  const auto centre = [&](const OrbitCamera& camera) {
    view->draw(content, camera);
    return colourInTheMiddle(*view);
  };
  EXPECT_TRUE(isBlue(centre(wholeWorld(Direction::front))));
  bodies.colours[0] = kRed;  // same revision: not read
  EXPECT_TRUE(isBlue(centre(wholeWorld(Direction::front))));
  EXPECT_TRUE(isBlue(centre(wholeWorld(Direction::back))));
  ++content.bodies_revision;
  EXPECT_TRUE(isRed(centre(wholeWorld(Direction::back))));
}

TEST_P(SceneViewTest, LeavesTheTargetThatWasSet) {
  const Framebuffer other(gl(), 64, 32, 1);
  other.bind();
  const GLint bound = gl().integer(GL_FRAMEBUFFER_BINDING);
  const Bodies bodies = randomBodies(10, 0.5F, 1);
  const auto view = makeView();
  view->draw(contentOf(bodies), wholeWorld());
  EXPECT_EQ(gl().integer(GL_FRAMEBUFFER_BINDING), bound);
  GLint viewport[4];
  gl().GetIntegerv(GL_VIEWPORT, viewport);
  EXPECT_EQ(viewport[2], 64);
  EXPECT_EQ(viewport[3], 32);
  EXPECT_NO_THROW(gl().check("testing"));
}

TEST_P(SceneViewTest, EverySizeAndNoBodiesAreDrawn) {
  const auto view = makeView();
  SceneViewContent content;
  content.world = kWorld;
  content.space = viewSpaceOf(kWorld);
  const Bodies bodies = randomBodies(20, 0.5F, 2);
  for (const auto& [width, height] :
       {std::pair{1, 1}, {0, -3}, {7, 300}, {301, 5}, {33, 33}, {640, 480}}) {
    view->resize(width, height);
    view->draw(content, wholeWorld());
    EXPECT_EQ(view->read().width, std::max(1, width));
    SceneViewContent full = contentOf(bodies);
    full.bodies_revision = content.bodies_revision + 1;
    view->draw(full, wholeWorld());
    EXPECT_EQ(view->read().height, std::max(1, height));
    content.bodies_revision += 2;
  }
}

TEST_P(SceneViewTest, BothTechniquesGiveTheSamePicture) {
  if (GetParam() != Technique::gl) GTEST_SKIP() << "compares both";
  const auto by_gl = makeView(Technique::gl);
  const auto by_splat = makeView(Technique::splat);
  const std::vector<SceneLine> lines = randomLines(200);
  for (const auto& [count, smallest, largest] :
       {std::tuple{30, 1.0F, 3.0F}, {300, 0.3F, 0.8F}, {3000, 0.01F, 0.1F}}) {
    const Bodies bodies = randomBodies(static_cast<std::size_t>(count), smallest, largest);
    for (const Direction direction : {Direction::figure, Direction::top, Direction::bottom}) {
      SceneViewContent content = contentOf(bodies);
      content.bodies_revision = static_cast<std::uint64_t>(count);
      content.theme = direction == Direction::top ? kDarkPalette : kLightPalette;
      content.lines = lines;
      content.lines_revision = 1;
      std::vector<std::uint8_t> glass(bodies.boxes.size());
      for (std::size_t body = 0; body < glass.size(); body += 5) glass[body] = 1;
      content.glass = glass;
      by_gl->draw(content, wholeWorld(direction));
      by_splat->draw(content, wholeWorld(direction));
      SCOPED_TRACE(std::to_string(count) + " bodies, " +
                   std::string(kDirections.nameOf(direction)));
      expectAlike(by_gl->read(), by_splat->read());
    }
  }
}

TEST_P(SceneViewTest, LinesAroundTheEyeAreDrawnAlike) {
  if (GetParam() != Technique::gl) GTEST_SKIP() << "compares both";
  const Bodies bodies{{cube({0, 0, -4}, 2)}, {kBlue}};
  const std::vector<SceneLine> lines = randomLines(300);
  SceneViewContent content = contentOf(bodies);
  content.lines = lines;
  Camera camera;
  camera.eye = {0, 0, 0};
  camera.target = {0.1F, 0.05F, -1};
  const auto by_gl = makeView(Technique::gl);
  const auto by_splat = makeView(Technique::splat);
  by_gl->draw(content, camera);
  by_splat->draw(content, camera);
  expectAlike(by_gl->read(), by_splat->read());
}

TEST_P(SceneViewTest, TechniqueFollowsTheDriver) {
  if (GetParam() != Technique::gl) GTEST_SKIP() << "once is enough";
  EXPECT_TRUE(isSoftwareRenderer(gl()));
  EXPECT_TRUE(makeView(Technique::automatic)->usesSoftwareRenderer());
  EXPECT_FALSE(makeView(Technique::gl)->usesSoftwareRenderer());
}

TEST(AxisTips, PointAlongTheAxes) {
  const Viewpoint viewpoint{toCamera(wholeWorld(Direction::front), kAspect, kWorld), kWidth,
                            kHeight, 0};
  const auto [x, y, z] = axisTips(viewpoint, 1);
  EXPECT_GT(x[0], z[0] + 20);
  EXPECT_NEAR(x[1], z[1], 1);
  EXPECT_LT(y[1], z[1] - 20);
  EXPECT_NEAR(y[0], z[0], 1);
  for (const auto& tip : {x, y, z}) {
    EXPECT_GT(tip[0], 0);
    EXPECT_LT(tip[1], kHeight);
  }
}

TEST(SoftwareRasterizer, GivesTheSamePictureWithEveryTeamAndInstructionSet) {
  const Bodies bodies = randomBodies(5000, 0.01F, 0.6F);
  const ViewSpace space = viewSpaceOf(kWorld);
  const std::vector<SceneLine> lines = randomLines(3000);
  std::vector<std::uint8_t> glass(bodies.boxes.size());
  for (std::size_t body = 0; body < glass.size(); body += 3) glass[body] = 1;
  SceneViewContent content = contentOf(bodies);
  content.glass = glass;
  content.lines = lines;
  ThreadTeam alone(1);
  ScenePrimitives scene;
  setBodies(scene, content, alone);
  setLines(scene, content);
  setSurroundings(scene, content);
  const Viewpoint viewpoint{toCamera(wholeWorld(), kAspect, space.toView(kWorld)), 333, 241,
                            0xF5F6F8};
  SoftwareRasterizer reference(alone, Isa::scalar);
  reference.draw(scene, viewpoint);
  for (const int threads : {1, 3}) {
    for (const auto& [isa, name] : kIsas.entries) {
      if (!isaSupported(isa)) continue;
      ThreadTeam team(threads);
      SoftwareRasterizer splatter(team, isa);
      splatter.draw(scene, viewpoint);
      EXPECT_TRUE(std::ranges::equal(splatter.colours(), reference.colours())) << name;
    }
  }
}

}  // namespace
}  // namespace broadmark::tests
