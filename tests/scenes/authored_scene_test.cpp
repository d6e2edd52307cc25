// Authored scenes: JSON, simulation, and creation from frames of other sources.

#include "broadmark/scenes/authored_scene.h"

#include <gmock/gmock.h>

#include <bit>
#include <random>

#include "broadmark/error.h"
#include "broadmark/recordings/posrot.h"
#include "broadmark/scenes/authored_simulation.h"
#include "broadmark/scenes/registry.h"
#include "engine/helpers.h"
#include "scenes/scene_runs.h"

namespace broadmark::scenes {
namespace {

using ::testing::HasSubstr;
using tests::allFrames;
using tests::inputErrorOf;
using tests::sceneWith;
using tests::TemporaryDirectory;

std::string refusalOf(const std::string& text) {
  return inputErrorOf([&] { parseAuthoredScene(text, "my scene.json"); });
}

/// A scene's JSON with members of one body, and more members of the scene.
std::string sceneText(const std::string& body, const std::string& more = "") {
  return R"({"schema": "broadmark-scene/1", "name": "Test", "world": {"min": [-9, -9, -9], "max": [9, 9, 9]}, )" +
         more + R"("bodies": [{"box": [1, 1, 1], "position": [0, 0, 0]}, {)" + body + "}]}";
}

std::string repeated(std::string_view text, int times) {
  std::string all;
  for (; times > 0; --times) all += text;
  return all;
}

/// A random float of absolute value up to `most`, including denormals and negative zero.
float anyFloat(std::mt19937& random, float most) {
  for (;;) {
    const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (std::abs(value) <= most) return random() % 16 == 0 ? -0.0F : value;
  }
}

Vec3 anyVector(std::mt19937& random, float most) {
  return {anyFloat(random, most), anyFloat(random, most), anyFloat(random, most)};
}

float anySize(std::mt19937& random) {
  for (;;) {
    const float size = std::abs(anyFloat(random, kMaxEdge / 2));
    if (size >= kMinEdge) return size;
  }
}

AuthoredScene anyScene(unsigned seed, std::size_t bodies) {
  std::mt19937 random(seed);
  AuthoredScene scene{.name = "Any \"scene\" \\", .parameters = {{"gravity_x", "0.1"}}};
  scene.world = {{-1e9F, -0.0F, 1e-40F, 0}, {0.1F, 3, 1e9F, 0}};
  scene.collide.set(random() % 32, random() % 32, false);
  scene.triggers = static_cast<std::uint32_t>(random()) | 1U;
  for (std::size_t i = 0; i < bodies; ++i) {
    AuthoredBody body;
    if (random() % 2 == 0) {
      body.shape = SphereShape{anySize(random)};
    } else {
      body.shape = BoxShape{{anySize(random), anySize(random), anySize(random)}};
    }
    body.mass = random() % 2 == 0 ? 1 : 1e-3 + static_cast<double>(random()) / 5;
    body.frozen = random() % 4 == 0;
    body.pose.position = anyVector(random, 1e9F);
    if (random() % 2 == 0) {
      body.pose.rotation = {-0.0F, std::sin(0.1F * static_cast<float>(i)), 0,
                            std::cos(0.1F * static_cast<float>(i))};
    }
    body.linear_velocity = random() % 2 == 0 ? Vec3{} : anyVector(random, 1e6F);
    body.angular_velocity = random() % 2 == 0 ? Vec3{} : anyVector(random, 1e6F);
    body.layer = static_cast<std::uint8_t>(random() % 32);
    if (random() % 2 == 0) body.appears = static_cast<std::uint32_t>(random() % 1000);
    if (random() % 2 == 0) {
      body.vanishes = body.appears + 1 + static_cast<std::uint32_t>(random() % 1000);
    }
    if (random() % 3 == 0) body.group = 1 + static_cast<std::uint32_t>(random() % 5);
    scene.bodies.push_back(body);
  }
  return scene;
}

/// The bits of a body's floats, to distinguish negative zero from zero.
std::vector<std::uint32_t> bitsOf(const AuthoredBody& body) {
  std::vector<std::uint32_t> bits;
  const auto add = [&](const auto& floats) {
    for (const float value : floats) bits.push_back(std::bit_cast<std::uint32_t>(value));
  };
  add(body.pose.position);
  add(body.pose.rotation);
  add(body.linear_velocity);
  add(body.angular_velocity);
  return bits;
}

TEST(AuthoredScene, SurvivesARoundTripBitForBit) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const AuthoredScene scene = anyScene(seed, 100);
    const std::string text = formatAuthoredScene(scene);
    const AuthoredScene again = parseAuthoredScene(text, "again");
    ASSERT_EQ(again, scene);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      ASSERT_EQ(bitsOf(again.bodies[i]), bitsOf(scene.bodies[i])) << seed << " " << i;
    }
    EXPECT_TRUE(std::signbit(again.world.min[1]));
    EXPECT_EQ(formatAuthoredScene(again), text);
  }
}

