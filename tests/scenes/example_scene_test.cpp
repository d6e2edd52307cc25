// The example scenes in the assets: a scene from the editor, and a scene with changing bodies.

#include <gmock/gmock.h>

#include <cstdlib>

#include "broadmark/files.h"
#include "broadmark/scenes/authored_simulation.h"
#include "broadmark/scenes/brush.h"
#include "broadmark/scenes/scene_editor.h"
#include "entries.h"
#include "scenes/scene_runs.h"
#include "support/places.h"

namespace broadmark::scenes {
namespace {

std::unique_ptr<Brush> lineOf(int count, const ParameterValues& step) {
  auto brush = entryOf(brushEntries(), "line", "brush").create();
  setParameters(*brush, {{"count", std::to_string(count)}});
  setParameters(*brush, step);
  return brush;
}

constexpr int kDominoes = 24;
constexpr int kLayers = 5;

/// A table with a row of dominoes, a pyramid behind them, and a moving ball.
AuthoredScene dominoes() {
  SceneEditor editor;
  editor.setName("Dominoes");
  editor.setWorld({{-20, -4, -8, 0}, {20, 12, 8, 0}});
  // A domino starts to fall slowly, and must not fall asleep.
  editor.setParameters({{"frames", "250"}, {"friction", "0.3"}, {"sleep_threshold", "0"}});

  AuthoredBody table{.shape = BoxShape{{18, 0.5F, 4}}, .frozen = true};
  table.pose.position = {0, -0.5F, 0};
  editor.add({table});

  Paint thin;
  thin.scale = 0.2;
  editor.add(paint(*lineOf(kDominoes, {}), thin, {-14, 1, 0}, editor.scene().bodies).bodies);
  editor.setSize({0.3F, 2, 1});

  for (int layer = 0; layer < kLayers; ++layer) {
    const int cubes = kLayers - layer;
    const Vec3 first = {11, 0.5F + static_cast<float>(layer),
                        -0.5F * static_cast<float>(cubes - 1)};
    const auto row = lineOf(cubes, {{"step_x", "0"}, {"step_z", "1"}});
    editor.add(paint(*row, {}, first, editor.scene().bodies).bodies);
  }

  AuthoredBody ball{
      .shape = SphereShape{0.5F},
  };
  ball.pose.position = {-15.5F, 1.7F, 0};
  ball.linear_velocity = {5, 0.3F, 0};
  editor.add({ball});
  return editor.scene();
}

const std::filesystem::path kFile = places::source("assets/scenes/dominoes.json");

TEST(ExampleScene, IsWhatTheEditorMakes) {
  if (std::getenv("BROADMARK_UPDATE_GOLDEN") != nullptr) {
    writeTextFile(kFile, formatAuthoredScene(dominoes()));
  }
  EXPECT_EQ(readTextFile(kFile), formatAuthoredScene(dominoes()));
  EXPECT_EQ(dominoes().bodies.size(), 1 + kDominoes + kLayers * (kLayers + 1) / 2 + 1U);
}

TEST(ExampleScene, TheLastDominoFalls) {
  const auto frames = tests::allFrames(*makeAuthoredSimulation(dominoes()));
  for (int domino = 1; domino <= kDominoes; ++domino) {
    const auto id = static_cast<std::size_t>(domino);
    EXPECT_EQ(frames.front()[id].max[1], 2) << domino;
    EXPECT_LT(frames.back()[id].max[1], 1.9F) << domino;
  }
}

TEST(ExampleScene, ATrapdoorLetsTheCubesFallThroughATrigger) {
  const auto file = places::source("assets/scenes/trapdoor.json");
  const std::string text = readTextFile(file);
  const AuthoredScene scene = parseAuthoredScene(text, file.string());
  EXPECT_EQ(formatAuthoredScene(scene), text);
  constexpr std::size_t kDoor = 2;
  constexpr std::size_t kCubes = 12;
  constexpr std::uint32_t kTrigger = 15;
  const auto simulation = makeAuthoredSimulation(scene);
  const auto frames = tests::allFrames(*simulation);
  EXPECT_FALSE(isEmpty(frames[59][kDoor]));
  EXPECT_TRUE(isEmpty(frames[60][kDoor]));
  for (std::size_t cube = kDoor + 1; cube <= kDoor + kCubes; ++cube) {
    EXPECT_GT(frames[59][cube].min[1], 0.4F) << cube;
    EXPECT_LT(frames[200][cube].max[1], 0.4F) << cube;
  }
  EXPECT_EQ(frames[200][kTrigger], frames[0][kTrigger]);
  EXPECT_TRUE(simulation->scene().filter.wanted(kDoor + 1, kTrigger));
  EXPECT_FALSE(simulation->scene().filter.wanted(0, kTrigger));
}

}  // namespace
}  // namespace broadmark::scenes
