// The command 'torture': its findings, its files, and how it resumes.

#include <algorithm>

#include "broadmark/recordings/recording.h"
#include "e2e/end_to_end.h"
#include "engine/helpers.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

class Torture : public EndToEnd {
 protected:
  [[nodiscard]] Arguments call(const Arguments& more, const std::string& output = "torture") const {
    Arguments all = {"torture", "--quiet", "--output", output};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  [[nodiscard]] Json log(const std::string& output = "torture") const {
    return readJson(file(output) / "torture.json");
  }

  /// Writes a recording of two boxes that overlap in two frames.
  void writeTwoBoxes() const { writeFile(file("two.aabbs"), recordingOf(2, 1, unitBoxes(4))); }
};

TEST_F(Torture, ShrinksWrongAnswersAndShowsThemByACommand) {
  const ProgramResult ended = run(call({"--plugin", places::faultyPlugin(), "--algorithm",
                                        "faulty-extra,lossy*,stale*", "--rounds", "16"}));
  EXPECT_EQ(ended.status, 1) << ended.err;
  const Json found = log().at("found");
  for (const std::string id : {"faulty-extra", "lossy-removal", "lossy-layers", "stale-filter"}) {
    SCOPED_TRACE(id);
    const auto fault =
        std::ranges::find_if(found, [&](const Json& item) { return item.at("algorithm") == id; });
    ASSERT_NE(fault, found.end());
    EXPECT_EQ(fault->at("kind"), "wrong answer");
    EXPECT_TRUE(fault->at("minimal"));
    EXPECT_LE(fault->at("bodies"), 3);
    const std::string command = fault->at("command");
    EXPECT_THAT(ended.out, HasSubstr(command));
    for (const char* text : {"body 0: (", "wrong pair: "}) {
      EXPECT_THAT(fault->at("boxes").get<std::string>(), HasSubstr(text));
    }
    EXPECT_THAT(ended.out, HasSubstr(fault->at("boxes").get<std::string>()));
    EXPECT_EQ(shell(command), 1) << readFile(file("shell.out"));
  }
  // The number of reproducers per algorithm and fault kind is limited.
  EXPECT_LE(std::ranges::count_if(
                found, [](const Json& entry) { return entry.at("algorithm") == "lossy-removal"; }),
            3);
}

TEST_F(Torture, TellsKindsOfFaultsApart) {
  writeTwoBoxes();
  for (const auto& [deed, kind] : std::map<std::string, std::string>{{"crash", "failure"},
                                                                     {"throw", "failure"},
                                                                     {"exit", "failure"},
                                                                     {"hang", "hang"},
                                                                     {"allocate", "failure"},
                                                                     {"break", "broken invariant"},
                                                                     {"keep", "leak"}}) {
    // Their malloc reports no allocated bytes, and has no limit.
    if (kSanitized && (kind == "leak" || deed == "allocate")) continue;
    SCOPED_TRACE(deed);
    const std::string name = places::unrulyPlugin() + ":unruly/frame=1/deed=" + deed;
    const ProgramResult ended =
        run(call({"two.aabbs", "--only-sources", "--case", name, "--rounds", "1", "--hard-limit",
                  deed == "hang" ? "0.5" : "60", "--memory-limit", "1"},
                 deed));
    EXPECT_EQ(ended.status, 1) << ended.out << ended.err;
    const Json found = log(deed).at("found");
    ASSERT_EQ(found.size(), 1U) << ended.out;
    EXPECT_EQ(found[0].at("kind"), kind) << found[0];
    EXPECT_EQ(found[0].at("world"), "given");
    EXPECT_EQ(found[0].at("frames"), 1);
    if (kind == "hang" || deed == "allocate") continue;  // a minute, or all of the memory
    EXPECT_EQ(shell(found[0].at("command")), 1) << readFile(file("shell.out"));
  }
}

// A process runs many rounds, until a world ends it: that world is found, and the others go on.
TEST_F(Torture, AttributesTheEndOfAProcessToItsWorld) {
  const ProgramResult ended =
      run(call({"--case", places::unrulyPlugin() + ":unruly/frame=20/deed=crash", "--rounds", "6",
                "--jobs", "1"}));
  EXPECT_EQ(ended.status, 1) << ended.out << ended.err;
  EXPECT_EQ(log().at("next"), 6);
  EXPECT_THAT(log().at("left"), IsEmpty());
  EXPECT_FALSE(log().at("coverage").empty());
  const Json found = log().at("found");
  ASSERT_FALSE(found.empty());
  for (const Json& fault : found) {
    EXPECT_EQ(fault.at("kind"), "failure");
    EXPECT_EQ(fault.at("frames"), 2) << "the default";
    EXPECT_THAT(fault.at("case").get<std::string>(), testing::EndsWith("unruly/deed=crash"));
    EXPECT_EQ(fault.at("bodies"), 0);
    EXPECT_THAT(fault.at("text").get<std::string>(), HasSubstr("SIGSEGV"));
  }
}

TEST_F(Torture, FindsAFaultOfLateFrames) {
  const ProgramResult ended = run(
      call({"--plugin", places::faultyPlugin(), "--algorithm", "late-fault", "--rounds", "300"}));
  EXPECT_EQ(ended.status, 1) << ended.out << ended.err;
  const Json found = log().at("found");
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].at("frames"), 41);
  EXPECT_EQ(found[0].at("bodies"), 2);
  EXPECT_EQ(found[0].at("case"), "late-fault") << "with pairs";
  EXPECT_EQ(shell(found[0].at("command")), 1) << readFile(file("shell.out"));
}

