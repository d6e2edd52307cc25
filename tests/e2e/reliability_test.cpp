// The program on a failing machine: at every file operation it is killed, the disc is full or
// broken, a signal arrives, or a read or write is partial. Finished files remain, no partial file
// looks complete, and the same command resumes. docs/reliability.md lists all faults.

#include <fmt/format.h>
#include <sys/mount.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "broadmark/results/results.h"
#include "e2e/end_to_end.h"
#include "parts.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;

/// The contents of the files below a folder, by name.
using Contents = std::map<std::string, std::string>;

Contents contentsOf(const fs::path& folder) {
  Contents contents;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    contents[fs::relative(entry.path(), folder).string()] = readFile(entry.path());
  }
  return contents;
}

void restore(const fs::path& folder, const Contents& contents) {
  fs::remove_all(folder);
  fs::create_directories(folder);
  for (const auto& [name, bytes] : contents) {
    fs::create_directories((folder / name).parent_path());
    writeFile(folder / name, bytes);
  }
}

/// The reproducible part of results.
struct Essence {
  std::vector<std::string> cases;
  bool complete = false;
  bool operator==(const Essence&) const = default;
};

bool isResultsName(const std::string& name) { return name.starts_with("results."); }

Essence essenceOf(const std::string& name, const std::string& bytes) {
  if (name.ends_with(".csv")) {
    Essence essence{.complete = true};
    for (const std::string& line : linesOf(bytes)) {
      essence.cases.push_back(line.substr(0, line.find(',')));
    }
    return essence;
  }
  const Results results = parseResults(bytes, name);
  Essence essence{.complete = results.complete};
  for (const CaseResult& result : results.cases) {
    essence.cases.push_back(fmt::format("{} {} {} {}", result.id, statusName(result.status),
                                        result.pairs_mean, result.recording.hash));
  }
  return essence;
}

/// A command that writes files.
struct Step {
  std::string name;
  std::vector<Arguments> before;  ///< commands to run before it
  Arguments call;
  Contents texts;  ///< other existing files
  int stride = 1;  ///< the fault tests let every stride-th file operation fail
  int kill_stride = 1;
  bool shown = true;  ///< whether the required parts are built

  friend void PrintTo(const Step& step, std::ostream* out) { *out << step.name; }
};

std::vector<Step> steps() {
  const auto headless = [](const std::string& algorithms) {
    return Arguments{"--headless",  "freefall", "--objects",    "5",      "--frames", "2",
                     "--algorithm", algorithms, "--in-process", "--quiet"};
  };
  const auto with = [](Arguments call, const Arguments& more) {
    call.insert(call.end(), more.begin(), more.end());
    return call;
  };
  const auto bake = [](const std::string& objects) {
    return Arguments{"bake",     "--scenes", "freefall",  "--objects", objects,      "--frames",
                     "2",        "--quiet",  "--threads", "1",         "--recorder", "aabbs,posrot",
                     "--output", "out"};
  };
  const Arguments outputs = {"--json",        "results.json", "--jsonl",
                             "results.jsonl", "--csv",        "results.csv"};
  const std::string poses = posesIn("out", "FreeFall Cubes N5 F2frames");
  return {
      {.name = "Bake", .before = {bake("5")}, .call = bake("5,6")},
      {.name = "Run",
       .before = {with(headless("bf"), outputs)},
       .call = with(with(headless("bf,sap"), outputs), {"--record", "recordings"}),
       .stride = 2},
      {.name = "Merge",
       .before = {with(headless("bf"), {"--jsonl", "results.jsonl"}),
                  with(headless("sap"), {"--json", "b.json"})},
       // The output replaces one of the sources.
       .call = with({"merge", "results.jsonl", "b.json"}, outputs)},
      {.name = "Convert",
       .before = {bake("5"), {"convert", poses, "made.aabbs", "--quiet"}},
       .call = {"convert", poses, "made.broadmark", "--quiet"}},
      {.name = "Import",
       .call = {"import", "boxes.csv", "--output", "made.aabbs", "--quiet"},
       .texts = {{"boxes.csv", "frame,id,x0,y0,z0,x1,y1,z1\n0,0,0,0,0,1,1,1\n1,0,0,0,0,2,1,1\n"}}},
      {.name = "Inspector",
       .call = {"--headless", "--ui", "freefall", "--objects", "5", "--frames", "2", "--script",
                "script.txt", "--gl", "auto", "--size", "400x300"},
       .texts = {{"saved.aabbs", "old"},
                 {"scene.json", "old"},
                 {"script.txt",
                  "wait idle\n"
                  "key Ctrl+S\nenter File/name saved.aabbs\nclick File/Save\n"
                  "expect dialog = no\nwait idle\n"
                  "click \"Author/From this frame\"\nexpect author.shown = yes\n"
                  "key Ctrl+S\nenter File/name scene\nclick File/Save\n"
                  "expect author.modified = no\nwrite author.bodies bodies.txt\n"}},
       .stride = 3,
       .kill_stride = 3,
       .shown = parts::kInspector.included},
  };
}

