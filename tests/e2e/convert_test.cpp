// Conversion between formats of recordings; .broadmark recordings wherever .aabbs is accepted.

#include "broadmark/recordings/recording.h"
#include "e2e/end_to_end.h"

namespace broadmark::tests {
namespace {

const std::string kStem = "City Cubes N200 F30frames";
const std::string kChanging = "out/Recordings_Broadmark/" + kStem + ".broadmark";

class Convert : public EndToEnd {
 protected:
  void SetUp() override {
    runQuietly({"bake", "--scenes", "city", "--objects", "200", "--frames", "30", "--recorder",
                "aabbs,broadmark", "--output", "out"});
    boxes_ = recordingIn("out", kStem);
  }

  /// A recording; `absent`: whether body 1 is absent in frame 1.
  void writeChanging(const std::string& name, bool absent) const {
    RecordingWriter writer(file(name), {.name = "Changing",
                                        .object_type = "Boxes",
                                        .objects = 2,
                                        .frames = 1,
                                        .world = kUnitBox,
                                        .all_present = false});
    writer.write(unitBoxes(2));
    writer.write(std::vector{kUnitBox, absent ? kEmptyBox : kUnitBox});
    writer.finish();
  }

  /// The pairs and the status of each case on a recording.
  [[nodiscard]] Json answersOn(const std::string& source) const {
    runQuietly({"--headless", source, "--algorithm", "bf,sap,kd", "--time-limit", "100", "--json",
                "r.json"});
    Json answers;
    const Json results = readJson(file("r.json"));
    for (const Json& result : results.at("cases")) {
      answers.push_back({result.at("status"), result.at("pairs")});
    }
    return answers;
  }

  std::string boxes_;
};

TEST_F(Convert, ThereAndBackIsTheSameFile) {
  runQuietly({"convert", boxes_, "there.broadmark"});
  const ProgramResult ended = runQuietly({"convert", "there.broadmark", "back.aabbs"});
  EXPECT_EQ(readFile(file("back.aabbs")), readFile(file(boxes_)));
  EXPECT_THAT(ended.out, AllOf(StartsWith("back.aabbs: "), HasSubstr("hash ")));
  EXPECT_LT(fs::file_size(file("there.broadmark")) * 5, fs::file_size(file(boxes_)));
  EXPECT_THAT(openRecordingFile(file("there.broadmark"))->origin().scene_parameters,
              HasSubstr("\"city\""))
      << "as its sidecar says";
  EXPECT_EQ(run({"verify", "there.broadmark"}).status, 0);
}

TEST_F(Convert, BakedBesideAabbsItHoldsTheSame) {
  const ProgramResult verified = run({"verify", kChanging, boxes_});
  EXPECT_EQ(verified.status, 0) << verified.err;
  EXPECT_THAT(verified.out, HasSubstr(kStem + ".broadmark: ok: City Cubes"));
  EXPECT_THAT(linesOf(verified.out)[0], HasSubstr(", as baked"));
  runQuietly({"convert", kChanging, "back.aabbs"});
  EXPECT_EQ(readFile(file("back.aabbs")), readFile(file(boxes_)));
  EXPECT_THAT(runQuietly({"bake", "--scenes", "city", "--objects", "200", "--frames", "30",
                          "--recorder", "aabbs,broadmark", "--output", "out"})
                  .out,
              HasSubstr("0 baked, 2 kept"));
  const auto opened = openRecordingFile(file(kChanging));
  EXPECT_THAT(opened->origin().scene_parameters, HasSubstr("\"city\""));
}

TEST_F(Convert, TheSamePairsAreFound) {
  const Json answers = answersOn(boxes_);
  EXPECT_EQ(answersOn(kChanging), answers);
  EXPECT_EQ(readJson(file("r.json")).at("cases").at(0).at("recording").at("source"), kChanging);
  // The viewer engine and settings of the original also accept it.
  runQuietly({"bake", "--scenes", "city", "--objects", "200", "--engine", "viewer", "--input",
              "out/Recordings_Broadmark", "--output", "again"});
  EXPECT_EQ(readFile(file(recordingIn("again", kStem))), readFile(file(boxes_)));
  writeFile(file("settings.json"),
            Json{{"m_inputScene", kChanging}, {"m_outputLog", "log.json"}, {"m_algorithm", "SAP"}}
                .dump());
  runQuietly({"--headless", "settings.json"});
  EXPECT_EQ(readJson(file("log.json")).at("Frames").size(), 30U);
}

TEST_F(Convert, SaysWhatAabbsCannotHold) {
  writeChanging("a.broadmark", true);
  expectRefusal({"convert", "--quiet", "a.broadmark", "a.aabbs"},
                {"a.aabbs", "body 1 is absent in frame 1", ".broadmark"});
  writeChanging("b.broadmark", false);
  runQuietly({"convert", "b.broadmark", "b.aabbs"});
  EXPECT_EQ(fs::file_size(file("b.aabbs")), 304U + 32 * 4);
}

TEST_F(Convert, RefusesWhatMakesNoSense) {
  expectRefusal({"convert", boxes_, boxes_}, {"is the input recording"});
  expectRefusal({"convert", boxes_, "a.posrot"}, {"a.posrot", ".aabbs or .broadmark"});
  expectRefusal({"convert", boxes_, "a.json"}, {"a.json", ".aabbs or .broadmark"});
  expectRefusal({"convert", "gone.aabbs", "a.broadmark"}, {"gone.aabbs", "No such file"});
  expectRefusal({"convert", boxes_, "no/a.broadmark"}, {"no/a.broadmark", "No such file"});
}

TEST_F(Convert, DamagedOnesAreFound) {
  std::string bytes = readFile(file(kChanging));
  bytes[bytes.size() / 2] ^= 1;
  writeFile(file("bad.broadmark"), bytes);
  expectRefusal({"verify", "bad.broadmark"}, {"bad.broadmark", "damaged"});
  expectRefusal({"convert", "--quiet", "bad.broadmark", "a.aabbs"}, {"bad.broadmark", "damaged"});
  runQuietly({"convert", recordingIn("out", kStem), kChanging});  // the same boxes, another source
  EXPECT_THAT(run({"verify", kChanging}).err, HasSubstr("changed since it was baked"));
}

}  // namespace
}  // namespace broadmark::tests