TEST(AuthoredScene, WritesOneBodyALine) {
  const std::string text = formatAuthoredScene(anyScene(1, 57));
  EXPECT_EQ(std::ranges::count(text, '\n'), 57 + 10);
}

TEST(AuthoredScene, LeavesOutWhatHasItsDefault) {
  AuthoredScene scene{.name = "Two"};
  scene.bodies.resize(2);
  scene.bodies[1].shape = SphereShape{0.1F};
  scene.bodies[1].mass = 0.1;
  scene.bodies[1].frozen = true;
  EXPECT_EQ(formatAuthoredScene(scene),
            R"({
"schema": "broadmark-scene/1",
"name": "Two",
"world": {"min": [-10, -10, -10], "max": [10, 10, 10]},
"parameters": {},
"bodies": [
{"box": [1, 1, 1], "position": [0, 0, 0]},
{"sphere": 0.1, "position": [0, 0, 0], "mass": 0.1, "frozen": true}
]
}
)");
}

TEST(AuthoredScene, WritesLayersAndWhenBodiesComeAndGo) {
  AuthoredScene scene{.name = "Layers",
                      .collide = LayerMatrix().set(0, 1).set(2, 1),
                      .triggers = 1U << 2,
                      .bodies = {{.layer = 1, .appears = 3, .vanishes = 8}}};
  EXPECT_EQ(formatAuthoredScene(scene),
            R"({
"schema": "broadmark-scene/1",
"name": "Layers",
"world": {"min": [-10, -10, -10], "max": [10, 10, 10]},
"parameters": {},
"collide": [[0, 1], [1, 2]],
"triggers": [2],
"bodies": [
{"box": [1, 1, 1], "position": [0, 0, 0], "layer": 1, "appears": 3, "vanishes": 8}
]
}
)");
  scene.bodies[0].group = 12;
  EXPECT_THAT(formatAuthoredScene(scene), testing::HasSubstr("\"vanishes\": 8, \"group\": 12}"));
  scene.collide = {};
  EXPECT_EQ(parseAuthoredScene(formatAuthoredScene(scene), "again"), scene) << "none collides";
}

TEST(AuthoredScene, KeysMayComeInAnyOrder) {
  const AuthoredScene scene = parseAuthoredScene(
      R"({"bodies": [{"position": [1, 2, 3], "mass": 2, "sphere": 0.5}],
          "parameters": {"sight": 3, "engine": "boids"},
          "world": {"max": [4, 4, 4], "min": [-4, -4, -4]}, "name": "N",
          "schema": "broadmark-scene/1"})",
      "text");
  EXPECT_EQ(scene.bodies.at(0).shape, Shape(SphereShape{0.5F}));
  EXPECT_EQ(scene.bodies.at(0).pose.position, (Vec3{1, 2, 3}));
  EXPECT_EQ(scene.parameters, (ParameterValues{{"engine", "boids"}, {"sight", "3"}}));
}