/// A file operation, as logged by the preloaded library.
struct Call {
  int number = 0;
  std::string kind;
  fs::path path;

  [[nodiscard]] bool is(std::string_view wanted, const fs::path& at) const {
    return kind == wanted && path == at;
  }
  [[nodiscard]] bool changes() const { return kind != "read" && kind != "open"; }
  [[nodiscard]] bool needsRoom() const {
    return changes() && kind != "ftruncate" && kind != "unlink";
  }
};

class Reliability : public EndToEnd, public ::testing::WithParamInterface<Step> {
 protected:
  void SetUp() override {
    if (places::faultInjection().empty()) GTEST_SKIP() << "sanitizers stand under the program";
    if (!GetParam().shown) GTEST_SKIP() << "left out of this build";
    restore(folder_, GetParam().texts);
    for (const Arguments& call : GetParam().before) {
      const ProgramResult ended = Program(folder_, call).wait();
      ASSERT_EQ(ended.status, 0) << ended.err;
    }
    before_ = contentsOf(folder_);
    const ProgramResult ended = runWith("");
    ASSERT_EQ(ended.status, 0) << ended.err;
    calls_ = noted();
    whole_ = contentsOf(folder_);
    ASSERT_GT(whole_.size(), before_.size());
  }

  /// Runs the command on the initial files, with a fault.
  ProgramResult runWith(const std::string& fault) {
    restore(folder_, before_);
    fs::remove(log_);
    const fs::path library = places::faultInjection();
    return Program(
               folder_, GetParam().call,
               {.environment = {{"LD_PRELOAD",
                                 library.filename()},  // a name, because a space would end a path
                                {"LD_LIBRARY_PATH", library.parent_path()},
                                {"BROADMARK_FAULT_FOLDER", folder_.string()},
                                {"BROADMARK_FAULT_LOG", log_.string()},
                                {"BROADMARK_FAULT", fault}}})
        .wait();
  }

  /// The file operations of the last run.
  [[nodiscard]] std::vector<Call> noted() const {
    std::vector<Call> calls;
    for (const std::string& line : linesOf(readFile(log_))) {
      std::istringstream fields(line);
      Call call;
      fields >> call.number >> call.kind >> std::ws;
      std::string path;
      std::getline(fields, path);
      call.path = path;
      calls.push_back(call);
    }
    return calls;
  }

  /// Calls visit(call) for every stride-th operation that changes a file; `first`: an offset.
  template <class Visit>
  void eachChange(int first, int stride, Visit&& visit) const {
    int change = -first;
    for (const Call& call : calls_) {
      if (!call.changes() || change++ % stride != 0) continue;
      SCOPED_TRACE(fmt::format("{} {} {}", call.number, call.kind, call.path.string()));
      visit(call);
    }
  }

  /// Expects that each file is old or new; results may also be partial and marked as such.
  void expectNothingHalf() const {
    const Contents now = contentsOf(folder_);
    for (const auto& [name, bytes] : before_) EXPECT_TRUE(now.contains(name)) << name;
    for (const auto& [name, bytes] : now) {
      if (name.ends_with(".part")) continue;
      const auto old = before_.find(name);
      if (old != before_.end() && old->second == bytes) continue;
      ASSERT_TRUE(whole_.contains(name)) << name;
      EXPECT_TRUE(isWholeOrSaysSo(name, bytes)) << name << ":\n" << bytes;
    }
  }

