// Exact pair counts of real meshes, as used in continuous collision detection.

#include "e2e/end_to_end.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

using MeshImport = EndToEnd;

TEST_F(MeshImport, PairsOfSweptEdgesAreThoseKnown) {
  // An excerpt of rod-twist: 1,048 of 7,847 pairs share a vertex, as counted with NumPy.
  const std::string frames = (places::source("tests/data") / "rod-twist-*.ply").string();
  const Arguments call = {"--headless",  frames, "--swept", "--elements", "edges",
                          "--algorithm", "all",  "--check", "full",       "--json"};
  const auto run_into = [&](const std::string& json, const Arguments& more = {}) {
    Arguments whole = call;
    whole.push_back(json);
    whole.insert(whole.end(), more.begin(), more.end());
    runQuietly(whole);
    return readJson(file(json))["cases"];
  };
  for (const Json& result : run_into("wanted.json")) {
    EXPECT_EQ(result["status"], "ok") << result["id"];
    if (result["algorithm"] != "bf") continue;  // other algorithms may report extra pairs
    EXPECT_EQ(result["frame_counts"]["pairs"][0], 7847 - 1048);
  }
  for (const Json& result : run_into("all.json", {"--keep", "shared-vertices"})) {
    EXPECT_EQ(result["status"], "ok") << result["id"];
    if (result["algorithm"] != "bf") continue;
    EXPECT_EQ(result["frame_counts"]["pairs"][0], 7847);
  }
}

TEST_F(MeshImport, SweptRecordingOfAMeshIsTheSame) {
  const std::string frames = (places::source("tests/data") / "rod-twist-*.ply").string();
  EXPECT_EQ(run({"import", frames, "--swept", "--elements", "all", "-o", "rod"}).status, 0);
  runQuietly({"--headless", "rod.broadmark", "--algorithm", "bf", "--json", "r.json"});
  const Json result = readJson(file("r.json"))["cases"][0];
  EXPECT_EQ(result["recording"]["name"], "rod-twist swept");
  EXPECT_EQ(result["recording"]["objects"], 669);
  EXPECT_EQ(result["frame_counts"]["pairs"][0], 29083 - 4168);
}

}  // namespace
}  // namespace broadmark::tests