TEST(AuthoredScene, RefusalsNameTheBodyTheKeyAndWhatIsRight) {
  const std::string position = R"("position": [0, 0, 0])";
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases = {
      {"", {"not valid JSON"}},
      {"{", {"not valid JSON", "line 1"}},
      {"[]", {"a JSON object"}},
      {"{}", {"schema"}},
      {R"({"schema": "broadmark-scene/2"})", {"broadmark-scene/2", "broadmark-scene/1"}},
      {R"({"schema": "broadmark-scene/1"})", {"'name' is missing"}},
      {R"({"schema": "broadmark-scene/1", "nam": 1})", {"'nam'", "'name'"}},
      {R"({"schema": "broadmark-scene/1", "name": "a/b", "world": {"min": [0,0,0], "max": [1,1,1]}, "bodies": []})",
       {"name", "'/'"}},
      {R"({"schema": "broadmark-scene/1", "name": "a", "world": {"min": [0,0,0], "max": [1,0,1]}, "bodies": []})",
       {"world", "min below max"}},
      {R"({"schema": "broadmark-scene/1", "world": {"min": [0,0]}})",
       {"world", "min", "three numbers"}},
      {R"({"schema": "broadmark-scene/1", "world": {"min": [0,0,0]}})", {"world", "'max'"}},
      {R"({"schema": "broadmark-scene/1", "bodies": {}})", {"bodies", "array of objects"}},
      {R"({"schema": "broadmark-scene/1", "bodies": [7]})", {"bodies", "array of objects"}},
      {sceneText(position), {"body 1", "'box' or 'sphere'"}},
      {sceneText(R"("sphere": 1)"), {"body 1", "'position' is missing"}},
      {sceneText(R"("sphere": 1, "box": [1, 1, 1], )" + position), {"body 1", "either"}},
      {sceneText(R"("sphere": 1, "sphere": 1)"), {"body 1", "'sphere' is stated twice"}},
      {sceneText(R"("sphere": "1", )" + position), {"body 1", "sphere: a number"}},
      {sceneText(R"("sphere": [1], )" + position), {"body 1", "sphere: a number"}},
      {sceneText(R"("box": 1, )" + position), {"body 1", "box: an array of three numbers"}},
      {sceneText(R"("sphere": 1, "group": -1, )" + position),
       {"body 1", "group: a whole number from 0 to 10000000"}},
      {sceneText(R"("sphere": 1, "group": 0.5, )" + position), {"body 1", "group: a whole number"}},
      {sceneText(R"("sphere": 1, "group": "a", )" + position), {"body 1", "group: a number"}},
      {sceneText(R"("sphere": 1, "group": 1e300, )" + position), {"body 1", "group: a whole"}},
      {sceneText(R"("box": [[1, 1, 1]], )" + position),
       {"body 1", "box: an array of three numbers"}},
      {sceneText(R"("box": [[[[[[1]]]]]], )" + position), {"body 1", "box: nested too deeply"}},
      {sceneText(R"("box": [)" + repeated("1, ", 9999) + "1], " + position),
       {"body 1", "box: too many values"}},
      {sceneText(R"("box": [1, null, 1])"), {"body 1", "box: an array of three numbers"}},
      {sceneText(R"("box": [0, 1, 1], )" + position), {"body 1", "size", "1e-06"}},
      {sceneText(R"("sphere": -1, )" + position), {"body 1", "size"}},
      {sceneText(R"("sphere": 1, "position": [1e10, 0, 0])"), {"body 1", "position", "1e+09"}},
      {sceneText(R"("sphere": 1, "rotation": [0, 0, 0, 2], )" + position),
       {"body 1", "rotation", "unit length"}},
      {sceneText(R"("sphere": 1, "rotation": [0, 0, 1], )" + position),
       {"body 1", "rotation: an array of four numbers"}},
      {sceneText(R"("sphere": 1, "mass": 0, )" + position), {"body 1", "mass"}},
      {sceneText(R"("sphere": 1, "frozen": 1, )" + position), {"body 1", "frozen: true or false"}},
      {sceneText(R"("sphere": 1, "layer": 32, )" + position), {"body 1", "layer", "from 0 to 31"}},
      {sceneText(R"("sphere": 1, "layer": 0.5, )" + position), {"body 1", "layer", "from 0 to 31"}},
      {sceneText(R"("sphere": 1, "layer": "level", )" + position), {"body 1", "layer: a number"}},
      {sceneText(R"("sphere": 1, "appears": -1, )" + position), {"body 1", "appears", "1000000"}},
      {sceneText(R"("sphere": 1, "appears": 5, "vanishes": 5, )" + position),
       {"body 1", "vanishes", "from 6", "appears in frame 5"}},
      {sceneText(R"("sphere": 1, "vanishes": 1000001, )" + position), {"body 1", "vanishes"}},
      {sceneText(R"("sphere": 1, )" + position, R"("collide": 3, )"),
       {"collide", "an array of pairs of layers"}},
      {sceneText(R"("sphere": 1, )" + position, R"("collide": [1, 2], )"),
       {"collide", "an array of pairs of layers"}},
      {sceneText(R"("sphere": 1, )" + position, R"("collide": [[1, 2, 3]], )"),
       {"collide", "an array of pairs of layers"}},
      {sceneText(R"("sphere": 1, )" + position, R"("collide": [[1, 32]], )"),
       {"collide", "from 0 to 31"}},
      {sceneText(R"("sphere": 1, )" + position, R"("triggers": [[1]], )"),
       {"triggers", "an array of layers"}},
      {sceneText(R"("sphere": 1, )" + position, R"("triggers": [-1], )"),
       {"triggers", "from 0 to 31"}},
      {sceneText(R"("sphere": 1, "velocity": [0, 1e7, 0], )" + position), {"body 1", "velocity"}},
      {sceneText(R"("sphere": 1, "positon": [0, 0, 0])"), {"body 1", "'positon'", "'position'"}},
      {sceneText(R"("sphere": 1, )" + position, R"("parameters": {"objects": 5}, )"),
       {"unknown parameter 'objects'"}},
      {sceneText(R"("sphere": 1, )" + position, R"("parameters": {"engine": "viewer"}, )"),
       {"engine", "viewer", "bullet"}},
      {sceneText(R"("sphere": 1, )" + position, R"("parameters": {"frames": "5"}, )"),
       {"frames", "integer"}},
      {sceneText(R"("sphere": 1, )" + position, R"("parameters": {"frames": [5]}, )"), {"frames"}},
      {sceneText(R"("sphere": 1, )" + position, R"("parameters": 3, )"),
       {"parameters", "an object"}},
      {sceneText(R"("sphere": 1, )" + position) + "x", {"not valid JSON"}},
  };
  for (const auto& [text, words] : cases) {
    const std::string refusal = refusalOf(text);
    EXPECT_THAT(refusal, ::testing::StartsWith("my scene.json: ")) << text;
    EXPECT_EQ(refusal.find('\n'), std::string::npos) << refusal;
    for (const std::string& word : words) EXPECT_THAT(refusal, HasSubstr(word)) << text;
  }
}

