// Baking and verifying recordings.

#include <fmt/format.h>

#include "broadmark/scenes/simulation.h"
#include "e2e/end_to_end.h"

namespace broadmark::tests {
namespace {

using Bake = EndToEnd;

const std::string kBaked = recordingIn("out dir", "FreeFall Cubes N40 F8frames");
const std::string kBakedPoses = posesIn("out dir", "FreeFall Cubes N40 F8frames");

Arguments bakeCall(const Arguments& more = {}) {
  Arguments call = {"bake",     "--scenes", "freefall", "--objects", "40",
                    "--frames", "8",        "--output", "out dir"};
  call.insert(call.end(), more.begin(), more.end());
  return call;
}

/// The rest of each line that begins with `word`.
std::vector<std::string> pathsAfter(const std::string& word, const std::string& output) {
  std::vector<std::string> paths;
  for (const std::string& line : linesOf(output)) {
    if (line.starts_with(word)) paths.push_back(line.substr(word.size()));
  }
  return paths;
}

TEST_F(Bake, EveryCombinationIsBakedAndSound) {
  const ProgramResult baked =
      runQuietly({"bake", "--scenes", "freefall,brownian,gravity", "--objects", "30,10,20",
                  "--object-type", "cubes", "--frames", "4", "--output", "deep/er/out"});
  const auto files = pathsAfter("baked  ", baked.out);
  std::set<std::string> expected;
  for (const std::string scene : {"FreeFall", "Brownian", "Gravity"}) {
    for (const int n : {10, 20, 30}) {
      expected.insert(recordingIn("deep/er/out", fmt::format("{} Cubes N{} F4frames", scene, n)));
    }
  }
  EXPECT_EQ(std::set(files.begin(), files.end()), expected) << baked.out;
  EXPECT_THAT(linesOf(baked.out).back(),
              StartsWith(fmt::format("9 baked, 0 kept; {} bytes", 9 * 304 + 3 * 5 * 32 * 60)));
  Arguments verify = {"verify"};
  verify.insert(verify.end(), files.begin(), files.end());
  const ProgramResult verified = run(verify);
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

TEST_F(Bake, ThreadsChangeNothing) {
  std::map<std::string, std::string> hashes;
  for (const std::string threads : {"1", "3"}) {
    runQuietly({"bake", "--objects", "150,300,50", "--frames", "25", "--output", threads,
                "--threads", threads});
    for (const auto& entry : fs::recursive_directory_iterator(file(threads))) {
      if (entry.is_directory() || entry.path().extension() == ".json") continue;
      const auto [known, first] = hashes.emplace(entry.path().filename(), readFile(entry.path()));
      EXPECT_EQ(first, threads == "1") << entry.path();
      EXPECT_TRUE(known->second == readFile(entry.path())) << entry.path();
    }
  }
  EXPECT_EQ(hashes.size(), 3 * builtinScenes().size());
}

TEST_F(Bake, ACombinationNamedTwiceIsBakedOnce) {
  const ProgramResult ended =
      runQuietly({"bake", "--scenes", "freefall,FreeFall", "--objects", "5,5", "--object-type",
                  "cubes,cubes", "--frames", "2", "--output", "out"});
  EXPECT_EQ(pathsAfter("baked  ", ended.out).size(), 1U) << ended.out;
}

TEST_F(Bake, ListTellsWhatWouldBeDone) {
  const Arguments call = bakeCall({"--list"});
  const std::string size = std::to_string(304 + 32 * 40 * 9);
  const ProgramResult before = runQuietly(call);
  EXPECT_THAT(
      linesOf(before.out),
      ElementsAre(AllOf(StartsWith("bake "), HasSubstr(" " + size + " "), HasSubstr(kBaked)),
                  "1 recording: 1 to bake (" + size + " bytes), 0 kept"));
  EXPECT_THAT(entries(), IsEmpty());
  runQuietly(bakeCall());
  const ProgramResult after = runQuietly(call);
  EXPECT_THAT(after.out, StartsWith("kept "));
  EXPECT_THAT(after.out, HasSubstr("1 recording: 0 to bake (0 bytes), 1 kept"));
  EXPECT_THAT(runQuietly(bakeCall({"--list", "--force"})).out, StartsWith("bake "));
}

TEST_F(Bake, AFailedOneDoesNotStopTheOthers) {
  // The largest recording exceeds the limit on a file's size.
  const ProgramResult ended =
      run({"bake", "--scenes", "freefall", "--objects", "5,9,200", "--frames", "10", "--output",
           "out", "--quiet", "--threads", "1"},
          {.max_file_bytes = 20'000});
  EXPECT_EQ(ended.status, 2);
  EXPECT_EQ(linesOf(ended.err).size(), 1U) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("N200 F10frames.aabbs: cannot write"));
  EXPECT_EQ(pathsAfter("baked  ", ended.out).size(), 2U) << ended.out;
  EXPECT_THAT(linesOf(ended.out).back(), StartsWith("2 baked, 0 kept, 1 failed; "));
}

TEST_F(Bake, PlainProgressEndsWithALine) {
  const ProgramResult ended = run(bakeCall());
  EXPECT_EQ(ended.status, 0);
  EXPECT_THAT(linesOf(ended.err), ElementsAre(StartsWith("baking 1 recording: done (")));
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
  EXPECT_THAT(runQuietly(bakeCall()).out,
              StartsWith("kept   " + kBaked + "\n0 baked, 1 kept; 0 b"));
  EXPECT_EQ(fs::last_write_time(file(kBaked)), long_ago);
  EXPECT_THAT(runQuietly(bakeCall({"--force"})).out,
              StartsWith("baked  " + kBaked + "\n1 baked, 0 kept; "));
  EXPECT_NE(fs::last_write_time(file(kBaked)), long_ago);
  EXPECT_EQ(readFile(file(kBaked)), bytes);
}

TEST_F(Bake, AnotherRecordingIsReplacedOnlyWhenForced) {
  runQuietly(bakeCall());
  const std::string bytes = readFile(file(kBaked));
  const ProgramResult refused = run(bakeCall({"--seed", "2"}));
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, AllOf(HasSubstr(kBaked), HasSubstr("--force")));
  EXPECT_EQ(readFile(file(kBaked)), bytes);
  runQuietly(bakeCall({"--seed", "2", "--force"}));
  EXPECT_NE(readFile(file(kBaked)), bytes);
}

TEST_F(Bake, ADamagedRecordingIsBakedAnew) {
  runQuietly(bakeCall());
  const std::string bytes = readFile(file(kBaked));
  std::string damaged = bytes;
  damaged[400] ^= 1;
  writeFile(file(kBaked), damaged);
  runQuietly(bakeCall());
  EXPECT_EQ(readFile(file(kBaked)), bytes);
}

TEST_F(Bake, ParametersOfTheSceneCount) {
  runQuietly(bakeCall());
  const std::string bytes = readFile(file(kBaked));
  runQuietly(bakeCall({"--density", "0.02", "--param", "friction=0.1", "--force"}));
  EXPECT_NE(readFile(file(kBaked)), bytes);
  const Json sidecar = readJson(file("out dir/Recordings_AABBs/FreeFall Cubes N40 F8frames.json"));
  EXPECT_EQ(sidecar.at("parameters").at("friction"), 0.1);
}

TEST_F(Bake, WhatAKilledBakeLeftIsTakenOver) {
  fs::create_directories(file(kBaked).parent_path());
  writeFile(file(kBaked + ".part"), std::string(1 << 20, 'x'));
  runQuietly(bakeCall());
  EXPECT_EQ(fs::file_size(file(kBaked)), 304U + 32 * 40 * 9);
  EXPECT_FALSE(fs::exists(file(kBaked + ".part")));
  EXPECT_EQ(run({"verify", kBaked}).status, 0);
}

TEST_F(Bake, PosesAreRecordedBesideBoxesWhenAskedFor) {
  runQuietly(bakeCall());
  EXPECT_FALSE(fs::exists(file(kBakedPoses)));
  const std::string boxes = readFile(file(kBaked));
  const ProgramResult baked = runQuietly(bakeCall({"--recorder", "aabbs,posrot"}));
  EXPECT_THAT(baked.out,
              StartsWith("kept   " + kBaked + "\nbaked  " + kBakedPoses + "\n1 baked, 1 kept; "));
  EXPECT_EQ(readFile(file(kBaked)), boxes);
  EXPECT_EQ(fs::file_size(file(kBakedPoses)), boxes.size());

  const ProgramResult verified = run({"verify", kBakedPoses});
  EXPECT_EQ(verified.status, 0) << verified.err;
  EXPECT_THAT(verified.out, HasSubstr(", as baked\n"));
  const Json sidecar = readJson(file(fs::path(kBakedPoses).replace_extension(".json")));
  EXPECT_THAT(verified.out, HasSubstr(sidecar.at("hash").get<std::string>()));

  const auto long_ago = fs::last_write_time(file(kBakedPoses)) - std::chrono::hours(1);
  fs::last_write_time(file(kBakedPoses), long_ago);
  runQuietly(bakeCall({"--recorder", "posrot"}));
  runQuietly(bakeCall({"--recorder", "posrot,aabbs"}));
  EXPECT_EQ(fs::last_write_time(file(kBakedPoses)), long_ago) << "kept";
}

TEST_F(Bake, APosrotRecordingIsASource) {
  runQuietly(bakeCall({"--recorder", "posrot,aabbs"}));
  const auto pairsOf = [&](const std::string& source) {
    runQuietly(
        {"--headless", source, "--algorithm", "bf,sap", "--time-limit", "100", "--json", "r.json"});
    Json pairs;
    const Json results = readJson(file("r.json"));
    for (const Json& result : results.at("cases")) {
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
  EXPECT_EQ(readFile(file(recordingIn("again", "FreeFall Cubes N40 F8frames"))),
            readFile(file(kBaked)));

  const Arguments split = {"bake",     "--scenes", "freefall", "--objects",  "320",
                           "--frames", "6",        "--engine", "splitter",   "--input",
                           "out dir",  "--output", "out dir",  "--recorder", "aabbs,posrot"};
  const auto files = pathsAfter("baked  ", runQuietly(split).out);
  EXPECT_THAT(files, ElementsAre(recordingIn("out dir", "FreeFall Cubes N320 F6frames"),
                                 posesIn("out dir", "FreeFall Cubes N320 F6frames")));
  Arguments verify = {"verify"};
  verify.insert(verify.end(), files.begin(), files.end());
  EXPECT_EQ(run(verify).status, 0);
  const fs::path sidecar = file(fs::path(files.front()).replace_extension(".json"));
  EXPECT_THAT(run({"verify", kBakedPoses}).out,
              HasSubstr(readJson(sidecar).at("input_hash").get<std::string>()));
  // Used as a scene, it lacks only its input.
  expectRefusal({"bake", "--parameters", sidecar.string(), "--output", "new"}, {"--input"});
  runQuietly({"bake", "--parameters", sidecar.string(), "--input", "out dir", "--output", "new"});
  EXPECT_EQ(readFile(file(recordingIn("new", "FreeFall Cubes N320 F6frames"))),
            readFile(file(files.front())));

  runQuietly({"--headless", "freefall", "--objects", "2560", "--engine", "splitter", "--input",
              "out dir", "--algorithm", "sap,bf", "--time-limit", "100", "--json", "r.json"});
  const Json results = readJson(file("r.json"));
  for (const Json& result : results.at("cases")) {
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
  expectRefusal(call("splitter", "321", input), {"321", "N40 F8"});
  expectRefusal(call("viewer", "41", input), {"FreeFall Cubes N41", "N40 F8"});
  expectRefusal(call("viewer", "40", {"--input", "out dir", "--quiet", "--recorder", "posrot"}),
                {"N40 F8", "another folder"});
  expectRefusal(call("viewer", "40", {}), {"--input"});
  expectRefusal(call("viewer", "40", {"--input", "nowhere"}), {"nowhere"});
  expectRefusal(call("spliter", "40", input), {"'splitter'"});
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
  const ProgramResult ended = run({"verify", "bad.aabbs", "good.aabbs", "missing.aabbs"});
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.out, HasSubstr("good.aabbs: ok"));
  const auto complaints = linesOf(ended.err);
  ASSERT_EQ(complaints.size(), 2U) << ended.err;
  EXPECT_THAT(complaints[0], HasSubstr("bad.aabbs"));
  EXPECT_THAT(complaints[1], HasSubstr("missing.aabbs"));
}

TEST_F(Bake, TellsWhichBodiesLeftTheirWorldAndWhen) {
  // Steps of half a second are too long for walls.
  const ProgramResult baked =
      run({"bake", "--scenes", "brownian", "--objects", "40", "--frames", "20", "--output", "out",
           "--param", "initial_speed=10", "--param", "substeps=1", "--param", "time_step=0.5"});
  EXPECT_EQ(baked.status, 0);
  EXPECT_THAT(baked.err,
              testing::ContainsRegex("Brownian Cubes N40 F20frames.aabbs: body [0-9]+ left its "
                                     "world for good in frame [0-9]+\n"));
  EXPECT_THAT(run({"bake", "--scenes", "brownian", "--objects", "40", "--frames", "20", "--output",
                   "in", "--engine", "kinematic", "--param", "initial_speed=10"})
                  .err,
              Not(HasSubstr("left its world")));
}

}  // namespace
}  // namespace broadmark::tests