  void expectAllDone() const {
    const Contents now = contentsOf(folder_);
    for (const auto& [name, bytes] : now) EXPECT_TRUE(whole_.contains(name)) << name;
    for (const auto& [name, bytes] : whole_) {
      ASSERT_TRUE(now.contains(name)) << name;
      EXPECT_TRUE(isWhole(name, now.at(name))) << name;
    }
  }

  void expectGoesOn() {
    const ProgramResult again = Program(folder_, GetParam().call).wait();
    EXPECT_EQ(again.status, 0) << again.err;
    expectAllDone();
  }

  /// Expects an error of one line, or of one per file, that names the file that cannot be written.
  void expectComplaint(const ProgramResult& ended, const Call& about) const {
    fs::path named = about.path;
    // A folder is synced because of the entry created last.
    for (const Call& call : calls_) {
      const bool names = call.kind == "rename" || call.kind == "mkdir";
      if (about.kind == "fsync" && names && call.number < about.number &&
          call.path.parent_path() == about.path) {
        named = call.path;
      }
    }
    EXPECT_EQ(ended.status, 2) << ended.err;
    const auto lines = linesOf(ended.err);
    EXPECT_THAT(lines, Not(IsEmpty()));
    for (const std::string& line : lines) EXPECT_THAT(line, StartsWith("broadmark: "));
    if (named.extension() == ".part") named.replace_extension();
    EXPECT_THAT(ended.err, HasSubstr(named.filename().string()));
  }

  const fs::path folder_ = directory_ / "some folder";
  const fs::path log_ = directory_ / "calls.txt";
  Contents before_;
  Contents whole_;
  std::vector<Call> calls_;  ///< of a run without faults

 private:
  [[nodiscard]] bool isWhole(const std::string& name, const std::string& bytes) const {
    if (bytes == whole_.at(name)) return true;
    return isResultsName(name) && essenceOf(name, bytes) == essenceOf(name, whole_.at(name));
  }

  [[nodiscard]] bool isWholeOrSaysSo(const std::string& name, const std::string& bytes) const {
    if (isResultsName(name) && bytes.empty()) return !before_.contains(name);  // no content yet
    if (isWhole(name, bytes)) return true;
    if (!isResultsName(name)) return false;
    const Essence now = essenceOf(name, bytes);
    const Essence whole = essenceOf(name, whole_.at(name));
    // CSV does not state whether it is complete.
    return (!now.complete || name.ends_with(".csv")) && !now.cases.empty() &&
           now.cases.size() <= whole.cases.size() &&
           std::equal(now.cases.begin(), now.cases.end(), whole.cases.begin());
  }
};

TEST_P(Reliability, KilledAnywhere) {
  int number = 0;
  eachChange(0, GetParam().kill_stride, [&](const Call& call) {
    const ProgramResult ended = runWith(fmt::format("kill {}", call.number));
    EXPECT_EQ(ended.status, 128 + SIGKILL);
    expectNothingHalf();
    if (number++ % 6 == 0) expectGoesOn();
  });
  expectGoesOn();
}

TEST_P(Reliability, TheDiscIsFullFromAnyCallOn) {
  eachChange(1, GetParam().stride, [&](const Call& call) {
    const ProgramResult ended = runWith(fmt::format("ENOSPC {}", call.number));
    const auto failed = std::ranges::find_if(
        calls_, [&](const Call& next) { return next.number >= call.number && next.needsRoom(); });
    if (failed == calls_.end()) {
      EXPECT_EQ(ended.status, 0) << ended.err;
    } else {
      expectComplaint(ended, *failed);
      EXPECT_THAT(ended.err, HasSubstr("No space left on device"));
    }
    expectNothingHalf();
  });
  expectGoesOn();
}

TEST_P(Reliability, AnyCallFails) {
  const auto fails = [&](const Call& call) {
    const ProgramResult ended = runWith(fmt::format("EIO {}", call.number));
    // A leftover of a probe is reused, and an unreadable file may be written again.
    const bool matters = call.changes() && call.kind != "unlink";
    if (matters || ended.status != 0) {
      expectComplaint(ended, call);
    } else {
      expectAllDone();
    }
    expectNothingHalf();
  };
  eachChange(2, GetParam().stride, fails);
  for (const Call& call : calls_) {
    SCOPED_TRACE(fmt::format("{} {} {}", call.number, call.kind, call.path.string()));
    if (!call.changes() && GetParam().stride == 1) fails(call);
  }
  expectGoesOn();
}

