// Baking, verifying and the recordings' promises.

#include "tests/e2e/end_to_end.h"

namespace broadmark::testing {
namespace {

using Bake = EndToEnd;

constexpr const char* kBaked = "out dir/FreeFall Cubes N40 F8frames.aabbs";
constexpr const char* kBakedPoses = "out dir/FreeFall Cubes N40 F8frames.posrot";

Arguments bakeCall(const Arguments& more = {}) {
  Arguments call = {"bake",     "--scenes", "freefall", "--objects", "40",
                    "--frames", "8",        "--output", "out dir"};
  call.insert(call.end(), more.begin(), more.end());
  return call;
}

TEST_F(Bake, EveryCombinationIsBakedAndSound) {
  const Ended baked =
      runQuietly({"bake", "--scenes", "freefall,brownian,gravity", "--objects", "30,10,20",
                  "--object-type", "cubes", "--frames", "4", "--output", "deep/er/out"});
  const auto files = linesOf(baked.out);
  ASSERT_EQ(files.size(), 9U) << baked.out;
  EXPECT_EQ(files.front(), "deep/er/out/FreeFall Cubes N10 F4frames.aabbs");
  Arguments verify = {"verify"};
  verify.insert(verify.end(), files.begin(), files.end());
  const Ended verified = run(verify);
  EXPECT_EQ(verified.status, 0) << verified.err;
  EXPECT_EQ(verified.err, "");
  EXPECT_EQ(linesOf(verified.out).size(), 9U);
  for (const std::string& line : linesOf(verified.out)) EXPECT_THAT(line, HasSubstr(": ok: "));
  for (const std::string& name : files) {
    const Json sidecar = readJson(file(fs::path(name).replace_extension(".json")));
    EXPECT_EQ(sidecar.at("schema"), "broadmark-bake/1");
    EXPECT_EQ(sidecar.at("parameters").at("frames"), 4);
    EXPECT_THAT(verified.out, HasSubstr(sidecar.at("hash").get<std::string>()));
  }
}

TEST_F(Bake, TheSeedDecidesTheRecording) {
  bakeRecording("first.aabbs", "40", "8", "7");
  bakeRecording("second.aabbs", "40", "8", "7");
  bakeRecording("other.aabbs", "40", "8", "8");
  EXPECT_EQ(readFile(file("first.aabbs")), readFile(file("second.aabbs")));
  EXPECT_NE(readFile(file("first.aabbs")), readFile(file("other.aabbs")));
}

TEST_F(Bake, WhatIsThereIsKeptUnlessForced) {
  runQuietly(bakeCall());
  const std::string bytes = readFile(file(kBaked));
  const auto long_ago = fs::last_write_time(file(kBaked)) - std::chrono::hours(1);
  fs::last_write_time(file(kBaked), long_ago);
  runQuietly(bakeCall());
  EXPECT_EQ(fs::last_write_time(file(kBaked)), long_ago);
  runQuietly(bakeCall({"--force"}));
  EXPECT_NE(fs::last_write_time(file(kBaked)), long_ago);
  EXPECT_EQ(readFile(file(kBaked)), bytes);
}

TEST_F(Bake, WhatIsOtherOrDamagedIsBakedAnew) {
  runQuietly(bakeCall());
  const std::string bytes = readFile(file(kBaked));
  runQuietly(bakeCall({"--seed", "2"}));
  EXPECT_NE(readFile(file(kBaked)), bytes);
  runQuietly(bakeCall());
  EXPECT_EQ(readFile(file(kBaked)), bytes);

  std::string damaged = bytes;
  damaged[400] ^= 1;
  writeFile(file(kBaked), damaged);
  runQuietly(bakeCall());
  EXPECT_EQ(readFile(file(kBaked)), bytes);
}

TEST_F(Bake, ParametersOfTheSceneCount) {
  runQuietly(bakeCall());
  const std::string bytes = readFile(file(kBaked));
  runQuietly(bakeCall({"--density", "0.02", "--param", "friction=0.1"}));
  EXPECT_NE(readFile(file(kBaked)), bytes);
  const Json sidecar = readJson(file("out dir/FreeFall Cubes N40 F8frames.json"));
  EXPECT_EQ(sidecar.at("parameters").at("friction"), 0.1);
}

TEST_F(Bake, WhatAKilledBakeLeftIsTakenOver) {
  fs::create_directory(file("out dir"));
  writeFile(file(std::string(kBaked) + ".part"), std::string(1 << 20, 'x'));
  runQuietly(bakeCall());
  EXPECT_EQ(fs::file_size(file(kBaked)), 304U + 32 * 40 * 9);
  EXPECT_FALSE(fs::exists(file(std::string(kBaked) + ".part")));
  EXPECT_EQ(run({"verify", kBaked}).status, 0);
}

TEST_F(Bake, PosesAreRecordedBesideBoxesWhenAskedFor) {
  runQuietly(bakeCall());
  EXPECT_FALSE(fs::exists(file(kBakedPoses)));
  const std::string boxes = readFile(file(kBaked));
  const Ended baked = runQuietly(bakeCall({"--recorder", "aabbs,posrot"}));
  EXPECT_THAT(linesOf(baked.out), ElementsAre(kBaked, kBakedPoses));
  EXPECT_EQ(readFile(file(kBaked)), boxes);
  EXPECT_EQ(fs::file_size(file(kBakedPoses)), boxes.size());

  const Ended verified = run({"verify", kBakedPoses});
  EXPECT_EQ(verified.status, 0) << verified.err;
  const Json sidecar = readJson(file("out dir/FreeFall Cubes N40 F8frames.json"));
  EXPECT_THAT(verified.out, HasSubstr(sidecar.at("posrot_hash").get<std::string>()));
  EXPECT_THAT(run({"verify", kBaked}).out, HasSubstr(sidecar.at("hash").get<std::string>()));

  const auto long_ago = fs::last_write_time(file(kBakedPoses)) - std::chrono::hours(1);
  fs::last_write_time(file(kBakedPoses), long_ago);
  runQuietly(bakeCall({"--recorder", "posrot"}));
  runQuietly(bakeCall({"--recorder", "posrot,aabbs"}));
  EXPECT_EQ(fs::last_write_time(file(kBakedPoses)), long_ago) << "kept";
}

TEST_F(Bake, APosrotRecordingIsASource) {
  runQuietly(bakeCall({"--recorder", "posrot,aabbs"}));
  const auto pairsOf = [&](const char* source) {
    runQuietly(
        {"--headless", source, "--algorithm", "bf,sap", "--time-limit", "100", "--json", "r.json"});
    Json pairs;
    for (const Json& result : readJson(file("r.json")).at("cases")) {
      EXPECT_EQ(result.at("status"), "ok");
      pairs.push_back(result.at("pairs"));
    }
    return pairs;
  };
  EXPECT_EQ(pairsOf(kBakedPoses), pairsOf(kBaked));
}

TEST_F(Bake, ReplaysMakeRecordingsOfRecordings) {
  runQuietly(bakeCall({"--recorder", "aabbs,posrot"}));
  runQuietly({"bake", "--scenes", "freefall", "--objects", "40", "--engine", "viewer", "--input",
              "out dir", "--output", "again"});
  EXPECT_EQ(readFile(file("again/FreeFall Cubes N40 F8frames.aabbs")), readFile(file(kBaked)));

  const Arguments split = {"bake",     "--scenes", "freefall", "--objects",  "320",
                           "--frames", "6",        "--engine", "splitter",   "--input",
                           "out dir",  "--output", "out dir",  "--recorder", "aabbs,posrot"};
  const auto files = linesOf(runQuietly(split).out);
  EXPECT_THAT(files, ElementsAre("out dir/FreeFall Cubes N320 F6frames.aabbs",
                                 "out dir/FreeFall Cubes N320 F6frames.posrot"));
  Arguments verify = {"verify"};
  verify.insert(verify.end(), files.begin(), files.end());
  EXPECT_EQ(run(verify).status, 0);
  const Json sidecar = readJson(file("out dir/FreeFall Cubes N320 F6frames.json"));
  EXPECT_THAT(run({"verify", kBakedPoses}).out,
              HasSubstr(sidecar.at("parameters").at("input").get<std::string>()));

  runQuietly({"--headless", "freefall", "--objects", "2560", "--engine", "splitter", "--input",
              "out dir", "--algorithm", "sap,bf", "--time-limit", "100", "--json", "r.json"});
  for (const Json& result : readJson(file("r.json")).at("cases")) {
    EXPECT_EQ(result.at("status"), "ok");
    EXPECT_EQ(result.at("recording").at("objects"), 2560);
    EXPECT_EQ(result.at("recording").at("frames"), 6);
  }
}

TEST_F(Bake, ReplaysSayWhatTheyMiss) {
  runQuietly(bakeCall({"--recorder", "posrot"}));
  const auto call = [](const char* engine, const char* objects, const Arguments& more) {
    Arguments arguments = {"bake",      "--scenes", "freefall", "--engine", engine,
                           "--objects", objects,    "--output", "out dir"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  const Arguments input = {"--input", "out dir", "--quiet"};
  expectRefusal(call("splitter", "321", input), {"321", "multiple of 8", "N40 F8", "320 bodies"});
  expectRefusal(call("viewer", "41", input), {"FreeFall Cubes N41", "N40 F8"});
  expectRefusal(call("viewer", "40", input), {"N40 F8", "another directory"});
  expectRefusal(call("viewer", "40", {}), {"--input"});
  expectRefusal(call("viewer", "40", {"--input", "nowhere"}), {"nowhere"});
  expectRefusal(call("spliter", "40", input), {"did you mean 'splitter'"});
  expectRefusal(call("bullet", "40", input), {"'input'"});
}

TEST_F(Bake, HeadlessKeepsTheRecordingsAskedFor) {
  runQuietly({"--headless", "freefall", "--objects", "40", "--frames", "8", "--algorithm", "sap",
              "--record", "out dir", "--recorder", "posrot,aabbs"});
  EXPECT_TRUE(fs::exists(file(kBaked)));
  EXPECT_EQ(run({"verify", kBakedPoses}).status, 0);
}

TEST_F(Bake, VerifyNamesEveryBrokenFileAndPassesTheRest) {
  bakeRecording("good.aabbs");
  writeFile(file("bad.aabbs"), readFile(file("good.aabbs")).substr(0, 1000));
  const Ended ended = run({"verify", "bad.aabbs", "good.aabbs", "missing.aabbs"});
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.out, HasSubstr("good.aabbs: ok"));
  const auto complaints = linesOf(ended.err);
  ASSERT_EQ(complaints.size(), 2U) << ended.err;
  EXPECT_THAT(complaints[0], HasSubstr("bad.aabbs"));
  EXPECT_THAT(complaints[1], HasSubstr("missing.aabbs"));
}

}  // namespace
}  // namespace broadmark::testing
