// Settings files of the original Broadmark give the same runs.

#include "e2e/end_to_end.h"

namespace broadmark::tests {
namespace {

class OriginalSettings : public EndToEnd {
 protected:
  void SetUp() override { bakeRecording("scene file.aabbs", "50", "6"); }

  void writeSettings(const fs::path& name, const Json& settings) const {
    writeFile(file(name), settings.dump());
  }

  Json settings_ = {{"m_inputScene", "scene file.aabbs"},
                    {"m_outputLog", "the log.json"},
                    {"m_algorithm", "BF_SSE"},
                    {"m_numThreads", 2},
                    {"m_unknown", true}};
};

std::set<std::string> keysOf(const Json& object) {
  std::set<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.insert(key);
  return keys;
}

TEST_F(OriginalSettings, RunAndLogAsThere) {
  writeSettings("settings.json", settings_);
  const ProgramResult ended = runQuietly({"--headless", "settings.json", "--json", "results.json"});
  EXPECT_THAT(ended.out, HasSubstr("written: the log.json"));

  const Json result = readJson(file("results.json")).at("cases").at(0);
  EXPECT_EQ(result.at("algorithm"), "bf-simd");
  EXPECT_EQ(result.at("isa"), "sse2");
  EXPECT_EQ(result.at("status"), "ok");

  const Json log = readJson(file("the log.json"));
  EXPECT_EQ(keysOf(log), (std::set<std::string>{"Settings", "Frames"}));
  EXPECT_EQ(log.at("Settings"), (Json{{"m_inputScene", "scene file.aabbs"},
                                      {"m_outputLog", "the log.json"},
                                      {"m_algorithm", "BF_SSE"},
                                      {"m_algorithm_prettyName", "BF_SSE"},
                                      {"m_margin", {{"x", 0.01}, {"y", 0.01}, {"z", 0.01}}},
                                      {"m_numThreads", 2},
                                      {"m_Grid_ObjectsPerCell", 200},
                                      {"m_Tracy_ObjectsPerCell", 200},
                                      {"m_KD_ObjectsPerLeaf", 512},
                                      {"m_GPUSap_KernelType", 5},
                                      {"m_numberOfObjects", 50}}));
  ASSERT_EQ(log.at("Frames").size(), 6U);
  for (const Json& frame : log.at("Frames")) {
    EXPECT_EQ(keysOf(frame), (std::set<std::string>{"Total", "UpdateObjects", "CleanCache",
                                                    "UpdateStructures", "SearchOverlaps"}));
    EXPECT_GT(frame.at("Total"), 0);
    EXPECT_LT(frame.at("Total"), 1);
  }
}

TEST_F(OriginalSettings, ThreadsAreThoseOfTheFile) {
  settings_["m_algorithm"] = "SAP_Parallel";
  settings_["m_numThreads"] = 3;
  writeSettings("settings.json", settings_);
  runQuietly({"--headless", "settings.json", "--json", "results.json"});
  const Json result = readJson(file("results.json")).at("cases").at(0);
  EXPECT_EQ(result.at("algorithm"), "sap-mt");
  EXPECT_EQ(result.at("threads"), 3);
}

TEST_F(OriginalSettings, ParametersOfTheTreeAreThoseOfTheFile) {
  settings_["m_algorithm"] = "KD";
  settings_["m_KD_ObjectsPerLeaf"] = 20;
  settings_["m_margin"] = {{"x", 0.25}, {"y", 0.5}, {"z", 0.125}};
  writeSettings("settings.json", settings_);
  runQuietly({"--headless", "settings.json", "--json", "results.json"});
  const Json result = readJson(file("results.json")).at("cases").at(0);
  EXPECT_EQ(result.at("algorithm"), "kd");
  EXPECT_EQ(result.at("status"), "ok");
  EXPECT_EQ(result.at("params").at("objects_per_leaf"), "20");
  EXPECT_EQ(result.at("params").at("margin"), "0.5");
}

TEST_F(OriginalSettings, ObjectsPerCellAreThoseOfTheFile) {
  for (const char* const algorithm : {"Grid_3D", "Grid_2D_SAP"}) {
    settings_["m_algorithm"] = algorithm;
    settings_["m_Grid_ObjectsPerCell"] = 7;
    writeSettings("settings.json", settings_);
    runQuietly({"--headless", "settings.json", "--json", "results.json"});
    const Json result = readJson(file("results.json")).at("cases").at(0);
    EXPECT_EQ(result.at("status"), "ok");
    EXPECT_EQ(result.at("params").at("objects_per_cell"), "7") << algorithm;
  }
}

TEST_F(OriginalSettings, InputIsFoundBesideTheSettings) {
  fs::create_directory(file("sub folder"));
  fs::rename(file("scene file.aabbs"), file("sub folder/scene file.aabbs"));
  writeSettings("sub folder/settings.json", settings_);
  runQuietly({"--headless", "sub folder/settings.json"});
  EXPECT_TRUE(fs::exists(file("the log.json")));
}

// In the original, Tracy reads the grids' key, and no algorithm reads Tracy's.
TEST_F(OriginalSettings, TracysCellsAreThoseOfTheGrids) {
  settings_["m_algorithm"] = "Tracy_Parallel";
  settings_["m_Grid_ObjectsPerCell"] = 7;
  settings_["m_Tracy_ObjectsPerCell"] = 8;
  writeSettings("settings.json", settings_);
  runQuietly({"--headless", "settings.json", "--json", "results.json"});
  const Json result = readJson(file("results.json")).at("cases").at(0);
  EXPECT_EQ(result.at("algorithm"), "tracy-mt");
  EXPECT_EQ(result.at("status"), "ok");
  EXPECT_EQ(result.at("params").at("objects_per_cell"), "7");
}

TEST_F(OriginalSettings, FaultsAreNamed) {
  for (const std::string key : {"m_outputLog", "m_algorithm"}) {
    Json lacking = settings_;
    lacking.erase(key);
    writeSettings("settings.json", lacking);
    expectRefusal({"--headless", "settings.json"}, {"settings.json", key});
  }
  Json lacking = settings_;
  lacking.erase("m_inputScene");
  writeSettings("settings.json", lacking);
  expectRefusal({"--headless", "settings.json"}, {"settings.json", "m_inputScene"});

  const std::map<std::string, Json> wrong = {{"m_algorithm", "BF_SS"},
                                             {"m_numThreads", "four"},
                                             {"m_margin", 1},
                                             {"m_inputScene", "missing.aabbs"},
                                             {"m_outputLog", "missing/log.json"}};
  for (const auto& [key, value] : wrong) {
    Json changed = settings_;
    changed[key] = value;
    writeSettings("settings.json", changed);
    const bool is_path = value.is_string() && value.get<std::string>().starts_with("missing");
    expectRefusal({"--headless", "settings.json", "--quiet"},
                  {is_path ? value.get<std::string>() : key});
  }
  writeSettings("settings.json", settings_);
  expectRefusal({"--headless", "settings.json", "--algorithm", "sap"}, {"--algorithm"});
}

}  // namespace
}  // namespace broadmark::tests
