// A failed case: found by a run, reopened from its results, shrunk to a minimal recording, and
// reproduced by the printed command in a separate process.

#include <fmt/format.h>

#include <algorithm>

#include "broadmark/recordings/recording.h"
#include "e2e/end_to_end.h"
#include "parts.h"
#include "support/changing_worlds.h"
#include "support/places.h"
#include "support/wandering_boxes.h"

namespace broadmark::tests {
namespace {

class FailedCase : public EndToEnd {
 protected:
  /// Runs the plug-in's faulty algorithms on a source.
  void runFaulty(const std::string& source, const Arguments& more = {}) const {
    Arguments call = {"--headless",  source,    "--plugin",    places::faultyPlugin(),
                      "--algorithm", "faulty*", "--param",     "fat_margin=0.5",
                      "--quiet",     "--json",  "results.json"};
    call.insert(call.end(), more.begin(), more.end());
    const ProgramResult ended = run(call);
    EXPECT_EQ(ended.status, 1) << ended.out << ended.err;
  }
  void simulateFaulty() const {
    runFaulty("brownian", {"--objects", "200", "--frames", "60", "--engine", "kinematic"});
  }

  /// The result of an algorithm in a results file.
  [[nodiscard]] Json caseOf(const std::string& algorithm,
                            const std::string& results = "results.json") const {
    const Json all = readJson(file(results));
    for (const Json& result : all.at("cases")) {
      if (result.at("algorithm") == algorithm) return result;
    }
    ADD_FAILURE() << "no case of " << algorithm;
    return {};
  }
  [[nodiscard]] std::string idOf(const std::string& algorithm) const {
    return caseOf(algorithm).at("id");
  }

