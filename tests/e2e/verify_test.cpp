// The command 'verify': checks and descriptions of recordings.

#include <sstream>

#include "broadmark/recordings/recording.h"
#include "e2e/end_to_end.h"
#include "support/changing_worlds.h"

namespace broadmark::tests {
namespace {

using Verify = EndToEnd;

TEST_F(Verify, ComparesWithWhatTheSidecarStates) {
  runQuietly(
      {"bake", "--scenes", "freefall", "--objects", "20", "--frames", "3", "--output", "out"});
  const std::string path = recordingIn("out", "FreeFall Cubes N20 F3frames");
  const fs::path sidecar = file(fs::path(path).replace_extension(".json"));
  const ProgramResult good = run({"verify", path});
  EXPECT_EQ(good.status, 0);
  EXPECT_THAT(good.out, HasSubstr(", as baked\n"));

  // One bit of a coordinate: still a valid recording, but not the baked one.
  std::string bytes = readFile(file(path));
  bytes[304 + 32 * 20] ^= 1;
  writeFile(file(path), bytes);
  const ProgramResult changed = run({"verify", path});
  EXPECT_EQ(changed.status, 2);
  EXPECT_EQ(changed.out, "");
  EXPECT_EQ(linesOf(changed.err).size(), 1U) << changed.err;
  EXPECT_THAT(changed.err, HasSubstr("changed"));

  writeFile(sidecar, R"({"schema": "broadmark-bake/1"})");
  EXPECT_THAT(run({"verify", path}).err, HasSubstr("hash"));
  // A file of another format beside it is no sidecar.
  writeFile(sidecar, R"({"schema": "broadmark-results/1"})");
  const ProgramResult alone = run({"verify", path});
  EXPECT_EQ(alone.status, 0);
  EXPECT_THAT(alone.out, Not(HasSubstr("as baked")));
}

/// A world of 10 × 10 × 10 with a unit cube at rest at 0 and a box of 2 × 2 × 2 that touches it in
/// frames 0 and 1 and is outside of the world in frames 2 to 4.
std::string leavingBox() {
  const Aabb near = {{1, 0, 0, 0}, {3, 2, 2, 0}};
  const Aabb far = {{9, 0, 0, 0}, {11, 2, 2, 0}};
  return recordingOf(2, 4,
                     {kUnitBox, near, kUnitBox, near, kUnitBox, far, kUnitBox, far, kUnitBox, far},
                     {{-5, -5, -5, 0}, {5, 5, 5, 0}});
}

TEST_F(Verify, DescribesAKnownScene) {
  writeFile(file("known.aabbs"), leavingBox());
  const ProgramResult ended =
      runQuietly({"verify", "--describe", "known.aabbs", "--json", "known.json"});
  const auto lines = linesOf(ended.out);
  ASSERT_GE(lines.size(), 8U) << ended.out;
  const auto words = [&](std::size_t line) {
    std::istringstream stream(lines[line]);
    return std::vector<std::string>{std::istream_iterator<std::string>(stream), {}};
  };
  EXPECT_THAT(lines[0], StartsWith("known.aabbs: ok: Handmade Cubes, 2 bodies, 4 frames"));
  EXPECT_THAT(words(1), ElementsAre("frames", "density", "pairs/body", "moving", "smallest",
                                    "median", "largest", "ratio", "outside"));
  EXPECT_THAT(words(2), ElementsAre("initial", "0.009", "0.5", "–", "1", "1.5", "2", "2", "0"));
  EXPECT_THAT(words(3), ElementsAre("1", "0.009", "0.5", "0.0", "%", "1", "1.5", "2", "2", "0"));
  EXPECT_THAT(words(4), ElementsAre("2", "0.009", "0", "50.0", "%", "1", "1.5", "2", "2", "1"));
  EXPECT_THAT(words(7),
              ElementsAre("all", "0.009", "0.125", "12.5", "%", "1", "1.5", "2", "2", "1"));

  const Json json = readJson(file("known.json"));
  EXPECT_EQ(json.at("schema"), "broadmark-descriptions/1");
  const Json& known = json.at("recordings").at(0);
  EXPECT_EQ(known.at("source"), "known.aabbs");
  EXPECT_EQ(known.at("parts").size(), 4U);
  EXPECT_EQ(known.at("overall").at("pairs_per_body"), 0.125);
  EXPECT_EQ(known.at("overall").at("moving_share"), 0.125);
}

TEST_F(Verify, DescribesAWorldThatChanges) {
  const Aabb near = {{1, 0, 0, 0}, {3, 2, 2, 0}};
  SceneInfo scene{"Handmade", "Cubes", 0, 0, {{-5, -5, -5, 0}, {5, 5, 5, 0}}, false};
  const std::vector<BodyGroups> bodies = {{.layer = 2}, {.layer = 5}, {.layer = 5, .world = 1}};
  scene.filter = CollisionFilter(bodies, LayerMatrix().set(2, 5));
  FrameList frames = listed(
      scene,
      {{kUnitBox, near, near}, {kUnitBox, near, kEmptyBox}, {kUnitBox, kEmptyBox, kEmptyBox}});
  RecordingWriter writer(file("known.broadmark"), frames.scene());
  recordAll(frames, writer);
  writer.finish();
  const ProgramResult ended =
      runQuietly({"verify", "--describe", "known.broadmark", "--json", "known.json"});
  const auto lines = linesOf(ended.out);
  ASSERT_GE(lines.size(), 17U) << ended.out;
  const auto words = [&](std::size_t line) {
    std::istringstream stream(lines[line]);
    return std::vector<std::string>{std::istream_iterator<std::string>(stream), {}};
  };
  EXPECT_THAT(lines[1], testing::EndsWith("ratio  outside"));
  EXPECT_THAT(words(7),
              ElementsAre("frames", "min", "bodies", "mean", "max", "appear", "vanish", "change"));
  EXPECT_THAT(words(8), ElementsAre("initial", "3", "3", "3", "–", "–", "–"));
  EXPECT_THAT(words(11), ElementsAre("all", "1", "1.5", "2", "0", "1", "1"));
  EXPECT_THAT(words(13), ElementsAre("layer", "bodies", "with", "2", "with", "5"));
  EXPECT_THAT(words(14), ElementsAre("2", "1", "–", "0.5"));
  EXPECT_THAT(words(15), ElementsAre("5", "0.5", "0.5", "–"));
  EXPECT_THAT(lines[16], HasSubstr("2 worlds, of at most 2 bodies"));
  const Json known = readJson(file("known.json")).at("recordings").at(0);
  EXPECT_EQ(known.at("overall").at("bodies").at("mean"), 1.5);
  EXPECT_EQ(known.at("filter").at("layer_pairs").size(), 1U);
}

TEST_F(Verify, DescribesFiltersThatChange) {
  SceneInfo scene{"Handmade", "Cubes", 0, 0, {{-5, -5, -5, 0}, {5, 5, 5, 0}}, true};
  const std::vector<std::vector<Aabb>> boxes(3, {kUnitBox, kUnitBox});
  const CollisionFilter first(std::vector<BodyGroups>(2), LayerMatrix().set(0, 0).set(0, 7), true);
  const std::vector<std::uint32_t> second_body = {1};
  const auto apart = first.with(second_body, std::vector{BodyGroups{.layer = 9}}, 2);
  const auto again = first.with(second_body, std::vector{BodyGroups{.layer = 7}}, 2);
  FrameList frames = listed(scene, boxes, {first, apart, again});
  RecordingWriter writer(file("known.broadmark"), frames.scene());
  recordAll(frames, writer);
  writer.finish();
  const ProgramResult ended =
      runQuietly({"verify", "--describe", "known.broadmark", "--json", "known.json"});
  EXPECT_THAT(ended.out, HasSubstr("bodies with a new layer or new tags: 1 a frame"));
  const Json filter = readJson(file("known.json")).at("recordings").at(0).at("filter");
  EXPECT_EQ(filter.at("changed"), 1.0);
  EXPECT_EQ(filter.at("layers").size(), 3U) << "0, 7 and 9";
  EXPECT_EQ(filter.at("layer_pairs"), Json::parse(R"([{"layers": [0, 0], "pairs": 0.0},
                                                      {"layers": [0, 7], "pairs": 0.5}])"));
  // All of it survives a conversion, and .aabbs is refused.
  runQuietly({"convert", "known.broadmark", "again.broadmark"});
  const auto converted = openRecordingFile(file("again.broadmark"));
  EXPECT_EQ(*converted->at(2).filter, again);
  EXPECT_EQ(*converted->at(1).filter, apart);
  EXPECT_EQ(converted->scene().filter, first);
  const ProgramResult refused = run({"convert", "known.broadmark", "known.aabbs"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("known.aabbs"));
  // Every answer is checked with the filter of its frame, also of swept boxes.
  runQuietly({"--headless", "known.broadmark", "--algorithm",
              "bf,sap,kd,tide,dbvt-f,axis-sweep,tracy", "--answer", "events", "--json", "r.json"});
  runQuietly(
      {"--headless", "known.broadmark", "--swept", "--algorithm", "bf,kd", "--json", "s.json"});
  for (const std::string name : {"r.json", "s.json"}) {
    const Json results = readJson(file(name));
    for (const Json& result : results.at("cases")) EXPECT_EQ(result.at("status"), "ok");
  }
}

TEST_F(Verify, DescribesWhatItCan) {
  writeFile(file("known.aabbs"), leavingBox());
  writeFile(file("empty.aabbs"), recordingOf(0, 3, {}));
  writeFile(file("short.aabbs"), leavingBox().substr(0, 400));
  const ProgramResult ended = run({"verify", "--describe", "--quiet", "short.aabbs", "empty.aabbs",
                                   "known.aabbs", "--json", "all.json"});
  EXPECT_EQ(ended.status, 2);
  EXPECT_EQ(linesOf(ended.err).size(), 1U) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("short.aabbs"));
  EXPECT_EQ(readJson(file("all.json")).at("recordings").size(), 2U);
}

TEST_F(Verify, BadOptions) {
  writeFile(file("known.aabbs"), leavingBox());
  expectRefusal({"verify", "known.aabbs", "--json", "no.json"}, {"--json", "--describe"});
  expectRefusal({"verify", "known.aabbs", "--describe", "--json", "missing/no.json"},
                {"missing/no.json", "No such file"});
  expectRefusal({"verify", "--descrbe", "known.aabbs"}, {"'--describe'"});
}

TEST_F(Verify, ItsJsonMayGoToStandardOutputAndNothingElseThen) {
  bakeRecording("a.aabbs");
  const ProgramResult ended = runQuietly({"verify", "--describe", "--json", "-", "a.aabbs"});
  EXPECT_FALSE(Json::parse(ended.out, nullptr, false).is_discarded()) << ended.out;
}

}  // namespace
}  // namespace broadmark::tests
