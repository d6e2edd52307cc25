#include "inspector/jobs/background_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadmark/error.h"
#include "broadmark/files.h"
#include "engine/helpers.h"
#include "support/child_program.h"

namespace broadmark::tests {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

TEST(RunProgram, KeepsWhatIsPrintedAndTheStatus) {
  const ProgramEnd end =
      runProgram({"sh", "-c", "echo $ONE; echo to stderr >&2; exit 3"}, {{"ONE", "first"}});
  EXPECT_EQ(end.status, 3);
  EXPECT_EQ(end.printed, "first\nto stderr\n");
  EXPECT_EQ(runProgram({"sh", "-c", "kill -9 $$"}).status, 128 + 9);
}

TEST(RunProgram, SaysThatThereIsNone) {
  EXPECT_TRUE(isProgramInPath("sh"));
  EXPECT_FALSE(isProgramInPath("no-such-program"));
  try {
    runProgram({"no-such-program"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no-such-program: cannot be started"));
  }
}

TEST(RunProgram, EndsWithAllThatItHasStarted) {
  EXPECT_THROW(
      runProgram({"sh", "-c", "sleep infinity & sleep infinity; :"}, {}, [] { return true; }),
      Cancelled);
}

TEST(PackageFolder, IsBesideTheSourceOrWhereItIsInstalled) {
  const TemporaryDirectory directory;
  const fs::path root = directory / "";
  const auto place = [&](const char* folder) {
    fs::create_directories(root / folder / "broadmark");
    writeTextFile(root / folder / "broadmark/__main__.py", "");
  };
  const fs::path built = root / "source/build/release/broadmark";
  const fs::path installed = root / "usr/bin/broadmark";
  EXPECT_EQ(packageFolder(built), "");
  place("source/python");
  EXPECT_EQ(packageFolder(built), root / "source/python");
  fs::create_directories(root / "usr/lib/python3/dist-packages");
  place("usr/lib/python3.11/dist-packages");
  EXPECT_EQ(packageFolder(installed), root / "usr/lib/python3.11/dist-packages");
}

TEST(BackgroundReport, SaysWhatIsWrong) {
  const TemporaryDirectory directory;
  BackgroundReport report;
  EXPECT_THROW(startReport(report, "results.json", directory / "none/page.html"), InputError);
  startReport(report, directory / "none.json", directory / "page.html");
  report.wait();
  EXPECT_TRUE(report.consumeFinished());
  EXPECT_EQ(report.report().state, TaskState::failed);
  EXPECT_THAT(report.report().failure, HasSubstr("no report page"));
  EXPECT_FALSE(fs::exists(directory / "page.html"));
}

// An untrusted folder may contain modules that Python would import first.
TEST(BackgroundReport, RunsNothingFromTheCurrentFolder) {
  const TemporaryDirectory directory;
  fs::create_directories(directory / "broadmark");
  writeTextFile(directory / "broadmark/__main__.py", "open('ran', 'w')");
  const fs::path before = fs::current_path();
  fs::current_path(directory / "");
  BackgroundReport report;
  startReport(report, directory / "none.json", directory / "page.html");
  report.wait();
  fs::current_path(before);
  EXPECT_FALSE(fs::exists(directory / "ran"));
}

TEST(OpenByDesktop, RefusesWhileAScriptIsPlayed) {
  const WriteSandbox sandbox(fs::current_path());
  EXPECT_THROW(openWithDesktop("page.html"), InputError);
}

}  // namespace
}  // namespace broadmark::tests