/// A few bodies that fall onto a frozen floor.
AuthoredScene fallingScene() {
  AuthoredScene scene{.name = "Falling", .parameters = {{"frames", "20"}}};
  AuthoredBody floor{.shape = BoxShape{{8, 0.5F, 8}}, .frozen = true};
  floor.pose.position = {0, -5, 0};
  scene.bodies.push_back(floor);
  for (int i = 0; i < 6; ++i) {
    AuthoredBody body;
    body.pose.position = {static_cast<float>(i) - 3, static_cast<float>(i % 3), 0.1F};
    if (i % 2 == 0) body.shape = SphereShape{0.4F};
    body.linear_velocity = {0.5F, 0, 1};
    body.angular_velocity = {0, 2, 0};
    scene.bodies.push_back(body);
  }
  return scene;
}

TEST(AuthoredSimulation, StartsAsAuthoredWithEveryEngineAndGivesTheSameBits) {
  for (const EngineEntry& engine : engineEntries()) {
    AuthoredScene scene = fallingScene();
    scene.parameters["engine"] = engine.listing.id;
    const auto simulation = makeAuthoredSimulation(scene);
    EXPECT_EQ(simulation->scene().name, "Falling");
    EXPECT_EQ(simulation->scene().object_type, "Assorted");
    EXPECT_EQ(simulation->scene().objects, 7U);
    EXPECT_EQ(simulation->scene().world, scene.world);
    const auto frames = allFrames(*simulation);
    ASSERT_EQ(frames.size(), 21U);
    EXPECT_EQ(frames[0], boxesOf(scene)) << engine.listing.id;
    EXPECT_NE(frames[20], frames[0]) << engine.listing.id;
    EXPECT_EQ(frames[20][0], frames[0][0]) << "frozen, " << engine.listing.id;
    EXPECT_EQ(allFrames(*makeAuthoredSimulation(scene)), frames) << engine.listing.id;
    EXPECT_EQ(allFrames(*simulation), frames) << "rewound, " << engine.listing.id;
  }
}

TEST(AuthoredSimulation, GravityPointsWhereItIsSaid) {
  AuthoredScene scene = fallingScene();
  scene.parameters = {{"frames", "3"}, {"gravity_x", "9"}, {"gravity_y", "0"}};
  const auto frames = allFrames(*makeAuthoredSimulation(scene));
  const auto way = tests::way(frames[0][2], frames[3][2]);
  EXPECT_NEAR(way[0], 0.5 * 0.1 + 9 * 0.1 * 0.1 / 2, 0.02);
  EXPECT_NEAR(way[1], 0, 1e-4);
}

