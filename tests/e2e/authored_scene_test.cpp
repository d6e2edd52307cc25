// Authored scenes as sources: run, baked, baked again after a change, rejected if invalid.

#include "e2e/end_to_end.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

class AuthoredScenes : public EndToEnd {
 protected:
  AuthoredScenes() { writeScene(0); }

  /// A floor, and five bodies above it, the first at this height.
  void writeScene(double height, const std::string& parameters = R"({"frames": 6})") const {
    std::string text = R"({"schema": "broadmark-scene/1", "name": "Mine",
      "world": {"min": [-5, -5, -5], "max": [5, 5, 5]},
      "parameters": )" +
                       parameters + R"(,
      "bodies": [{"box": [10, 1, 10], "position": [0, -4, 0], "frozen": true})";
    for (int i = 0; i < 5; ++i) {
      text += R"(,
        {"sphere": 0.6, "position": [)" +
              std::to_string(i - 2) + ", " + std::to_string(i == 0 ? height : 1) +
              R"(, 0], "velocity": [0, -3, 0]})";
    }
    writeFile(file("my scene.json"), text + "]}");
  }

  ProgramResult bake(const std::string& output, Arguments more = {}) const {
    Arguments call = {"bake", "--parameters", "my scene.json", "--output", output};
    call.insert(call.end(), more.begin(), more.end());
    return runQuietly(call);
  }
};

const std::string kName = "Mine Assorted N6 F6frames";

TEST_F(AuthoredScenes, RunLikeBuiltInOnes) {
  const ProgramResult ended = runQuietly({"--headless", "my scene.json", "--algorithm", "sap,bf",
                                          "--record", "kept", "--json", "results.json"});
  EXPECT_THAT(ended.out, StartsWith("Mine Assorted, 6 bodies, 6 frames\n"));
  const Json first = readJson(file("results.json")).at("cases").at(0);
  EXPECT_EQ(first.at("status"), "ok");
  EXPECT_GT(first.at("pairs").at("max"), 3) << "they overlap their neighbours";
  const Json source = first.at("recording").at("source");
  EXPECT_EQ(source.at("scene_file"), "my scene.json");
  EXPECT_EQ(source.at("frames"), "6");
  EXPECT_EQ(first.at("recording").at("seed"), nullptr);
  const ProgramResult verified = runQuietly({"verify", recordingIn("kept", kName)});
  EXPECT_THAT(verified.out, HasSubstr("as baked"));
}

TEST_F(AuthoredScenes, ACaseOfResultsIsRunAgainWhileTheSceneIsTheSame) {
  runQuietly({"--headless", "my scene.json", "--frames", "4", "--engine", "kinematic",
              "--algorithm", "sap", "--json", "results.json"});
  const Json before = readJson(file("results.json")).at("cases").at(0);
  const Arguments again = {"--headless", "results.json", "--case", before.at("id"),
                           "--json",     "again.json",   "--quiet"};
  runQuietly(Arguments(again.begin(), again.end() - 1));
  EXPECT_EQ(readJson(file("again.json")).at("cases").at(0).at("recording"), before.at("recording"));
  writeScene(0.5);
  fs::remove(file("again.json"));
  expectRefusal(again, {before.at("recording").at("hash").get<std::string>()});
}

TEST_F(AuthoredScenes, BakeAndKeepWhatIsThereUntilForced) {
  EXPECT_THAT(bake("out", {"--recorder", "aabbs,posrot"}).out, HasSubstr("2 baked, 0 kept"));
  const std::string bytes = readFile(file(recordingIn("out", kName)));
  const Json sidecar = readJson(file("out/Recordings_AABBs/" + kName + ".json"));
  EXPECT_EQ(sidecar.at("scene"), "authored");
  EXPECT_EQ(sidecar.at("parameters").at("frames"), 6);
  EXPECT_THAT(bake("out").out, HasSubstr("0 baked, 1 kept"));
  fs::copy_file(file("my scene.json"), file("elsewhere.json"));
  EXPECT_THAT(runQuietly({"bake", "--parameters", "elsewhere.json", "--output", "out"}).out,
              HasSubstr("0 baked, 1 kept"));
  EXPECT_THAT(bake("other").out, HasSubstr("1 baked"));
  EXPECT_EQ(readFile(file(recordingIn("other", kName))), bytes) << "same file, same bytes";
  writeScene(0.25);
  EXPECT_THAT(bake("out", {"--force"}).out, HasSubstr("1 baked, 0 kept"));
  EXPECT_NE(readFile(file(recordingIn("out", kName))), bytes);
}