TEST_P(Reliability, SignalsAndHalvesAreNotSeen) {
  for (const char* fault : {"EINTR 1", "EINTR 2", "short 1"}) {
    SCOPED_TRACE(fault);
    const ProgramResult ended = runWith(fault);
    EXPECT_EQ(ended.status, 0) << ended.err;
    EXPECT_GT(noted().size(), calls_.size()) << "there were no faults";
    expectAllDone();
  }
}

// A power failure preserves synced data, and an arbitrary part of the rest.
TEST_P(Reliability, ContentsAreOnTheDiscBeforeTheirNames) {
  const auto after = [&](auto from, const auto& wanted) {
    return std::find_if(from, calls_.end(), wanted);
  };
  int named = 0;
  for (auto call = calls_.begin(); call != calls_.end(); ++call) {
    SCOPED_TRACE(fmt::format("{} {} {}", call->number, call->kind, call->path.string()));
    const fs::path folder = call->path.parent_path();
    if (call->kind == "rename") {
      ++named;
      const fs::path partial = call->path.string() + ".part";
      const auto last = std::find_if(std::make_reverse_iterator(call), calls_.rend(),
                                     [&](const Call& other) { return other.path == partial; });
      ASSERT_NE(last, calls_.rend());
      EXPECT_EQ(last->kind, "fsync");
    }
    if (call->kind == "rename" || call->kind == "mkdir") {
      const auto synced = after(call, [&](const Call& other) { return other.is("fsync", folder); });
      ASSERT_NE(synced, calls_.end());
      const auto next =
          after(std::next(call), [](const Call& other) { return other.kind == "rename"; });
      EXPECT_LT(synced->number, next == calls_.end() ? INT_MAX : next->number);
    }
    // Each append is a finished case, which must be synced.
    if (call->kind == "write" && call->path.extension() != ".part") {
      ASSERT_NE(std::next(call), calls_.end());
      EXPECT_TRUE(std::next(call)->is("fsync", call->path));
    }
  }
  EXPECT_GT(named, 0);
}

INSTANTIATE_TEST_SUITE_P(All, Reliability, ::testing::ValuesIn(steps()),
                         [](const auto& tested) { return tested.param.name; });

// Other processes and users in the same folder.

class SharedFolder : public EndToEnd {
 protected:
  /// A run on a recording with a first case that finishes at once and a second that takes seconds.
  [[nodiscard]] static Arguments longRun(const Arguments& more = {},
                                         const std::string& algorithms = "bf,time-validator",
                                         const std::string& phase_us = "15000") {
    Arguments call = {"--headless", "some.aabbs",           "--algorithm",  algorithms,
                      "--param",    "phase_us=" + phase_us, "--time-limit", "100",
                      "--json",     "results.json",         "--jsonl",      "results.jsonl",
                      "--quiet"};
    call.insert(call.end(), more.begin(), more.end());
    return call;
  }

  /// Waits until the first case is finished.
  [[nodiscard]] bool waitForFirstCase(Program& program) const {
    return program.waitUntil([&] {
      return fs::exists(file("results.jsonl")) && fs::file_size(file("results.jsonl")) > 0;
    });
  }

  /// Expects that both results files hold only the first case and are marked as incomplete.
  void expectFirstCaseKept() const {
    for (const char* name : {"results.json", "results.jsonl"}) {
      const Results results = parseResults(readFile(file(name)), name);
      ASSERT_EQ(results.cases.size(), 1U) << name;
      EXPECT_EQ(results.cases[0].algorithm, "bf");
      EXPECT_FALSE(results.complete);
    }
  }