TEST_F(Torture, ReplaysWhatItFoundBefore) {
  const auto torture = [&](const std::string& rounds) {
    return run(call({"--algorithm", "bf", "--rounds", rounds}));
  };
  EXPECT_EQ(torture("1").status, 0);
  // A finding of an older version, since fixed.
  Json edited = log();
  writeFile(file("torture/bf-wrong-answer-1.aabbs"), recordingOf(2, 1, unitBoxes(4)));
  edited["found"] = Json::array({{{"algorithm", "bf"},
                                  {"kind", "wrong answer"},
                                  {"case", "bf"},
                                  {"world", "flat"},
                                  {"text", "1 missed, 0 false, 0 invalid"},
                                  {"round", 0},
                                  {"file", "elsewhere/bf-wrong-answer-1.aabbs"},
                                  {"bodies", 2},
                                  {"frames", 1},
                                  {"minimal", true},
                                  {"command", "broadmark"}}});
  edited["times"] = Json::array({{{"algorithm", "bf"}, {"kind", "wrong answer"}, {"times", 7}}});
  for (Json& count : edited["coverage"]) {
    count.erase("max_bodies");
    count.erase("max_frames");
  }
  writeFile(file("torture/torture.json"), edited.dump());
  const ProgramResult ended = torture("1");
  EXPECT_EQ(ended.status, 0) << ended.out;
  EXPECT_THAT(ended.out, HasSubstr("torture/bf-wrong-answer-1.aabbs: bf: no longer fails\n"));
  EXPECT_THAT(log().at("found"), IsEmpty());
  EXPECT_THAT(log().at("times"), IsEmpty());
  EXPECT_EQ(log().at("next"), 2);
}

TEST_F(Torture, FindsNothingWrongWithAnAlgorithmThatIsRight) {
  const ProgramResult ended = run(call({"--algorithm", "sap,kd", "--rounds", "6"}));
  EXPECT_EQ(ended.status, 0) << ended.out;
  EXPECT_THAT(ended.out, testing::ContainsRegex(
                             "no fault found in [0-9,]+ frames of [0-9]+ worlds, each of at most "
                             "[0-9,]+ bodies, [0-9]+ frames\n"));
  EXPECT_THAT(ended.out, HasSubstr("6 rounds"));
  EXPECT_EQ(files(), std::set<std::string>{"torture/torture.json"});
}

