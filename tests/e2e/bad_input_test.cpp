// Bad input: exit status 2, one line that names the error and the valid input, and no written
// files.

#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <limits>

#include "broadmark/harness/case.h"
#include "e2e/end_to_end.h"
#include "engine/helpers.h"
#include "parts.h"

namespace broadmark::tests {
namespace {

class BadInput : public EndToEnd {
 protected:
  /// Expects that a small run rejects these further arguments.
  void expectRunRefused(const Arguments& more, const std::vector<std::string>& words) const {
    Arguments call = {"--headless", "freefall", "--objects", "20",          "--frames", "3",
                      "--quiet",    "--json",   "no.json",   "--algorithm", "sap"};
    call.insert(call.end(), more.begin(), more.end());
    expectRefusal(call, words);
  }

  /// Expects that a file with these bytes is rejected as a source and by verify.
  void expectFileRefused(const std::string& bytes, const std::vector<std::string>& words) const {
    writeFile(file("bad file.aabbs"), bytes);
    std::vector<std::string> all = words;
    all.emplace_back("bad file.aabbs");
    Arguments call = {"--headless", "bad file.aabbs", "--json", "no.json", "--quiet"};
    if (parts::kRenderer.included) call.insert(call.end(), {"--screenshot", "no.png"});
    expectRefusal(call, all);
    const ProgramResult verified = run({"verify", "bad file.aabbs"});
    EXPECT_EQ(verified.status, 2);
    EXPECT_EQ(linesOf(verified.err).size(), 1U) << verified.err;
    for (const std::string& word : all) EXPECT_THAT(verified.err, HasSubstr(word));
  }
};

// tests/app/command_line_test.cpp tests the errors of the parser.
TEST_F(BadInput, UnknownNamesAreSuggested) {
  expectRunRefused({"--algoritm", "sap"}, {"'--algoritm'", "'--algorithm'"});
  expectRunRefused({"--algorithm", "sapp"}, {"--algorithm", "'sapp'", "'sap'"});
  expectRunRefused({"--object-type", "cube"}, {"'cube'", "'cubes'"});
  expectRunRefused({"--engine", "bulet"}, {"'bulet'", "'bullet'"});
  expectRunRefused({"--param", "densty=1"}, {"--param", "'densty'", "'density'"});
  expectRefusal({"--headless", "freefal"}, {"'freefal'", "'freefall'"});
  expectRefusal({"list", "algoritms"}, {"'algoritms'", "'algorithms'"});
  expectRefusal({"bake", "--scenes", "brownain", "--output", "no"}, {"'brownain'", "'brownian'"});
  expectRefusal({"bake", "--param", "masss=1", "--output", "no"}, {"'masss'", "'mass'"});
  expectRefusal({"bake", "--object-type", "cube", "--output", "no"}, {"'cube'", "'cubes'"});
  expectRefusal({"bake", "--engine", "bulet", "--output", "no"}, {"'bulet'", "'bullet'"});
  expectRefusal({"verfy", "a.aabbs"}, {"'verify'"});
}

TEST_F(BadInput, WhatLooksLikeAnOptionOrACommandIsNoHelp) {
  expectRefusal({"-headless", "nosuchscene", "--nonsense"}, {"'-headless'", "'--headless'"});
  expectRefusal({"bake", "-hard-limit", "5"}, {"'-hard-limit'", "'--hard-limit'"});
  expectRefusal({"torure", "--minutes", "1"}, {"'torure'", "'torture'"});
}

TEST_F(BadInput, OptionsWithoutEffect) {
  expectRunRefused({"--recorder", "aabbs"}, {"--recorder", "--record"});
  expectRunRefused({"--print-pairs", "--check", "off"}, {"--print-pairs", "--check off"});
  if (parts::kRenderer.included) {
    expectRunRefused({"--frame", "2"}, {"--frame", "--screenshot"});
    expectRunRefused({"--size", "20x20"}, {"--size", "--screenshot"});
  }
  if (!parts::kInspector.included) return;
  expectRunRefused({"--script", "a.txt"}, {"--script", "--ui"});
  expectRefusal({"freefall", "--ui"}, {"--ui", "--headless"});
  expectRefusal({"freefall", "--ui", "--headless"}, {"--ui", "--screenshot", "--script"});
}

TEST_F(BadInput, AnInstructionSetThatIsNotHere) {
  const std::string isa = isaSupported(Isa::neon) ? "avx2" : "neon";
  const Arguments call = {"--headless", "freefall", "--objects", "20", "--frames",
                          "3",          "--quiet",  "--isa",     isa,  "--algorithm"};
  Arguments all_need_it = call;
  all_need_it.emplace_back("sap-simd,bf-simd");
  expectRefusal(all_need_it, {"--isa", isa, "not supported"});
  Arguments some_do = call;
  some_do.emplace_back("sap-simd,sap");
  EXPECT_EQ(run(some_do).status, 0);
}

TEST_F(BadInput, AMemoryLimitBelowThatOfAnEmptyProcess) {
  if (tests::kSanitized) GTEST_SKIP() << "sanitizers take memory of their own";
  expectRunRefused({"--memory-limit", "0.0001"},
                   {"--memory-limit", "0.0001 GiB", "worker process"});
}

TEST_F(BadInput, PercentagesWithoutASign) {
  const auto compare = [](const std::string& share) {
    return Arguments{"compare", "a.json", "b.json", "--fail-above", share};
  };
  expectRefusal(compare("30"), {"--fail-above", "'30'", "30%"});
  expectRefusal(compare("1"), {"--fail-above", "'1'", "1%", "100%"});
  for (const char* share : {"30%", "0.3"}) {
    EXPECT_THAT(run(compare(share)).err, HasSubstr("a.json")) << "accepted, but there is no file";
  }
}

TEST_F(BadInput, NumbersOutOfRange) {
  expectRunRefused({"--repetitions", "0"}, {"--repetitions", "'0'"});
  expectRunRefused({"--objects", "50000000"}, {"objects", "'50000000'"});
  expectRefusal({"bake", "--objects=-1", "--output", "no"}, {"--objects", "'-1'"});
  for (const std::string frames : {"0", "-1", "1000001", "x"}) {
    expectRefusal({"--headless", "freefall", "--frames", frames},
                  {"frames", "'" + frames + "'", "1…1000000"});
  }
  expectRunRefused({"--density", "0"}, {"density", "'0'"});
  expectRunRefused({"--density", "nan"}, {"density", "'nan'"});
  expectRunRefused({"--seed", "-1"}, {"seed", "'-1'"});
  expectRunRefused({"--param", "friction=much"}, {"friction", "'much'"});
  for (const std::string frame : {"4", "abc"}) {
    if (!parts::kRenderer.included) break;
    expectRunRefused({"--frame", frame, "--screenshot", "a.png"}, {"--frame", frame});
  }
  if (!parts::kInspector.included) return;
  for (const std::string camera : {"1,2,3", "0,0,0,0,0,x", "0,0,0,0,91,1", "nan,0,0,0,0,1"}) {
    expectRefusal({"freefall", "--camera", camera}, {"--camera", "'" + camera + "'"});
  }
  Arguments call = {"freefall", "--objects",  "20",           "--frames", "3",
                    "--ui",     "--headless", "--screenshot", "no.png"};
  call.insert(call.end(), {"--select", "3,20"});
  expectRefusal(call, {"--select", "20", "FreeFall", "19"});
  expectRefusal({"freefall", "--select", "-1"}, {"--select", "'-1'"});
}

TEST_F(BadInput, IncompleteCalls) {
  const ProgramEnvironment no_display{.environment = {{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}}};
  expectRefusal({}, {"--headless"}, no_display);
  expectRefusal({"freefall"}, {"--headless"}, no_display);
  expectRefusal({"freefal"}, {"'freefal'", "'freefall'"}, no_display);
  expectRefusal({"freefall", "--json", "a.json"}, {"--json", "--headless"}, no_display);
  if (parts::kInspector.included) {
    expectRefusal({"--headless", "--ui", "--script", "missing.txt"}, {"missing.txt"});
  }
  expectRefusal({"--headless"}, {"no source", "freefall"});
  expectRefusal({"bake"}, {"bake", "--output"});
  expectRunRefused({"--filter", "(["}, {"--filter", "'(['"});
  expectRunRefused({"--filter", "matches nothing"}, {"--filter"});
}

TEST_F(BadInput, SourcesThatAreNone) {
  expectRefusal({"--headless", "missing.aabbs"}, {"missing.aabbs", "No such file"});
  expectRefusal({"--headless", "missing.json"}, {"missing.json", "No such file"});
  fs::create_directory(file("folder.aabbs"));
  expectRefusal({"--headless", "folder.aabbs"}, {"folder.aabbs", "not a regular file"});
  ASSERT_EQ(::mkfifo(file("fifo.aabbs").c_str(), 0600), 0);
  expectRefusal({"--headless", "fifo.aabbs"}, {"fifo.aabbs", "not a regular file"});
  writeFile(file("old.posrot"), "");
  expectRefusal({"--headless", "old.posrot"}, {"old.posrot", "0 bytes"});

  for (const auto& [name, text] :
       std::map<std::string, std::string>{{"broken.json", "{"},
                                          {"array.json", "[]"},
                                          {"empty.json", ""},
                                          {"unknown.json", R"({"schema": "something/9"})"},
                                          {"deep.json", std::string(100000, '[')}}) {
    writeFile(file(name), text);
    expectRefusal({"--headless", name}, {name});
    expectRefusal({"compare", name, name}, {name});
  }
}

TEST_F(BadInput, AResultsFileIsASourceOnlyWithACase) {
  runQuietly({"--headless", "freefall", "--objects", "5", "--frames", "2", "--json", "r.json"});
  expectRefusal({"--headless", "r.json"}, {"r.json", "--case", "'FreeFall/Cubes/N5/F2/s1/"});
}

TEST_F(BadInput, UnreadableFile) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may read everything";
  bakeRecording("secret.aabbs");
  fs::permissions(file("secret.aabbs"), fs::perms::none);
  expectRefusal({"--headless", "secret.aabbs"}, {"secret.aabbs", "Permission denied"});
}

TEST_F(BadInput, RecordingsOfTheWrongLength) {
  const std::string good = recordingOf(3, 2, unitBoxes(9));
  expectFileRefused("", {"0 bytes", "304"});
  expectFileRefused(good.substr(0, 100), {"100 bytes", "304"});
  expectFileRefused(good.substr(0, good.size() - 1), {"too short", std::to_string(good.size())});
  expectFileRefused(good + "x", {"too long", std::to_string(good.size())});
}

TEST_F(BadInput, RecordingsThatLieAboutTheirCounts) {
  expectFileRefused(recordingOf(-1, 2, unitBoxes(3)), {"negative", "-1", "byte 256"});
  expectFileRefused(recordingOf(1, -2, unitBoxes(3)), {"negative", "-2", "byte 260"});
  expectFileRefused(recordingOf(1 << 30, 2, unitBoxes(3)), {"too short"});
  // 2^30 objects in 2^29 sets have 2^64 bytes: 0 if the multiplication overflows.
  expectFileRefused(recordingOf(1 << 30, (1 << 29) - 1, {}), {"too short"});
  expectFileRefused(recordingOf(0, std::numeric_limits<std::int32_t>::max(), {}), {"frames"});
}

TEST_F(BadInput, RecordingsWithBadValues) {
  struct Fault {
    float min;
    float max;
    std::string word;
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  for (const Fault& fault :
       {Fault{kNan, 1, "NaN"}, Fault{0, kNan, "NaN"}, Fault{-kInfinite, 1, "infinite"},
        Fault{0, kInfinite, "infinite"}, Fault{2, 1, "inverted"}}) {
    // The third set is frame 2; its second box is body 1.
    std::vector<Aabb> boxes = unitBoxes(9);
    boxes[7].min[1] = fault.min;
    boxes[7].max[1] = fault.max;
    expectFileRefused(recordingOf(3, 2, boxes), {"frame 2", "body 1", "byte 528", fault.word});
    expectFileRefused(recordingOf(3, 2, unitBoxes(9), {{fault.min, 0, 0, 0}, {fault.max, 1, 1, 0}}),
                      {"world box", fault.word});
  }
}

TEST_F(BadInput, RecordingsWithUnprintableNames) {
  std::string bytes = recordingOf(1, 1, unitBoxes(2));
  bytes[3] = '\x1b';
  expectFileRefused(bytes, {"byte 0", "ASCII"});
  bytes = recordingOf(1, 1, unitBoxes(2));
  std::fill(bytes.begin() + 128, bytes.begin() + 256, 'x');
  expectFileRefused(bytes, {"byte 128", "ASCII"});
}

TEST_F(BadInput, PlacesThatCannotBeWrittenAreFoundBeforeTheRun) {
  writeFile(file("plain"), "");
  fs::create_directory(file("folder.png"));
  ASSERT_EQ(::mkfifo(file("fifo.png").c_str(), 0600), 0);
  // Because of its size, the test ends only if the input is rejected early.
  const auto refused = [&](const Arguments& more, const std::vector<std::string>& words) {
    Arguments call = {"--headless", "gravity", "--objects", "100000",
                      "--frames",   "100000",  "--quiet"};
    call.insert(call.end(), more.begin(), more.end());
    expectRefusal(call, words);
  };
  std::vector<std::string> options = {"--json", "--csv", "--csv-frames"};
  if (parts::kRenderer.included) options.emplace_back("--screenshot");
  for (const std::string& option : options) {
    refused({option, "missing/file.png"}, {"missing/file.png", "No such file or directory"});
    refused({option, "plain/file.png"}, {"plain/file.png"});
    refused({option, "folder.png"}, {"folder.png", "cannot write"});
    refused({option, "fifo.png"}, {"fifo.png", "cannot write"});
  }
  EXPECT_TRUE(fs::is_fifo(file("fifo.png")));
  refused({"--record", "plain/folder"}, {"plain/folder", "directory"});
  refused({"--record", "recordings", "--json", "missing/file"}, {"missing/file"});
  expectRefusal({"bake", "--output", "plain/folder"}, {"plain/folder", "directory"});
  expectRefusal({"bake", "--output", "/proc/folder"}, {"/proc/folder", "cannot create"});
}

TEST_F(BadInput, OneFileForTwoThings) {
  bakeRecording("source.aabbs");
  const std::string bytes = readFile(file("source.aabbs"));
  expectRefusal({"--headless", "source.aabbs", "--json", "./source.aabbs"},
                {"--json", "source.aabbs"});
  EXPECT_EQ(readFile(file("source.aabbs")), bytes);
  expectRefusal({"--headless", "source.aabbs", "--json", "same", "--csv", "same"},
                {"--csv", "--json", "same"});
}

}  // namespace
}  // namespace broadmark::tests
