// Scenes with appearing and vanishing bodies, layers or worlds: simulated for a run, baked, rerun.

#include <algorithm>

#include "broadmark/algorithms.h"
#include "broadmark/compute_devices.h"
#include "e2e/end_to_end.h"

namespace broadmark::tests {
namespace {

class ChangingScenes : public EndToEnd {
 protected:
  /// Expects that every algorithm finds all pairs of this source.
  void expectAllRight(const std::string& source, Arguments more = {}) const {
    SCOPED_TRACE(source);
    Arguments call = {"--headless", source,    "--algorithm",   "all", "--json",
                      "r.json",     "--quiet", "--repetitions", "1"};
    call.insert(call.end(), more.begin(), more.end());
    const ProgramResult ended = run(call);
    const bool lacks_a_device =
        computeDevices().empty() &&
        std::ranges::any_of(builtinAlgorithms(),
                            [](const Algorithm& known) { return known.traits.on_device; });
    EXPECT_EQ(ended.status, lacks_a_device ? 1 : 0) << ended.out << ended.err;
    const Json results = readJson(file("r.json"));
    EXPECT_GT(results.at("cases").size(), 20U);
    for (const Json& result : results.at("cases")) {
      const bool no_device = result.at("family") == "GPU" && computeDevices().empty();
      EXPECT_EQ(result.at("status"), no_device ? "unsupported" : "ok")
          << result.at("id") << result.at("reason");
    }
  }

  const Arguments small_ = {"--objects", "120", "--frames", "12"};
};

TEST_F(ChangingScenes, EveryAlgorithmFindsAllPairsWhileTheyAreSimulated) {
  for (const std::string scene : {"fountain", "shooter", "world", "worlds", "spot", "streaming"}) {
    expectAllRight(scene, small_);
  }
}

TEST_F(ChangingScenes, AreBakedIntoRecordingsThatHoldThem) {
  runQuietly({"bake", "--scenes", "fountain,shooter,worlds,spot,streaming", "--objects", "120",
              "--frames", "12", "--output", "out"});
  std::set<std::string> kinds;
  for (const std::string& name : files()) {
    const fs::path path = name;
    if (path.extension() == ".json") continue;
    kinds.insert(path.filename().string().substr(0, 3) + path.extension().string());
    EXPECT_THAT(runQuietly({"verify", name}).out, HasSubstr("as baked")) << name;
  }
  EXPECT_THAT(kinds, ElementsAre("Fou.broadmark", "Sho.broadmark", "Spo.aabbs", "Str.broadmark",
                                 "Wor.broadmark"));
  const ProgramResult again =
      runQuietly({"bake", "--scenes", "fountain,shooter,worlds,spot,streaming", "--objects", "120",
                  "--frames", "12", "--output", "out"});
  EXPECT_THAT(again.out, HasSubstr("0 baked, 5 kept"));
}

TEST_F(ChangingScenes, RecordingsThatCannotHoldThemAreRefused) {
  for (const std::string recorder : {"aabbs", "posrot"}) {
    expectRefusal({"bake", "--scenes", "fountain", "--objects", "20", "--frames", "3", "--output",
                   "out", "--recorder", recorder},
                  {"." + recorder, "absent", ".broadmark"});
  }
  expectRefusal({"bake", "--scenes", "fountain", "--engine", "splitter", "--input", ".",
                 "--objects", "80", "--frames", "3", "--output", "out"},
                {"splitter", "fountain", "absent"});
}

TEST_F(ChangingScenes, AuthoredOnesToo) {
  writeFile(file("scene.json"),
            R"({"schema": "broadmark-scene/1", "name": "Doors",
      "world": {"min": [-5, -5, -5], "max": [5, 5, 5]}, "parameters": {"frames": 12},
      "collide": [[0, 1], [1, 1], [1, 2]], "triggers": [2],
      "bodies": [{"box": [10, 1, 10], "position": [0, -4, 0], "frozen": true},
        {"box": [2, 1, 2], "position": [0, -4, 0], "frozen": true},
        {"sphere": 0.6, "position": [0, -3, 0], "layer": 1},
        {"sphere": 0.6, "position": [0.5, -2, 0], "layer": 1, "appears": 3, "vanishes": 9},
        {"box": [4, 4, 4], "position": [0, -3, 0], "layer": 2, "frozen": true}]})");
  expectAllRight("scene.json", {"--record", "kept"});
  const Json recording = readJson(file("r.json")).at("cases").at(0).at("recording");
  EXPECT_EQ(recording.at("objects"), 5);
  EXPECT_GT(readJson(file("r.json")).at("cases").at(0).at("pairs").at("max"), 3);
}

}  // namespace
}  // namespace broadmark::tests
