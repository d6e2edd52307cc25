// The program on unusual machines: one core, little memory, a read-only home, no shared memory, a
// clock that goes backwards, odd names. It gives the same results as anywhere, or says why not.

#include <fmt/format.h>
#include <unistd.h>

#include <map>

#include "broadmark/cores.h"
#include "broadmark/results/results.h"
#include "e2e/end_to_end.h"
#include "engine/helpers.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

using ::testing::Each;
using ::testing::EndsWith;

class Machine : public EndToEnd {
 protected:
  Machine() { bakeRecording("scene.aabbs"); }

  /// The reproducible part of the results of a run in `folder`: case, status and pairs.
  [[nodiscard]] std::vector<std::string> essence(const fs::path& folder) const {
    std::vector<std::string> cases;
    const Results results = parseResults(readFile(folder / "r.json"), "r.json");
    EXPECT_TRUE(results.complete);
    for (const CaseResult& result : results.cases) {
      cases.push_back(fmt::format("{} {} {} {}", result.recording.hash, result.algorithm,
                                  result.pairs_mean, statusName(result.status)));
    }
    return cases;
  }

  /// Expects the results of an ordinary run from a run in a shell, after the shell commands
  /// `setting`, within the command `around`, on these algorithms.
  void expectOrdinaryResults(const std::string& setting, const std::string& around = "",
                             const std::string& algorithms = kAlgorithms) const {
    ASSERT_EQ(shell(fmt::format(kCall, algorithms)), 0) << readFile(file("shell.out"));
    const std::vector<std::string> ordinary = essence(directory_);
    EXPECT_THAT(ordinary, Each(EndsWith(" ok")));
    fs::remove(file("r.json"));
    ASSERT_EQ(shell(setting + "; " + around + " " + fmt::format(kCall, algorithms)), 0)
        << readFile(file("shell.out"));
    EXPECT_EQ(essence(directory_), ordinary);
  }

  static constexpr const char* kAlgorithms =
      "bf,sap-simd-mt,grid-sap-mt,kd-mt,columns-mt,tide,dbvt-d";
  static constexpr const char* kCall =
      "broadmark --headless scene.aabbs --check full --time-limit 60 --quiet --json r.json "
      "--algorithm {}";
};

TEST_F(Machine, OneCore) {
  expectOrdinaryResults("true", fmt::format("taskset -c {}", usableCores().front()));
}

TEST_F(Machine, TwoGigabytes) {
  if (kSanitized) GTEST_SKIP() << "sanitizers reserve more";
  expectOrdinaryResults("ulimit -v 2097152");
}

TEST_F(Machine, FewFileDescriptors) { expectOrdinaryResults("ulimit -n 64"); }

TEST_F(Machine, OthersMayReadNothing) { expectOrdinaryResults("umask 077"); }

TEST_F(Machine, ReadOnlyHome) {
  expectOrdinaryResults("export HOME=/proc; unset XDG_CACHE_HOME XDG_CONFIG_HOME");
}

TEST_F(Machine, NoSharedMemory) {
  const std::string private_mounts = "unshare --map-root-user --mount sh -c ";
  if (shell(private_mounts + "true") != 0) GTEST_SKIP() << "not allowed to mount";
  expectOrdinaryResults("run() { " + private_mounts +
                            "'mount -t tmpfs -o ro none /dev/shm && exec \"$0\" \"$@\"' \"$@\"; }",
                        "run");
}

#ifdef __x86_64__
TEST_F(Machine, OldProcessors) {
  if (kSanitized) GTEST_SKIP() << "sanitizers do not run in qemu";
  if (shell("command -v qemu-x86_64") != 0) GTEST_SKIP() << "no qemu-x86_64";
  const std::map<std::string, std::string> isas = {
      {"Conroe", "sse2"}, {"SandyBridge", "sse2"}, {"Haswell", "avx2"}};
  for (const auto& [processor, isa] : isas) {
    const std::string emulated = fmt::format(
        "run() {{ program=$(command -v \"$1\"); shift; qemu-x86_64 -cpu {} \"$program\" "
        "--in-process "
        "\"$@\" 2>/dev/null; }}",
        processor);
    expectOrdinaryResults(emulated, "run");
    const Results results = parseResults(readFile(file("r.json")), "r.json");
    EXPECT_EQ(isaName(results.cases[1].isa), isa) << processor;
  }
}
#endif

TEST_F(Machine, DecimalCommas) {
  if (shell("localedef -i de_DE -f UTF-8 ./de_DE.UTF-8") != 0) {
    GTEST_SKIP() << "no locale sources: " << readFile(file("shell.out"));
  }
  expectOrdinaryResults("export LOCPATH=\"$PWD\" LC_ALL=de_DE.UTF-8");
  ASSERT_EQ(shell("export LOCPATH=\"$PWD\" LC_ALL=de_DE.UTF-8; "
                  "broadmark --headless scene.aabbs --param kd:margin=0.5 --algorithm kd --quiet "
                  "--csv r.csv && broadmark compare r.json r.json"),
            0)
      << readFile(file("shell.out"));
  EXPECT_THAT(readFile(file("r.csv")), HasSubstr("margin=0.5"));
}

TEST_F(Machine, ClockGoesBackwards) {
  if (places::faultInjection().empty()) GTEST_SKIP() << "no faults can be injected";
  // LD_PRELOAD takes a name, because a space would end a path.
  const fs::path library = places::faultInjection();
  expectOrdinaryResults(
      fmt::format("export BROADMARK_FAULT='backwards 1' LD_PRELOAD='{}' LD_LIBRARY_PATH='{}'",
                  library.filename().string(), library.parent_path().string()));
}

TEST_F(Machine, OddNames) {
  const fs::path odd = file("it's \"quoted\"\n\\ $HOME `é` 日本");
  fs::create_directory(odd);
  fs::copy_file(file("scene.aabbs"), odd / "odd \"scène\"\n1.aabbs");
  const auto run_there = [&](Arguments arguments) {
    arguments.emplace_back("--quiet");
    const ProgramResult ended = Program(odd, arguments).wait();
    EXPECT_EQ(ended.status, 0) << ended.err;
  };
  run_there({"--headless", "odd \"scène\"\n1.aabbs", "--algorithm", kAlgorithms, "--json", "r.json",
             "--csv", "té \"st\"\n.csv"});
  EXPECT_THAT(essence(odd), Each(EndsWith(" ok")));
  run_there({"convert", "odd \"scène\"\n1.aabbs", "ü\n.broadmark"});
  run_there(
      {"bake", "--scenes", "brownian", "--objects", "20", "--frames", "2", "--output", "ö 'x'"});
  EXPECT_EQ(Program(odd, {"compare", "r.json", "r.json"}).wait().status, 0);
}

}  // namespace
}  // namespace broadmark::tests