  /// Arguments for a case of results.json.
  [[nodiscard]] Arguments aboutCase(const std::string& id, const Arguments& more = {}) const {
    Arguments call = {"--headless", "results.json",         "--case", id,
                      "--plugin",   places::faultyPlugin(), "--quiet"};
    call.insert(call.end(), more.begin(), more.end());
    return call;
  }
};

TEST_F(FailedCase, PrintsItsWrongPairs) {
  const ProgramResult ended =
      run({"--headless", "brownian", "--objects", "200", "--frames", "60", "--engine", "kinematic",
           "--plugin", places::faultyPlugin(), "--algorithm", "faulty,sap", "--quiet", "--json",
           "results.json", "--print-pairs"});
  EXPECT_EQ(ended.status, 1);
  const Json differences = caseOf("faulty").at("differences");
  ASSERT_FALSE(differences.empty());
  for (const Json& difference : differences) {
    if (difference.at("missed").empty()) continue;
    const Json& pair = difference.at("missed").at(0);
    EXPECT_THAT(ended.out, HasSubstr(fmt::format("/faulty: repetition 1, frame {}: missed {}-{}",
                                                 difference.at("frame").get<int>(),
                                                 pair.at(0).get<int>(), pair.at(1).get<int>())));
  }
  EXPECT_THAT(ended.out, Not(HasSubstr("/sap: repetition")));
}

TEST_F(FailedCase, IsShrunkAndShownByACommand) {
  simulateFaulty();
  for (const std::string algorithm : {"faulty", "faulty-extra"}) {
    SCOPED_TRACE(algorithm);
    const std::string recording = "it's a " + algorithm + " case.aabbs";
    const ProgramResult ended = run(aboutCase(idOf(algorithm), {"--export-case", recording}));
    ASSERT_EQ(ended.status, 0) << ended.out << ended.err;
    EXPECT_EQ(ended.err, "");
    RecordingReader reader(file(recording));
    EXPECT_EQ(reader.scene().name, "Brownian case");
    EXPECT_LE(reader.scene().objects, 3U);
    EXPECT_LE(reader.scene().frames, 2U);
    EXPECT_THAT(ended.out, HasSubstr(fmt::format("  frame {}, body 0: (", reader.scene().frames)));

    const auto lines = linesOf(ended.out);
    ASSERT_GT(lines.size(), 5U) << ended.out;
    EXPECT_THAT(lines[0], HasSubstr(algorithm == "faulty" ? "3 bodies, " : "2 bodies, "));
    EXPECT_THAT(lines[0], HasSubstr(" of 200 bodies, 60 frames ("));
    EXPECT_THAT(lines[lines.size() - 3],
                StartsWith(algorithm == "faulty" ? "  missed " : "  false "));
    EXPECT_EQ(lines[lines.size() - 2], "written: " + recording);
    EXPECT_THAT(lines.back(), StartsWith("broadmark --headless 'it'\\''s a "));
    for (const std::string& word :
         {"--algorithm " + algorithm + " ", std::string("--param fat_margin=0.5 "),
          std::string("--check full"), std::string("--plugin ")}) {
      EXPECT_THAT(lines.back(), HasSubstr(word));
    }
    EXPECT_EQ(shell(lines.back() + " --json shown.json"), 1) << readFile(file("shell.out"));
    EXPECT_EQ(caseOf(algorithm, "shown.json").at("status"), "mismatch");

    if (!parts::kInspector.included) continue;
    writeFile(file("script.txt"), "wait idle\nexpect check = yes\nexpect algorithms = 1\n");
    EXPECT_EQ(shell(lines.back() + " --ui --script script.txt"), 0) << readFile(file("shell.out"));
  }
}

TEST_F(FailedCase, OfAChangingWorldKeepsWhatTheFaultNeeds) {
  WanderingBoxes live(80, 12, 1);
  FrameList scene = changing(live, presences::seldom, filters(80).back().filter);
  RecordingWriter writer(file("world.broadmark"), scene.scene());
  recordAll(scene, writer);
  writer.finish();
  const ProgramResult found =
      run({"--headless", "world.broadmark", "--plugin", places::faultyPlugin(), "--algorithm",
           "lossy*", "--quiet", "--json", "results.json"});
  EXPECT_EQ(found.status, 1) << found.out << found.err;
  for (const std::string algorithm : {"lossy-removal", "lossy-layers"}) {
    SCOPED_TRACE(algorithm);
    expectRefusal(aboutCase(idOf(algorithm), {"--export-case", "a.aabbs"}),
                  {"a.aabbs", ".broadmark"});
    const std::string recording = algorithm + " case.broadmark";
    const ProgramResult ended = run(aboutCase(idOf(algorithm), {"--export-case", recording}));
    ASSERT_EQ(ended.status, 0) << ended.out << ended.err;

    const auto written = openRecordingFile(file(recording));
    const bool removal = algorithm == "lossy-removal";
    EXPECT_EQ(written->scene().all_present, !removal);
    EXPECT_EQ(written->scene().filter.wantsAll(), removal);
    EXPECT_LE(written->scene().objects, 3U);
    EXPECT_EQ(written->scene().frames, 1U);
    EXPECT_EQ(shell(linesOf(ended.out).back() + " --json shown.json"), 1)
        << readFile(file("shell.out"));
    EXPECT_EQ(caseOf(algorithm, "shown.json").at("status"), "mismatch");
  }
}

TEST_F(FailedCase, OfWrongEvents) {
  runFaulty("brownian",
            {"--objects", "200", "--frames", "60", "--engine", "kinematic", "--answer", "events"});
  for (const std::string algorithm : {"faulty", "faulty-extra"}) {
    SCOPED_TRACE(algorithm);
    EXPECT_EQ(caseOf(algorithm).at("status"), "mismatch");
    const ProgramResult ended = run(aboutCase(idOf(algorithm), {"--export-case", "events.aabbs"}));
    ASSERT_EQ(ended.status, 0) << ended.out << ended.err;
    EXPECT_LE(RecordingReader(file("events.aabbs")).scene().objects, 3U);
    const std::string command = linesOf(ended.out).back();
    EXPECT_THAT(command, HasSubstr(" --answer events "));
    EXPECT_EQ(shell(command + " --json shown.json"), 1) << readFile(file("shell.out"));
    EXPECT_EQ(caseOf(algorithm, "shown.json").at("answer"), "events");
  }
}

TEST_F(FailedCase, RunsAgainAsItDid) {
  simulateFaulty();
  const Json before = caseOf("faulty");
  const ProgramResult ended = run(aboutCase(before.at("id"), {"--json", "again.json"}));
  EXPECT_EQ(ended.status, 1) << ended.out << ended.err;
  EXPECT_EQ(readJson(file("again.json")).at("cases").size(), 1U);
  const Json after = caseOf("faulty", "again.json");
  for (const char* key : {"id", "recording", "params", "status", "missed", "differences"}) {
    EXPECT_EQ(after.at(key), before.at(key)) << key;
  }
  EXPECT_EQ(run(aboutCase(before.at("id"), {"--list"})).out,
            before.at("id").get<std::string>() + "\n");
}

TEST_F(FailedCase, KeepsInstructionSetThreadsAndParameters) {
  runQuietly({"--headless", "freefall", "--objects", "30", "--frames", "3", "--algorithm",
              "sap-simd-mt,kd", "--isa", "sse2", "--threads", "3", "--param", "objects_per_leaf=7",
              "--json", "results.json"});
  for (const std::string algorithm : {"sap-simd-mt", "kd"}) {
    const Json before = caseOf(algorithm);
    runQuietly({"--headless", "results.json", "--case", before.at("id"), "--json", "again.json"});
    const Json after = caseOf(algorithm, "again.json");
    for (const char* key : {"id", "recording", "isa", "threads", "params", "device"}) {
      EXPECT_EQ(after.at(key), before.at(key)) << key;
    }
  }
}

TEST_F(FailedCase, FindsARecordingBesideItsResults) {
  bakeRecording("scene.aabbs", "60", "5");
  runQuietly({"--headless", "scene.aabbs", "--algorithm", "sap", "--json", "results.json"});
  const std::string id = idOf("sap");
  fs::create_directory(file("moved"));
  for (const char* name : {"scene.aabbs", "results.json"}) {
    fs::rename(file(name), file("moved") / name);
  }
  runQuietly({"--headless", "moved/results.json", "--case", id, "--json", "again.json"});
  EXPECT_EQ(caseOf("sap", "again.json").at("recording").at("source"), "moved/scene.aabbs");
}

TEST_F(FailedCase, AnotherRecordingIsRefused) {
  bakeRecording("scene.aabbs", "60", "5", "1");
  runQuietly({"--headless", "scene.aabbs", "--algorithm", "sap", "--json", "results.json"});
  const std::string id = idOf("sap");
  fs::remove(file("scene.aabbs"));
  expectRefusal({"--headless", "results.json", "--case", id}, {"scene.aabbs", "No such file"});
  bakeRecording("scene.aabbs", "60", "5", "2");
  expectRefusal({"--headless", "results.json", "--case", id, "--quiet"}, {"scene.aabbs", "hash"});
}

TEST_F(FailedCase, BadCallsAreRefused) {
  simulateFaulty();
  runQuietly({"--headless", "freefall", "--objects", "5", "--frames", "2", "--algorithm", "sap",
              "--json", "right.json"});
  const std::string id = idOf("faulty");
  expectRefusal({"--headless", "results.json"}, {"results.json", "--case", "'" + id + "'"});
  expectRefusal({"--headless", "right.json"}, {"right.json", "--case", "N5"});
  expectRefusal(aboutCase(id + "y"), {"results.json", "'" + id + "y'", "'" + id + "'"});
  expectRefusal(aboutCase("x"), {"results.json", "'x'", "'" + id + "'"});
  expectRefusal({"--headless", "results.json", "--case", id},
                {"'faulty'", "--plugin", "libfaulty"});
  expectRefusal({"--headless", "brownian", "--case", id}, {"--case", "brownian"});
  expectRefusal({"--headless", places::faultyPlugin(), "--case", id}, {places::faultyPlugin()});
  expectRefusal(aboutCase(id, {"--algorithm", "sap"}), {"--case", "--algorithm"});
  expectRefusal(aboutCase(id, {"--export-case", "a.posrot"}), {"a.posrot", ".aabbs"});
  expectRefusal(aboutCase(id, {"--export-case", "no/a.aabbs"}), {"no/a.aabbs", "No such file"});
  expectRefusal(aboutCase(id, {"--export-case", "a.aabbs", "--json", "j.json"}),
                {"--export-case", "--json"});
  expectRefusal({"--headless", "right.json", "--case", "FreeFall/Cubes/N5/F2/s1/sap",
                 "--export-case", "a.aabbs"},
                {"--export-case", "ok"});
}

TEST_F(FailedCase, TheRecordingItselfIsNotWrittenOver) {
  runQuietly({"bake", "--scenes", "brownian", "--objects", "200", "--frames", "60", "--engine",
              "kinematic", "--output", "baked"});
  const std::string recording = recordingIn("baked", "Brownian Cubes N200 F60frames");
  runFaulty(recording);
  expectRefusal(aboutCase(idOf("faulty"), {"--export-case", recording}), {recording});
}

}  // namespace
}  // namespace broadmark::tests
