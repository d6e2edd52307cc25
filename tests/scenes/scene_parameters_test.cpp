// Files of scene parameters: their effects, and errors in invalid files.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "engine/helpers.h"
#include "scenes/scene_runs.h"

namespace broadmark::tests {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::ordered_json;

Json fileOf(const std::string& scene, const Json& parameters) {
  return {{"schema", "broadmark-scene-parameters/1"}, {"scene", scene}, {"parameters", parameters}};
}

std::string refusalOf(const std::string& text) {
  return inputErrorOf([&] { parseSceneParameters(text, "some file.json"); });
}

TEST(SceneParameters, SetWhatTheyStateAndLeaveTheDefaults) {
  const auto simulation = parseSceneParameters(
      fileOf("freefall",
             {{"objects", 250}, {"density", 1}, {"freeze_slow", true}, {"object_type", "spheres"}})
          .dump(),
      "file");
  ParameterValues expected = parameterValues(*makeSimulation("freefall"));
  expected["objects"] = "250";
  expected["density"] = "1";
  expected["freeze_slow"] = "on";
  expected["object_type"] = "spheres";
  EXPECT_EQ(parameterValues(*simulation), expected);

  const auto bare = parseSceneParameters(
      R"({"schema": "broadmark-scene-parameters/1", "scene": "City"})", "file");
  EXPECT_EQ(bare->scene(), makeSimulation("city")->scene());
}

TEST(SceneParameters, SurviveARoundTripForEverySceneAndEngine) {
  for (const SceneListing& scene : builtinScenes()) {
    for (const EngineListing& engine : availableEngines()) {
      const bool replay = engine.dynamics == Dynamics::replayed;
      auto simulation = makeSimulation(scene.id, engine.id);
      setParameters(*simulation, replay ? ParameterValues{{"input", "a \"b\\c\" ü"}}
                                        : ParameterValues{{"density", "0.012345678901"}});
      const std::string text = formatSceneParameters(*simulation);
      const auto again = parseSceneParameters(text, "written");
      EXPECT_EQ(again->listing().id, scene.id);
      EXPECT_EQ(parameterValues(*again), parameterValues(*simulation)) << text;
      if (!replay) {
        EXPECT_EQ(again->scene(), simulation->scene());
      }
    }
  }
}

TEST(SceneParameters, OfAnEngineAreKnownWhenItIsChosen) {
  const Json boids = {{"engine", "boids"}, {"alignment", 7}};
  EXPECT_EQ(
      parameterValues(*parseSceneParameters(fileOf("brownian", boids).dump(), "f")).at("alignment"),
      "7");
  EXPECT_THAT(refusalOf(fileOf("brownian", {{"alignment", 7}}).dump()),
              HasSubstr("unknown parameter 'alignment'"));
}

TEST(SceneParameters, RefusalsNameFileKeyAndWhatWouldBeRight) {
  const auto with = [](const char* key, const Json& value) {
    return fileOf("freefall", {{key, value}}).dump();
  };
  Json no_scene = fileOf("freefall", Json::object());
  no_scene.erase("scene");
  Json more = fileOf("freefall", Json::object());
  more["paramters"] = 1;
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases = {
      {with("densty", 0.1), {"densty", "did you mean 'density'?"}},
      {with("objects", -1), {"objects", "'-1' is not an integer in 0…10000000"}},
      {with("objects", 1.5), {"objects", "'1.5'", "integer"}},
      {with("objects", "1000"), {"objects", "'\"1000\"'", "integer"}},
      {with("objects", nullptr), {"objects", "null"}},
      {with("objects", {1, 2}), {"objects", "[…]"}},
      {with("density", true), {"density", "'true'", "number"}},
      {with("density", 1.5), {"density", "'1.5'", "1e-06…1"}},
      {with("freeze_slow", 1), {"freeze_slow", "true", "false"}},
      {with("freeze_slow", "on"), {"freeze_slow", "true", "false"}},
      {with("engine", "bulet"), {"engine", "'bullet'"}},
      {with("engine", 3), {"engine", "'3'", "bullet"}},
      {with("strength", 4), {"strength"}},
      {fileOf("freefall", {{"engine", "viewer"}, {"input", 4}}).dump(), {"input", "'4'", "string"}},
      {fileOf("freefall", {{"engine", "viewer"}, {"density", 1}}).dump(), {"'density'"}},
      {fileOf("freefal", Json::object()).dump(), {"freefal", "'freefall'"}},
      {fileOf("freefall", 3).dump(), {"parameters", "object"}},
      {no_scene.dump(), {"'scene' is missing"}},
      {more.dump(), {"paramters", "'parameters'"}},
      {R"({"schema": "broadmark-results/1"})", {"broadmark-results/1", "scene-parameters"}},
      {R"({"schema": 1})", {"schema"}},
      {"{}", {"'schema' is missing"}},
      {"[]", {"object"}},
      {"{", {"not valid JSON", "line 1"}},
  };
  for (const auto& [text, words] : cases) {
    const std::string refusal = refusalOf(text);
    EXPECT_THAT(refusal, ::testing::StartsWith("some file.json: ")) << text;
    EXPECT_EQ(refusal.find('\n'), std::string::npos) << refusal;
    for (const std::string& word : words) EXPECT_THAT(refusal, HasSubstr(word)) << text;
  }
}

}  // namespace
}  // namespace broadmark::tests