TEST_F(AuthoredScenes, OptionsOverrideParameters) {
  bake("out", {"--engine", "kinematic", "--frames", "9", "--param", "gravity_y=3"});
  const Json parameters =
      readJson(file("out/Recordings_AABBs/Mine Assorted N6 F9frames.json")).at("parameters");
  EXPECT_EQ(parameters.at("engine"), "kinematic");
  EXPECT_EQ(parameters.at("gravity_y"), 3);
  const ProgramResult listed = runQuietly(
      {"--headless", "my scene.json", "freefall", "--frames", "4", "--algorithm", "sap", "--list"});
  EXPECT_EQ(linesOf(listed.out).size(), 2U) << listed.out;
  EXPECT_THAT(listed.out, HasSubstr("Mine"));
  const ProgramResult batch =
      runQuietly({"bake", "--scenes", "freefall", "--parameters", "my scene.json", "--frames", "4",
                  "--engine", "boids", "--param", "sight=2", "--output", "out", "--list"});
  EXPECT_EQ(linesOf(batch.out).size(), 3U) << batch.out;
}

TEST_F(AuthoredScenes, OptionsThatSayWhichBodiesThereAreAreRefused) {
  for (const Arguments& option :
       {Arguments{"--objects", "5"}, {"--density", "0.2"}, {"--input", "x"}}) {
    expectRefusal({"--headless", "my scene.json", option[0], option[1]},
                  {"my scene.json", option[0]});
    expectRefusal({"bake", "--parameters", "my scene.json", "--output", "o", option[0], option[1]},
                  {"my scene.json", option[0]});
  }
  expectRefusal({"--headless", "my scene.json", "--engine", "viewer"}, {"viewer", "bullet"});
  expectRefusal({"--headless", "my scene.json", "--param", "densty=1"}, {"--param", "densty"});
}

TEST_F(AuthoredScenes, AreNeverWrittenOver) {
  const std::string text = readFile(file("my scene.json"));
  expectRefusal({"--headless", "my scene.json", "--algorithm", "sap", "--json", "my scene.json"},
                {"--json", "my scene.json"});
  // The path of its recording's sidecar.
  const std::string beside = "out/Recordings_AABBs/" + kName + ".json";
  fs::create_directories(file("out/Recordings_AABBs"));
  writeFile(file(beside), text);
  expectRefusal({"bake", "--parameters", beside, "--output", "out"}, {"another folder"});
  expectRefusal({"--headless", beside, "--algorithm", "sap", "--record", "out", "--quiet"},
                {"another folder"});
  EXPECT_EQ(readFile(file(beside)), text);
}

TEST_F(AuthoredScenes, TheSidecarOfOneNamesTheRightFile) {
  bake("out");
  expectRefusal({"--headless", "out/Recordings_AABBs/" + kName + ".json"},
                {"authored scene", "broadmark-scene/1"});
}

TEST_F(AuthoredScenes, BadOnesAreRefused) {
  const auto refuses = [&](const std::string& from, const std::string& to,
                           const std::vector<std::string>& words) {
    writeScene(0);
    std::string text = readFile(file("my scene.json"));
    text.replace(text.find(from), from.size(), to);
    writeFile(file("my scene.json"), text);
    std::vector<std::string> all = words;
    all.emplace_back("my scene.json");
    expectRefusal({"--headless", "my scene.json"}, all);
    expectRefusal({"bake", "--parameters", "my scene.json", "--output", "out"}, all);
  };
  refuses("sphere", "spere", {"body 1", "'sphere'"});
  refuses("[0, -3, 0]", "[0, -3]", {"body 1", "velocity"});
  refuses("\"frames\": 6", "\"frames\": 0", {"frames", "1…1000000"});
  refuses("\"frames\"", "\"objects\"", {"'objects'"});
  refuses("]}]}", "]}]", {"JSON"});
  refuses("broadmark-scene/1", "broadmark-scene/9", {"broadmark-scene/9", "broadmark-scene/1"});
}

TEST_F(AuthoredScenes, TheExampleRuns) {
  const fs::path example = places::source("assets/scenes/dominoes.json");
  const ProgramResult ended = runQuietly(
      {"--headless", example.string(), "--frames", "10", "--algorithm", "sap-simd,grid-bf"});
  EXPECT_THAT(ended.out, StartsWith("Dominoes Assorted, 41 bodies, 10 frames\n"));
}

}  // namespace
}  // namespace broadmark::tests