TEST(AuthoredSimulation, BodiesAppearWhereTheyAreStatedAndVanish) {
  for (const EngineEntry& engine : engineEntries()) {
    AuthoredScene scene = fallingScene();
    scene.parameters["engine"] = engine.listing.id;
    scene.bodies[1].appears = 4;
    scene.bodies[2].vanishes = 7;
    scene.bodies[3].appears = 4;
    scene.bodies[3].vanishes = 5;
    scene.bodies[4].appears = 21;  // after the last frame
    const auto simulation = makeAuthoredSimulation(scene);
    EXPECT_FALSE(simulation->scene().all_present);
    const auto frames = allFrames(*simulation);
    const auto starts = boxesOf(scene);
    for (std::uint32_t frame = 0; frame <= 20; ++frame) {
      SCOPED_TRACE(engine.listing.id + " " + std::to_string(frame));
      EXPECT_EQ(isEmpty(frames[frame][1]), frame < 4);
      EXPECT_EQ(isEmpty(frames[frame][2]), frame >= 7);
      EXPECT_EQ(isEmpty(frames[frame][3]), frame != 4);
      EXPECT_TRUE(isEmpty(frames[frame][4]));
      EXPECT_FALSE(isEmpty(frames[frame][5]));
    }
    EXPECT_EQ(frames[4][1], starts[1]);
    EXPECT_NE(frames[5][1], starts[1]);
    EXPECT_EQ(frames[4][3], starts[3]);
    EXPECT_EQ(allFrames(*simulation), frames) << "rewound";
  }
  EXPECT_TRUE(makeAuthoredSimulation(fallingScene())->scene().all_present);
}

TEST(AuthoredSimulation, LayersCollideAsStatedAndTriggersPushNothing) {
  // A sphere falls onto a floor of layer 1; triggers are also reported.
  const auto falls_through = [](const LayerMatrix& collide, std::uint32_t triggers) {
    AuthoredScene scene{.name = "Layers", .parameters = {{"frames", "60"}}};
    scene.collide = collide;
    scene.triggers = triggers;
    scene.bodies = {{.shape = BoxShape{{8, 0.5F, 8}}, .frozen = true, .layer = 1},
                    {.shape = SphereShape{0.5F}, .pose = {.position = {0, 3, 0}}}};
    const auto simulation = makeAuthoredSimulation(scene);
    EXPECT_EQ(simulation->scene().filter.wanted(0, 1), collide.collide(0, 1));
    return allFrames(*simulation).back()[1].max[1] < 0;
  };
  EXPECT_FALSE(falls_through(LayerMatrix::all(), 0));
  EXPECT_FALSE(falls_through(LayerMatrix().set(0, 1), 0));
  EXPECT_TRUE(falls_through(LayerMatrix().set(0, 0).set(1, 1), 0));
  EXPECT_TRUE(falls_through(LayerMatrix::all(), 1U << 1));
  EXPECT_TRUE(falls_through(LayerMatrix().set(0, 1), 1U << 1));
}

TEST(AuthoredSimulation, StaysInsideAWorldOfAnyForm) {
  AuthoredScene scene{.name = "Flat", .parameters = {{"frames", "40"}, {"gravity_y", "0"}}};
  scene.world = {{1, -2, -8, 0}, {4, 2, 3, 0}};
  AuthoredBody body{.shape = SphereShape{0.2F}};
  body.pose.position = {2, 0, 0};
  body.linear_velocity = {9, 5, -20};
  scene.bodies = {body};
  for (const EngineListing& engine : availableEngines()) {
    if (engine.dynamics != Dynamics::rigid && engine.dynamics != Dynamics::passing) continue;
    scene.parameters["engine"] = engine.id;
    const auto frames = allFrames(*makeAuthoredSimulation(scene));
    for (const auto& frame : frames) {
      EXPECT_TRUE(tests::allInside(frame, scene.world, 0.1)) << engine.id;
    }
    EXPECT_GT(frames[20][0].min[0], 1 - 0.1F);
  }
}