TEST_F(Torture, GoesOnWhereItEnded) {
  const Arguments subject = {"--algorithm", "bf,grid-sap", "--seed", "7"};
  const auto rounds = [&](const std::string& count, const std::string& output) {
    Arguments all = call(subject, output);
    all.insert(all.end(), {"--rounds", count});
    EXPECT_EQ(run(all).status, 0);
  };
  rounds("2", "twice");
  rounds("3", "twice");
  rounds("5", "once");
  EXPECT_EQ(log("twice").at("next"), 5);
  EXPECT_EQ(log("twice").at("coverage"), log("once").at("coverage"));
  expectRefusal(call({"--algorithm", "bf,grid-sap", "--seed", "8"}, "twice"),
                {"twice/torture.json", "seed (7)", "--output"});
  expectRefusal(call({"--algorithm", "bf"}, "twice"), {"other algorithms"});
}

// A rebuilt plug-in is tested from scratch, to verify its fix.
TEST_F(Torture, BeginsAnewWithAnotherBuildOfAPlugin) {
  fs::copy_file(places::faultyPlugin(), file("mine.so"));
  const Arguments faulty =
      call({"--plugin", "./mine.so", "--algorithm", "lossy-layers", "--rounds", "4"});
  EXPECT_EQ(run(faulty).status, 1);
  EXPECT_EQ(run(faulty).status, 1);
  EXPECT_EQ(log().at("next"), 8);
  const std::set<std::string> kept = files();
  writeFile(file("mine.so"), readFile(file("mine.so")) + "another build");
  const ProgramResult ended = run(faulty);
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(log().at("next"), 4);
  EXPECT_EQ(files(), kept) << "what was found before is still there, and enough";
  EXPECT_THAT(ended.out, HasSubstr("lossy-layers: still fails: 1 missed"));
  EXPECT_EQ(log().at("found").size(), 3U);
}

TEST_F(Torture, FinishesRoundsThatWereInterrupted) {
  const Arguments subject = {"--case", places::unrulyPlugin() + ":unruly/frame=1/deed=print",
                             "--jobs", "2"};
  Arguments endless = call(subject, "cut");
  endless.insert(endless.end(), {"--minutes", "100"});
  Program program(directory_, endless);
  // A round has up to forty worlds, and runs each several times.
  ASSERT_TRUE(program.waitForText("printed on purpose", 80));
  program.signal(SIGINT);
  const ProgramResult ended = program.wait();
  EXPECT_EQ(ended.status, 130);
  EXPECT_THAT(ended.err, HasSubstr("the same command resumes from cut/torture.json"));

  const std::size_t left = log("cut").at("left").size();
  Arguments more = call(subject, "cut");
  more.insert(more.end(), {"--rounds", std::to_string(left + 1)});
  EXPECT_EQ(run(more).status, 0);
  EXPECT_THAT(log("cut").at("left"), IsEmpty());
  Arguments whole = call(subject, "whole");
  whole.insert(whole.end(), {"--rounds", std::to_string(log("cut").at("next").get<int>())});
  EXPECT_EQ(run(whole).status, 0);
  EXPECT_EQ(log("cut").at("coverage"), log("whole").at("coverage"));
}

TEST_F(Torture, RefusesWhatCannotBe) {
  expectRefusal({"torture", "--algorithm", "nothing"}, {"--algorithm", "nothing"});
  expectRefusal({"torture", "--algorithm", "none"}, {"finds pairs"});
  expectRefusal({"torture", "--only-sources"}, {"--only-sources", "source"});
  expectRefusal({"torture", "missing.aabbs"}, {"missing.aabbs"});
  expectRefusal({"torture", "--case", "kd", "--algorithm", "kd"}, {"--case", "--algorithm"});
  fs::create_directory(file("torture"));
  writeFile(file("torture/torture.json"), R"({"schema": "broadmark-torture/1", "seed": -1})");
  expectRefusal({"torture"}, {"torture.json", "seed"});
}

}  // namespace
}  // namespace broadmark::tests
