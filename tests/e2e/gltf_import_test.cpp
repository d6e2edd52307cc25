// glTF files from the command line to the results.

#include "e2e/end_to_end.h"

namespace broadmark::tests {
namespace {

using GltfImport = EndToEnd;

/// The triangle 0 0 0, 1 0 0, 0 1 0 (36 bytes), its indices (6, 2 unused), the times 0 and 1, and
/// the positions 0 0 0 and 10 0 0.
constexpr const char* kBytes =
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAIEEAAA"
    "AA"
    "AAAAAA==";

/// Two nodes of one name; the animation 'walk' moves the first one towards the other, by steps.
Json twoTriangles() {
  Json file = Json::parse(R"({
    "asset": {"version": "2.0"},
    "buffers": [{"byteLength": 76}],
    "bufferViews": [{"buffer": 0, "byteLength": 36},
                    {"buffer": 0, "byteOffset": 36, "byteLength": 6},
                    {"buffer": 0, "byteOffset": 44, "byteLength": 8},
                    {"buffer": 0, "byteOffset": 52, "byteLength": 24}],
    "accessors": [
      {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
      {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
      {"bufferView": 2, "componentType": 5126, "count": 2, "type": "SCALAR"},
      {"bufferView": 3, "componentType": 5126, "count": 2, "type": "VEC3"}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "nodes": [{"name": "Cube", "mesh": 0}, {"name": "Cube", "mesh": 0, "translation": [10, 0, 0]}],
    "animations": [{"name": "walk",
      "samplers": [{"input": 2, "output": 3, "interpolation": "STEP"}],
      "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}]})");
  file["buffers"][0]["uri"] = std::string("data:application/octet-stream;base64,") + kBytes;
  return file;
}

TEST_F(GltfImport, RunsOnAnAnimation) {
  writeFile(file("a.gltf"), twoTriangles().dump());
  const Arguments call = {"--headless", "a.gltf", "--frame-rate", "4",      "--algorithm", "sap,kd",
                          "--check",    "full",   "--json",       "r.json", "--animation", "walk"};
  runQuietly(call);
  const Json results = readJson(file("r.json"))["cases"];
  ASSERT_EQ(results.size(), 2U);
  for (const Json& result : results) {
    EXPECT_EQ(result["status"], "ok");
    EXPECT_EQ(result["frame_counts"]["pairs"], Json::parse("[0, 0, 0, 1]"));
    EXPECT_EQ(result["recording"]["reading"],
              Json::parse(R"({"animation": "walk", "frame_rate": "4"})"));
  }
  runQuietly({"--headless", "r.json", "--case", results[0]["id"], "--json", "again.json"});
  EXPECT_EQ(readJson(file("again.json"))["cases"][0]["recording"], results[0]["recording"]);
}

TEST_F(GltfImport, BuffersLieBesideTheFile) {
  // Any 76 bytes are a buffer; those of text are ordinary floats.
  Json whole = twoTriangles();
  whole["buffers"][0]["uri"] = "my%20buf.bin";
  whole.erase("animations");
  whole["meshes"][0]["primitives"][0].erase("indices");
  fs::create_directory(file("sub"));
  writeFile(file("sub/my buf.bin"), std::string(76, 'A'));
  writeFile(file("sub/a.gltf"), whole.dump());
  EXPECT_EQ(run({"import", "sub/a.gltf", "-o", "a.broadmark"}).status, 0);
  EXPECT_THAT(run({"verify", "a.broadmark"}).out, HasSubstr("2 bodies"));
  writeFile(file("sub/my buf.bin"), std::string(75, 'A'));
  expectRefusal({"import", "sub/a.gltf", "-o", "b.broadmark"},
                {"sub/a.gltf: buffers[0]: 76 bytes are stated, but there are 75"});
}

TEST_F(GltfImport, WhatIsNotReadIsRefused) {
  const auto refused = [&](const Json& whole, const std::vector<std::string>& words,
                           const Arguments& more = {}) {
    writeFile(file("a.gltf"), whole.dump());
    Arguments call = {"--headless", "a.gltf", "--algorithm", "sap", "--quiet"};
    call.insert(call.end(), more.begin(), more.end());
    expectRefusal(call, words);
  };
  Json meshopt = twoTriangles();
  meshopt["extensionsUsed"] = {"EXT_meshopt_compression"};
  meshopt["extensionsRequired"] = {"EXT_meshopt_compression"};
  refused(meshopt, {"a.gltf: requires the extension EXT_meshopt_compression, which is not supp"});
  Json runs = twoTriangles();
  runs["animations"].push_back(runs["animations"][0]);
  runs["animations"][1]["name"] = "run";
  refused(runs, {"a.gltf: animations 'walk' and 'run'", "nodes[0].translation", "--animation"});
  refused(runs, {"a.gltf: no --animation 'fly': the file has 'walk', 'run'"},
          {"--animation", "fly"});
  Json cyclic = twoTriangles();
  cyclic["nodes"][0]["children"] = {1};
  cyclic["nodes"][1]["children"] = {0};
  refused(cyclic, {"a.gltf: nodes[", "is its own descendant"});
  writeFile(file("a.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expectRefusal({"--headless", "a.obj", "--algorithm", "sap", "--animation", "walk"},
                {"a.obj: --animation", "glTF"});
}

}  // namespace
}  // namespace broadmark::tests