  void writeInPlace(const std::string& name, std::uintmax_t offset, const std::string& bytes) {
    std::fstream stream(file(name), std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(static_cast<std::streamoff>(offset));
    stream << bytes;
  }
};

TEST_F(SharedFolder, ARecordingThatAnotherReplacesIsReadToItsEnd) {
  bakeRecording("some.aabbs", "20", "20");
  bakeRecording("other.aabbs", "20", "20", "2");
  Program program(directory_, longRun({"--repetitions", "2"}));
  ASSERT_TRUE(waitForFirstCase(program));
  const ProgramResult verified = run({"verify", "some.aabbs"});
  fs::rename(file("other.aabbs"), file("some.aabbs"));
  const ProgramResult ended = program.wait();
  EXPECT_EQ(ended.status, 0) << ended.err;
  const Json results = readJson(file("results.json"));
  for (const Json& result : results.at("cases")) {
    EXPECT_EQ(result.at("status"), "ok");
    EXPECT_THAT(verified.out, HasSubstr(result.at("recording").at("hash").get<std::string>()));
  }
}

TEST_F(SharedFolder, ARecordingThatIsWrittenToEndsTheRun) {
  for (const bool cut : {true, false}) {
    SCOPED_TRACE(cut);
    fs::remove(file("results.jsonl"));
    bakeRecording("some.aabbs", "20", "40");
    Program program(directory_, longRun());
    ASSERT_TRUE(waitForFirstCase(program));
    if (cut) {
      fs::resize_file(file("some.aabbs"), 5000);
    } else {
      // Valid boxes with other pairs.
      const std::string bytes = readFile(file("some.aabbs"));
      const std::size_t half = 304 + 20 * sizeof(Aabb) * 20;
      writeInPlace("some.aabbs", half, bytes.substr(304, bytes.size() - half));
    }
    const ProgramResult ended = program.wait();
    EXPECT_EQ(ended.status, 2);
    EXPECT_EQ(linesOf(ended.err).size(), 1U) << ended.err;
    EXPECT_THAT(ended.err, AllOf(HasSubstr("some.aabbs"),
                                 AnyOf(HasSubstr("was written to"), HasSubstr("ends at byte"))));
    expectFirstCaseKept();
  }
}

TEST_F(SharedFolder, APluginThatVanishesEndsTheRun) {
  const std::string other_build = readFile(places::faultyPlugin()) + "x";
  const std::string other_library = readFile(places::unrulyPlugin());
  for (const std::string& replacement : {std::string(), other_build, other_library}) {
    SCOPED_TRACE(replacement.size());
    fs::remove(file("results.jsonl"));
    fs::copy_file(places::faultyPlugin(), file("mine.so"));
    bakeRecording("some.aabbs", "20", "20");
    // The third case's process starts when the second case has ended.
    Program program(directory_, longRun({"--plugin", "mine.so"}, "bf,time-validator,faulty"));
    ASSERT_TRUE(waitForFirstCase(program));
    if (replacement.empty()) {
      fs::remove(file("mine.so"));
    } else {
      writeFile(file("other.so"), replacement);
      fs::rename(file("other.so"), file("mine.so"));
    }
    const ProgramResult ended = program.wait();
    EXPECT_EQ(ended.status, 2);
    EXPECT_EQ(linesOf(ended.err).size(), 1U) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("mine.so"));
    const Results results = parseResults(readFile(file("results.json")), "results.json");
    EXPECT_EQ(results.cases.size(), 2U);
    EXPECT_FALSE(results.complete);
    fs::remove(file("mine.so"));
  }
}

TEST_F(SharedFolder, ResultsLoadNoPluginAndSayWhichIsMissing) {
  fs::copy_file(places::faultyPlugin(), file("mine.so"));
  runQuietly({"--headless", "freefall", "--objects", "5", "--frames", "2", "--plugin", "mine.so",
              "--algorithm", "faulty", "--json", "r.json"});
  const auto id = readJson(file("r.json")).at("cases").at(0).at("id").get<std::string>();
  const Arguments again = {"--headless", "r.json", "--case", id};
  expectRefusal(again, {"'faulty'", "not loaded", "--plugin mine.so"});
  fs::remove(file("mine.so"));
  expectRefusal(again, {"'faulty'", "not loaded", "--plugin mine.so"});
  expectRefusal({"--headless", "r.json", "--case", id, "--plugin", "mine.so"},
                {"mine.so", "No such file"});
}