TEST(AuthoredSimulation, IsReadAndWrittenLikeOtherScenes) {
  const AuthoredScene scene = fallingScene();
  const auto simulation = parseSceneParameters(formatAuthoredScene(scene), "some/file.json");
  EXPECT_EQ(simulation->listing().id, kAuthoredSceneId);
  EXPECT_EQ(simulation->input(), "some/file.json");
  setParameters(*simulation, {{"engine", "kinematic"}, {"frames", "5"}});
  const auto again = parseSceneParameters(formatSceneParameters(*simulation), "again");
  EXPECT_EQ(parameterValues(*again), parameterValues(*simulation));
  EXPECT_EQ(allFrames(*again), allFrames(*simulation));
  EXPECT_TRUE(describesScene("broadmark-scene/1"));
}

TEST(AuthoredSimulation, TellsOneSceneFromAnotherByItsContents) {
  AuthoredScene scene = fallingScene();
  const std::string hash = makeAuthoredSimulation(scene, "here.json")->inputHash();
  EXPECT_EQ(makeAuthoredSimulation(scene, "there.json")->inputHash(), hash);
  scene.bodies[3].linear_velocity[1] += 1e-6F;
  EXPECT_NE(makeAuthoredSimulation(scene)->inputHash(), hash);
}

TEST(AuthoredSimulation, RefusesAWrongScene) {
  AuthoredScene scene = fallingScene();
  scene.bodies[4].mass = -1;
  EXPECT_THAT(inputErrorOf([&] { makeAuthoredSimulation(scene); }), HasSubstr("body 4: mass"));
}

TEST(SceneFromFrame, OfASimulationGoesOnAsItWouldHave) {
  // Without contacts, a body's motion depends only on its pose and velocity.
  const auto simulation =
      sceneWith("freefall", {{"objects", "40"}, {"frames", "30"}, {"engine", "kinematic"}});
  const auto frames = allFrames(*simulation);
  const AuthoredScene scene = sceneFromFrame(*simulation, 10);
  EXPECT_EQ(boxesOf(scene), frames[10]);
  EXPECT_EQ(scene.world, simulation->scene().world);
  EXPECT_EQ(scene.parameters.at("engine"), "kinematic");
  const auto onwards = allFrames(*makeAuthoredSimulation(scene));
  for (std::size_t frame = 0; frame < 5; ++frame) {
    for (std::size_t i = 0; i < 40; ++i) {
      EXPECT_LT(tests::lengthOf(tests::way(frames[10 + frame][i], onwards[frame][i])), 1e-3)
          << frame << " " << i;
    }
  }
}

class SceneFromRecording : public ::testing::Test {
 protected:
  TemporaryDirectory directory_;
};

TEST_F(SceneFromRecording, OfPosesKeepsThem) {
  const auto simulation = sceneWith("brownian", {{"objects", "30"}, {"frames", "6"}});
  bake(*simulation, {directory_ / "a.posrot"});
  const auto recording = openRecordingFile(directory_ / "a.posrot");
  const AuthoredScene scene = sceneFromFrame(*recording, 6);
  const auto truth = sceneFromFrame(*simulation, 6);
  ASSERT_EQ(scene.bodies.size(), 30U);
  for (std::size_t i = 0; i < 30; ++i) {
    EXPECT_EQ(scene.bodies[i].pose, truth.bodies[i].pose);
    const Vec3& half = std::get<BoxShape>(scene.bodies[i].shape).half_extents;
    for (const float edge : half) EXPECT_NEAR(edge, 0.5, 1e-5);
  }
}

TEST_F(SceneFromRecording, OfBoxesKeepsThoseAndSpheresAreSpheres) {
  for (const std::string type : {"cubes", "spheres"}) {
    const auto simulation =
        sceneWith("brownian", {{"objects", "30"}, {"frames", "6"}, {"object_type", type}});
    bake(*simulation, {directory_ / (type + ".aabbs")});
    const auto recording = openRecordingFile(directory_ / (type + ".aabbs"));
    const AuthoredScene scene = sceneFromFrame(*recording, 4);
    const auto frame = recording->at(4);
    const auto boxes = boxesOf(scene);
    for (std::size_t i = 0; i < 30; ++i) {
      EXPECT_EQ(std::holds_alternative<SphereShape>(scene.bodies[i].shape), type == "spheres");
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(boxes[i].min[axis], frame.boxes[i].min[axis], 1e-4);
        EXPECT_NEAR(boxes[i].max[axis], frame.boxes[i].max[axis], 1e-4);
      }
    }
    EXPECT_EQ(parseAuthoredScene(formatAuthoredScene(scene), "again"), scene);
    EXPECT_THROW(sceneFromFrame(*recording, 7), InputError);
  }
}

}  // namespace
}  // namespace broadmark::scenes
