// Exact pair counts of real meshes, as used in continuous collision detection, and sequences whose
// mesh changes.

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

TEST_F(MeshImport, EveryAlgorithmFollowsAMeshThatChanges) {
  // Two triangles that share an edge, cut into four that share none, and joined again.
  const std::string whole = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
  const std::string cut =
      "ply\nformat ascii 1.0\nelement vertex 12\nproperty float x\nproperty float y\n"
      "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n.5 .5 0\n1 0 0\n1 1 0\n.5 .5 0\n1 1 0\n0 1 0\n.5 .5 0\n0 1 0\n0 0 0\n"
      ".5 .5 0\n3 0 1 2\n3 3 4 5\n3 6 7 8\n3 9 10 11\n";
  writeFile(file("m1.obj"), whole);
  writeFile(file("m2.ply"), cut);
  writeFile(file("m3.ply"), cut);
  writeFile(file("m4.obj"), whole);
  const auto pairs_of = [&](const Arguments& more) {
    Arguments call = {"--headless", "--algorithm", "all", "--check", "full", "--json", "r.json"};
    call.insert(call.end(), more.begin(), more.end());
    runQuietly(call);
    const Json results = readJson(file("r.json"))["cases"];
    EXPECT_GT(results.size(), 10U);
    std::vector<int> pairs;
    for (const Json& result : results) {
      EXPECT_EQ(result["status"], "ok") << result["id"];
      EXPECT_EQ(result["recording"]["objects"], 6);
      if (result["algorithm"] == "bf")
        pairs = result["frame_counts"]["pairs"].get<std::vector<int>>();
    }
    return pairs;
  };
  EXPECT_EQ(run({"import", "m1.obj", "m2.ply", "m3.ply", "m4.obj", "-o", "m"}).status, 0);
  EXPECT_THAT(pairs_of({"m.broadmark"}), ElementsAre(6, 6, 0));
  EXPECT_THAT(pairs_of({"m.broadmark", "--swept"}), ElementsAre(6, 6, 0));
  EXPECT_THAT(run({"verify", "m.broadmark"}).out, HasSubstr("6 bodies"));
}

}  // namespace
}  // namespace broadmark::tests