TEST_F(SharedFolder, TwoBakesOfTheSameRecordings) {
  const Arguments bake = {"bake",     "--scenes", "freefall,gravity", "--objects", "20,30,40",
                          "--frames", "60",       "--output",         "out",       "--quiet"};
  Program first(directory_, bake);
  Program second(directory_, bake);
  for (Program* program : {&first, &second}) {
    const ProgramResult ended = program->wait();
    EXPECT_THAT(ended.status, AnyOf(0, 2)) << ended.err;
    for (const std::string& line : linesOf(ended.err)) EXPECT_THAT(line, HasSubstr("another"));
  }
  const ProgramResult again = run(bake);
  EXPECT_EQ(again.status, 0) << again.err;
  Arguments verify = {"verify"};
  for (const std::string& name : files()) {
    EXPECT_THAT(name, Not(HasSubstr(".part")));
    if (name.ends_with(".aabbs")) verify.push_back(name);
  }
  EXPECT_EQ(verify.size(), 1U + 6);
  EXPECT_EQ(run(verify).status, 0);
}

TEST_F(SharedFolder, TwoRunsIntoTheSameFiles) {
  bakeRecording("some.aabbs", "20", "20");
  const Arguments call = longRun({}, "bf,time-validator", "60000");
  Program first(directory_, call);
  ASSERT_TRUE(waitForFirstCase(first));
  // JSON Lines are locked by one run at a time; a JSON file has the results of the last writer.
  const ProgramResult second = run(call);
  EXPECT_EQ(second.status, 2);
  EXPECT_THAT(second.err, AllOf(HasSubstr("results.jsonl"), HasSubstr("another process")));
  const ProgramResult other = run({"--headless", "some.aabbs", "--algorithm", "kd", "--json",
                                   "results.json", "--in-process", "--quiet"});
  EXPECT_EQ(other.status, 0) << other.err;
  const bool first_is_last = first.isRunning();
  const ProgramResult ended = first.wait();
  EXPECT_EQ(ended.status, 0) << ended.err;
  const Results lines = parseResults(readFile(file("results.jsonl")), "results.jsonl");
  EXPECT_EQ(lines.cases.size(), 2U);
  EXPECT_TRUE(lines.complete);
  const Results whole = parseResults(readFile(file("results.json")), "results.json");
  EXPECT_TRUE(whole.complete);
  EXPECT_TRUE(!first_is_last || whole.cases.size() == 2);
}

TEST_F(SharedFolder, AReadOnlyFolderIsNamed) {
  fs::create_directory(file("disc"));
  if (::mount("tmpfs", file("disc").c_str(), "tmpfs", 0, "size=1m") != 0) {
    GTEST_SKIP() << "cannot mount a file system: " << std::strerror(errno);
  }
  bakeRecording("some.aabbs");
  fs::copy_file(file("some.aabbs"), file("disc/some.aabbs"));
  runQuietly({"--headless", "disc/some.aabbs", "--algorithm", "bf", "--json", "disc/r.json"});
  writeFile(file("boxes.csv"), "frame,id,x0,y0,z0,x1,y1,z1\n0,0,0,0,0,1,1,1\n1,0,0,0,0,2,1,1\n");
  EXPECT_EQ(::mount("", file("disc").c_str(), "", MS_REMOUNT | MS_RDONLY, ""), 0);
  for (const Arguments& call : std::vector<Arguments>{
           {"bake", "--scenes", "freefall", "--objects", "5", "--frames", "2", "--output",
            "disc/new"},
           {"--headless", "disc/some.aabbs", "--algorithm", "sap", "--json", "disc/r.json"},
           {"--headless", "disc/some.aabbs", "--algorithm", "sap", "--jsonl", "disc/r.jsonl"},
           {"merge", "disc/r.json", "disc/r.json", "--json", "disc/merged.json"},
           {"convert", "disc/some.aabbs", "disc/some.broadmark"},
           {"import", "boxes.csv", "--output", "disc/made.aabbs"}}) {
    expectRefusal(call, {"disc/", "Read-only file system"});
  }
  const ProgramResult reads =
      run({"--headless", "disc/some.aabbs", "--algorithm", "sap", "--quiet"});
  EXPECT_EQ(reads.status, 0) << reads.err;
  EXPECT_EQ(::umount(file("disc").c_str()), 0);
}

}  // namespace
}  // namespace broadmark::tests
