// Files of scene parameters: run, baked, and rerun from a recording's sidecar.

#include "e2e/end_to_end.h"

namespace broadmark::tests {
namespace {

class SceneParameters : public EndToEnd {
 protected:
  void writeParameters(const fs::path& name, const std::string& scene,
                       const Json& parameters) const {
    writeFile(file(name), Json{{"schema", "broadmark-scene-parameters/1"},
                               {"scene", scene},
                               {"parameters", parameters}}
                              .dump());
  }

  /// The only recording below a directory.
  [[nodiscard]] fs::path recordingIn(const std::string& directory) const {
    fs::path found;
    for (const auto& entry : fs::recursive_directory_iterator(file(directory))) {
      if (entry.path().extension() != ".aabbs") continue;
      EXPECT_EQ(found, fs::path()) << "more than one";
      found = entry.path();
    }
    EXPECT_NE(found, fs::path()) << "none in " << directory;
    return found;
  }
};

TEST_F(SceneParameters, AFileRunsAsTheSameOptionsWould) {
  writeParameters("my scene.json", "brownian",
                  {{"objects", 50}, {"frames", 6}, {"seed", 3}, {"launch_share", 0.5}});
  runQuietly({"--headless", "my scene.json", "--algorithm", "sap", "--json", "file.json"});
  runQuietly({"--headless", "brownian", "--objects", "50", "--frames", "6", "--seed", "3",
              "--param", "launch_share=0.5", "--algorithm", "sap", "--json", "options.json"});
  const Json from_file = readJson(file("file.json")).at("cases").at(0);
  const Json from_options = readJson(file("options.json")).at("cases").at(0);
  EXPECT_EQ(from_file.at("recording"), from_options.at("recording"));
  EXPECT_EQ(from_file.at("status"), "ok");
}

TEST_F(SceneParameters, OptionsOverrideAFile) {
  writeParameters("scene.json", "brownian", {{"objects", 50}, {"frames", 6}, {"seed", 3}});
  const ProgramResult listed = runQuietly({"--headless", "scene.json", "--objects", "20,30",
                                           "--list", "--algorithm", "sap", "--frames", "4"});
  ASSERT_EQ(linesOf(listed.out).size(), 2U) << listed.out;
  EXPECT_THAT(listed.out, HasSubstr("N20"));
  EXPECT_THAT(listed.out, HasSubstr("N30"));

  runQuietly({"bake", "--parameters", "scene.json", "--frames", "4", "--param", "seed=9",
              "--output", "out"});
  const Json sidecar = readJson(recordingIn("out").replace_extension(".json"));
  EXPECT_EQ(sidecar.at("scene"), "brownian");
  EXPECT_EQ(sidecar.at("parameters").at("objects"), 50);
  EXPECT_EQ(sidecar.at("parameters").at("frames"), 4);
  EXPECT_EQ(sidecar.at("parameters").at("seed"), 9);
}

TEST_F(SceneParameters, ASidecarRepeatsItsRecording) {
  runQuietly({"bake", "--scenes", "swarm", "--objects", "60", "--frames", "5", "--param",
              "alignment=5", "--param", "flocks=2", "--output", "first"});
  const fs::path first = recordingIn("first");
  fs::copy_file(fs::path(first).replace_extension(".json"), file("again.json"));
  runQuietly({"bake", "--parameters", "again.json", "--output", "second"});
  const fs::path second = recordingIn("second");
  EXPECT_EQ(readFile(second), readFile(first));
  EXPECT_EQ(readFile(fs::path(second).replace_extension(".json")), readFile(file("again.json")));

  runQuietly({"--headless", "again.json", "--algorithm", "sap", "--json", "results.json"});
  EXPECT_EQ(readJson(file("results.json")).at("cases").at(0).at("recording").at("hash"),
            readJson(file("again.json")).at("hash"));
}

TEST_F(SceneParameters, OfAnEngineAreTakenFromOptionsToo) {
  const auto bake = [&](const Arguments& more, const std::string& output) {
    Arguments call = {"bake",     "--scenes", "brownian", "--objects", "40",
                      "--frames", "5",        "--output", output};
    call.insert(call.end(), more.begin(), more.end());
    runQuietly(call);
    return readJson(recordingIn(output).replace_extension(".json")).at("parameters");
  };
  EXPECT_EQ(bake({"--engine", "boids", "--param", "sight=2"}, "a").at("sight"), 2);
  EXPECT_EQ(bake({"--param", "sight=2", "--param", "engine=boids"}, "b").at("sight"), 2);
  expectRefusal({"bake", "--scenes", "brownian", "--output", "c", "--param", "sight=2"},
                {"--param", "sight"});
}

TEST_F(SceneParameters, BadFilesAreRefused) {
  writeParameters("key.json", "brownian", {{"densty", 0.1}});
  writeParameters("type.json", "brownian", {{"objects", "many"}});
  writeParameters("range.json", "brownian", {{"density", 7}});
  writeParameters("scene.json", "brownain", Json::object());
  writeFile(file("other.json"), R"({"schema": "broadmark-other/1"})");
  writeFile(file("broken.json"), "{");
  for (const Arguments& call :
       {Arguments{"--headless"}, {"bake", "--output", "out", "--parameters"}}) {
    const auto refuses = [&](const std::string& name, const std::vector<std::string>& words) {
      Arguments whole = call;
      whole.push_back(name);
      std::vector<std::string> all = words;
      all.push_back(name);
      expectRefusal(whole, all);
    };
    refuses("key.json", {"densty", "'density'"});
    refuses("type.json", {"objects", "integer"});
    refuses("range.json", {"density", "1e-06…1"});
    refuses("scene.json", {"brownain", "'brownian'"});
    refuses("other.json", {"broadmark-other/1"});
    refuses("broken.json", {"JSON"});
    refuses("missing.json", {});
  }
}

}  // namespace
}  // namespace broadmark::tests
