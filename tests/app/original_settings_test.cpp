// The original Broadmark's settings files and logs.

#include "original/settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/helpers.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using Json = nlohmann::ordered_json;

Json required() {
  return {{"m_inputScene", "scene.aabbs"}, {"m_outputLog", "log.json"}, {"m_algorithm", "SAP"}};
}

OriginalSettings parse(const Json& json) { return parseOriginalSettings(json.dump(), "s.json"); }

TEST(OriginalSettings, Defaults) {
  const OriginalSettings settings = parse(required());
  EXPECT_EQ(settings.input_scene, "scene.aabbs");
  EXPECT_EQ(settings.output_log, "log.json");
  EXPECT_EQ(settings.algorithm, "SAP");
  EXPECT_EQ(settings.pretty_name, "SAP");
  EXPECT_EQ(settings.margin, (std::array{0.01, 0.01, 0.01}));
  EXPECT_EQ(settings.threads, 4);
  EXPECT_EQ(settings.grid_objects_per_cell, 200);
  EXPECT_EQ(settings.tracy_objects_per_cell, 200);
  EXPECT_EQ(settings.kd_objects_per_leaf, 512);
  EXPECT_EQ(settings.gpu_sap_kernel_type, 5);
}

TEST(OriginalSettings, AllKeys) {
  Json json = required();
  json.update({{"m_algorithm_prettyName", "Sweep"},
               {"m_margin", {{"x", 1}, {"y", 0.5}}},
               {"m_numThreads", 8},
               {"m_Grid_ObjectsPerCell", 100},
               {"m_Tracy_ObjectsPerCell", 101},
               {"m_KD_ObjectsPerLeaf", 64},
               {"m_GPUSap_KernelType", 1},
               {"m_somethingElse", {1, 2}}});  // unknown keys are ignored
  const OriginalSettings settings = parse(json);
  EXPECT_EQ(settings.pretty_name, "Sweep");
  EXPECT_EQ(settings.margin, (std::array{1.0, 0.5, 0.01}));
  EXPECT_EQ(settings.threads, 8);
  EXPECT_EQ(settings.grid_objects_per_cell, 100);
  EXPECT_EQ(settings.tracy_objects_per_cell, 101);
  EXPECT_EQ(settings.kd_objects_per_leaf, 64);
  EXPECT_EQ(settings.gpu_sap_kernel_type, 1);
}

TEST(OriginalSettings, WrongTypesAreNamed) {
  const std::pair<const char*, Json> faults[] = {{"m_inputScene", 1},
                                                 {"m_outputLog", nullptr},
                                                 {"m_algorithm", Json::array()},
                                                 {"m_margin", 0.01},
                                                 {"m_margin", {{"x", "a"}}},
                                                 {"m_algorithm_prettyName", 5},
                                                 {"m_numThreads", "4"},
                                                 {"m_numThreads", 4.5},
                                                 {"m_numThreads", -1},
                                                 {"m_KD_ObjectsPerLeaf", true},
                                                 {"m_GPUSap_KernelType", UINT64_MAX}};
  for (const auto& [key, value] : faults) {
    Json json = required();
    json[key] = value;
    EXPECT_THAT(inputErrorOf([&] { parse(json); }),
                AllOf(StartsWith("s.json: "), HasSubstr(key), HasSubstr("expected")));
  }
}

TEST(OriginalSettings, MissingKeysAreNamed) {
  for (const char* key : {"m_inputScene", "m_outputLog", "m_algorithm"}) {
    Json json = required();
    json.erase(key);
    EXPECT_THAT(inputErrorOf([&] { parse(json); }), AllOf(StartsWith("s.json: "), HasSubstr(key)));
  }
}

TEST(OriginalSettings, AreRecognised) {
  EXPECT_TRUE(isOriginalSettings(required().dump(), "a"));
  for (const char* other :
       {"{}", "[]", "5", "null", R"({"schema": "broadmark-results/1"})", R"("m_inputScene")"}) {
    EXPECT_FALSE(isOriginalSettings(other, "a")) << other;
  }
  EXPECT_THAT(inputErrorOf([] { isOriginalSettings("{,}", "a"); }), StartsWith("a: "));
}

TEST(OriginalLog, HasTheOriginalsStructure) {
  CaseResult result;
  result.recording.scene.objects = 1000;
  FrameTimes first;
  first[Phase::total] = 1'500'000'000;
  first[Phase::update_objects] = 250'000'000;
  first[Phase::clean_cache] = 1;
  first[Phase::update_structures] = 500'000'000;
  first[Phase::search_overlaps] = 750'000'000;
  result.repetitions = {{.frames = {first, FrameTimes{}}}, {.frames = {first, first}}};

  const Json log = Json::parse(formatOriginalLog(parse(required()), result));
  EXPECT_EQ(log, Json::parse(R"({
    "Settings": {"m_inputScene": "scene.aabbs", "m_outputLog": "log.json", "m_algorithm": "SAP",
      "m_algorithm_prettyName": "SAP", "m_margin": {"x": 0.01, "y": 0.01, "z": 0.01},
      "m_numThreads": 4, "m_Grid_ObjectsPerCell": 200, "m_Tracy_ObjectsPerCell": 200,
      "m_KD_ObjectsPerLeaf": 512, "m_GPUSap_KernelType": 5, "m_numberOfObjects": 1000},
    "Frames": [
      {"Total": 1.5, "UpdateObjects": 0.25, "CleanCache": 1e-9, "UpdateStructures": 0.5,
       "SearchOverlaps": 0.75},
      {"Total": 0.0, "UpdateObjects": 0.0, "CleanCache": 0.0, "UpdateStructures": 0.0,
       "SearchOverlaps": 0.0}]})"));
}

TEST(OriginalLog, WithoutMeasurementsHasNoFrames) {
  const Json log = Json::parse(formatOriginalLog(parse(required()), CaseResult{}));
  EXPECT_EQ(log["Frames"], Json::array());
}

}  // namespace
}  // namespace broadmark::tests
