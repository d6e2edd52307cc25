// Untrusted files are data: none makes the program write outside its folder, run programs or
// exhaust the machine's memory. A plug-in is code, so a worker process drops unneeded privileges
// and descriptors.

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <thread>

#include "e2e/end_to_end.h"
#include "engine/helpers.h"
#include "parts.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

class HostileInput : public EndToEnd {
 protected:
  HostileInput() {
    fs::create_directory(file("here"));
    fs::create_directory(file("elsewhere"));
    fs::create_directory_symlink(file("elsewhere"), file("here/link"));
  }

  /// Paths that input files must not write to if the current folder is `here`.
  [[nodiscard]] std::vector<std::string> placesElsewhere() const {
    return {file("elsewhere/x.json").string(),
            "../elsewhere/x.json",
            "link/x.json",
            "../x.json",
            ".hidden",
            "sub/../../x.json"};
  }

  ProgramResult runHere(const Arguments& call, const ProgramEnvironment& around = {}) const {
    return Program(file("here"), call, around).wait();
  }

  void expectRefusedHere(const Arguments& call, const std::string& place) const {
    SCOPED_TRACE(place);
    const auto before = entries();
    const ProgramResult ended = runHere(call);
    EXPECT_EQ(ended.status, 2);
    EXPECT_THAT(ended.err, HasSubstr("cannot write: only files below"));
    EXPECT_EQ(entries(), before);
  }
};

TEST_F(HostileInput, SettingsOfTheOriginalWriteTheirLogHereOnly) {
  bakeRecording("here/scene.aabbs");
  const auto settings = [&](const std::string& log) {
    const Json json = {
        {"m_inputScene", "scene.aabbs"}, {"m_outputLog", log}, {"m_algorithm", "BF"}};
    writeFile(file("here/settings.json"), json.dump());
    return Arguments{"--headless", "settings.json", "--quiet"};
  };
  for (const std::string& place : placesElsewhere()) expectRefusedHere(settings(place), place);
  EXPECT_EQ(runHere(settings("log.json")).status, 0);
  EXPECT_EQ(runHere(settings(file("here/other.json").string())).status, 0);
  EXPECT_TRUE(fs::exists(file("here/log.json")) && fs::exists(file("here/other.json")));
}

TEST_F(HostileInput, ScriptsWriteHereOnly) {
  if (!parts::kInspector.included) GTEST_SKIP() << "the inspector is left out of this build";
  const auto play = [&](const std::string& script) {
    writeFile(file("here/script.txt"), "wait idle\n" + script);
    return Arguments{"--headless", "--ui",       "freefall", "--objects", "5",      "--frames", "2",
                     "--script",   "script.txt", "--gl",     "auto",      "--size", "400x300"};
  };
  for (const std::string& place : placesElsewhere()) {
    expectRefusedHere(play(fmt::format("write frame \"{}\"\n", place)), place);
  }
  const std::string elsewhere = file("elsewhere").string();
  for (const std::string& script :
       {fmt::format("places \"{}/x\"\n", elsewhere),
        fmt::format("screenshot \"{}/x\"\n", elsewhere),
        fmt::format("key Ctrl+S\nenter File/name \"{}/x.aabbs\"\n"
                    "wait idle\n",
                    elsewhere),
        fmt::format("panel Batch\nenter Batch/output \"{}/out\"\nclick Batch/Start\n"
                    "wait idle\n",
                    elsewhere)}) {
    expectRefusedHere(play(script), script);
  }
  // Paths on the command line may be anywhere.
  Arguments call = play("write frame frame.txt\n");
  call.insert(call.end(), {"--screenshot", file("elsewhere/last.png").string()});
  const ProgramResult ended = runHere(call);
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_TRUE(fs::exists(file("here/frame.txt")) && fs::exists(file("elsewhere/last.png")));
}

/// The rest of the line with this beginning, in a file of the process in /proc.
std::string processLine(pid_t process, const std::string& file, const std::string& begin) {
  std::ifstream lines("/proc/" + std::to_string(process) + "/" + file);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(begin)) return onOneLine(line.substr(begin.size()));
  }
  return {};
}

TEST_F(HostileInput, ClaimsEndAtTheLimitOfMemory) {
  if (kSanitized) GTEST_SKIP() << "sanitizers hold more from the start";
  // The limit is the machine's memory, or less if the user sets a limit.
  Program endless(directory_, {"bake", "--scenes", "brownian", "--objects", "100", "--frames",
                               "1000000", "--output", "out", "--quiet"});
  ASSERT_TRUE(endless.waitUntil([&] { return fs::exists(file("out")); }));
  const auto machine = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
                       static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  EXPECT_THAT(processLine(endless.id(), "limits", "Max data size"),
              StartsWith(std::to_string(machine) + " "));

  std::string arrays = R"({"schema": "broadmark-results/2", "cases": [[])";
  for (int i = 0; i < 5'000'000; ++i) arrays += ",[]";
  writeFile(file("arrays.json"), arrays + "]}");
  writeFile(file("bodies.json"),
            R"({"schema": "broadmark-scene-parameters/1", "scene": "freefall", "parameters":
                {"objects": 10000000, "frames": 2}})");
  const ProgramEnvironment small{.max_memory_bytes = rlim_t{1} << 28};
  for (const char* name : {"arrays.json", "bodies.json"}) {
    SCOPED_TRACE(name);
    const ProgramResult ended = run({"--headless", name, "--algorithm", "sap", "--quiet"}, small);
    EXPECT_EQ(ended.status, 2);
    EXPECT_EQ(ended.err, "broadmark: out of memory\n");
  }
}

// A worker needs no core dumps, no privileges beyond its user's, and no descriptors of its parent
// process.
TEST_F(HostileInput, AWorkerHasDroppedWhatItDoesNotNeed) {
  writeFile(file("results.json"), "");
  std::FILE* inherited = std::fopen(file("secret").c_str(), "w");
  ASSERT_NE(inherited, nullptr);
  const rlimit dumps{RLIM_INFINITY, RLIM_INFINITY};
  ::setrlimit(RLIMIT_CORE, &dumps);
  Program program(directory_, {"--headless", "brownian", "--objects", "20", "--frames", "4",
                               "--plugin", places::unrulyPlugin(), "--algorithm", "unruly",
                               "--param", "deed=hang", "--quiet", "--jsonl", "results.jsonl"});
  ASSERT_TRUE(program.waitForText("hanging on purpose"));
  const pid_t worker = program.children().at(0);
  EXPECT_EQ(processLine(worker, "status", "NoNewPrivs:"), "1") << "it may get more rights";
  EXPECT_THAT(processLine(worker, "limits", "Max core file size"), StartsWith("0 0 "));
  for (const auto& entry : fs::directory_iterator("/proc/" + std::to_string(worker) + "/fd")) {
    std::error_code gone;
    const std::string held = fs::read_symlink(entry.path(), gone).string();
    EXPECT_THAT(held, Not(HasSubstr(directory_.string()))) << "inherited";
  }
  std::fclose(inherited);
}

}  // namespace
}  // namespace broadmark::tests
