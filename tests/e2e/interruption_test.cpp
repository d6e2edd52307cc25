// Ctrl-C, SIGKILL and a full disc: finished files remain, and unfinished ones are recognisable.

#include <fmt/format.h>
#include <sys/mount.h>

#include "e2e/end_to_end.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

using ::testing::AllOf;

/// Enough frames that every bake is still running when it is interrupted.
constexpr const char* kEndless = "1000000";

class Interruption : public EndToEnd {
 protected:
  [[nodiscard]] bool hasGrown(const fs::path& name) const {
    std::error_code missing;
    const auto size = fs::file_size(file(name), missing);
    return !missing && size > 304;
  }
};

const std::string kEndlessFile = recordingIn("out", "Brownian Cubes N100 F1000000frames");
const Arguments kEndlessBake = {"bake",     "--scenes", "brownian", "--objects", "100",
                                "--frames", kEndless,   "--output", "out",       "--quiet"};

TEST_F(Interruption, OfABakeLeavesNothingHalf) {
  for (const int signal : {SIGINT, SIGTERM}) {
    Program bake(directory_, kEndlessBake);
    ASSERT_TRUE(bake.waitUntil([&] { return hasGrown(kEndlessFile + ".part"); }));
    bake.signal(signal);
    const ProgramResult ended = bake.wait();
    EXPECT_EQ(ended.status, 130);
    EXPECT_EQ(linesOf(ended.err).size(), 1U) << ended.err;
    EXPECT_THAT(ended.err, StartsWith("broadmark: interrupted"));
    EXPECT_THAT(ended.out, StartsWith("0 baked, 0 kept, 1 not finished"));
    EXPECT_THAT(files(), IsEmpty());
  }
}

TEST_F(Interruption, TwoSignalsAtOnceAreOne) {
  Program bake(directory_, kEndlessBake);
  ASSERT_TRUE(bake.waitUntil([&] { return hasGrown(kEndlessFile + ".part"); }));
  bake.signal(SIGINT);
  bake.signal(SIGTERM);
  EXPECT_EQ(bake.wait().status, 130);
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(Interruption, OfABatchKeepsWhatIsBaked) {
  // Two threads: the endless bake starts first, the small ones run beside it.
  const Arguments call = {"bake", "--scenes", "freefall", "--objects", "2,3,5000", "--frames",
                          "1500", "--output", "out",      "--threads", "2"};
  const auto path = [](int n) {
    return recordingIn("out", fmt::format("FreeFall Cubes N{} F1500frames", n));
  };
  const auto baked = [&] { return fs::exists(file(path(2))) && fs::exists(file(path(3))); };
  for (const int signal : {SIGINT, SIGKILL}) {
    Program bake(directory_, call);
    ASSERT_TRUE(bake.waitUntil([&] {
      return baked() && fs::exists(file("out/Recordings_AABBs/FreeFall Cubes N2 F1500frames.json"));
    }));
    bake.signal(signal);
    const ProgramResult ended = bake.wait();
    if (signal == SIGKILL) continue;
    EXPECT_EQ(ended.status, 130);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("stopped at"), Not(HasSubstr("done"))));
    EXPECT_THAT(linesOf(ended.err).back(), StartsWith("broadmark: interrupted"));
    EXPECT_THAT(ended.out, HasSubstr("baked  " + path(3) + "\n"));
    EXPECT_THAT(linesOf(ended.out).back(), StartsWith("2 baked, 0 kept, 1 not finished; "));
    EXPECT_FALSE(fs::exists(file(path(5000) + ".part")));
  }
  EXPECT_FALSE(fs::exists(file(path(5000))));
  EXPECT_EQ(run({"verify", path(2), path(3)}).status, 0);

  // The same call resumes: it does not touch complete recordings.
  const auto long_ago = fs::last_write_time(file(path(3))) - std::chrono::hours(1);
  fs::last_write_time(file(path(3)), long_ago);
  fs::remove(file(path(5000) + ".part"));  // of the killed bake; the next one is waited for
  Program again(directory_, call);
  ASSERT_TRUE(again.waitUntil([&] { return hasGrown(path(5000) + ".part"); }));
  again.signal(SIGINT);
  const ProgramResult ended = again.wait();
  EXPECT_THAT(linesOf(ended.out), ElementsAre("kept   " + path(2), "kept   " + path(3),
                                              StartsWith("0 baked, 2 kept, 1 not finished; ")));
  EXPECT_EQ(fs::last_write_time(file(path(3))), long_ago);
}

TEST_F(Interruption, AKilledBakeLeavesNothingThatLooksWhole) {
  {
    Program bake(directory_, kEndlessBake);
    ASSERT_TRUE(bake.waitUntil([&] { return hasGrown(kEndlessFile + ".part"); }));
    bake.signal(SIGKILL);
    EXPECT_EQ(bake.wait().status, 128 + SIGKILL);
  }
  EXPECT_FALSE(fs::exists(file(kEndlessFile)));
  // The next bake replaces the partial file (enlarged here as a mark); its name is not locked.
  constexpr std::uintmax_t kMuch = std::uintmax_t{1} << 30;
  fs::resize_file(file(kEndlessFile + ".part"), kMuch);
  Program again(directory_, kEndlessBake);
  ASSERT_TRUE(again.waitUntil([&] {
    return hasGrown(kEndlessFile + ".part") && fs::file_size(file(kEndlessFile + ".part")) < kMuch;
  }));
  again.signal(SIGINT);
  EXPECT_EQ(again.wait().status, 130);
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(Interruption, TwoBakesOfOneNameExcludeEachOther) {
  Program first(directory_, kEndlessBake);
  ASSERT_TRUE(first.waitUntil([&] { return hasGrown(kEndlessFile + ".part"); }));
  const ProgramResult second = run(kEndlessBake);
  EXPECT_EQ(second.status, 2);
  EXPECT_THAT(second.err, HasSubstr("another process"));
  EXPECT_TRUE(first.isRunning());
  EXPECT_TRUE(fs::exists(file(kEndlessFile + ".part")));
}

TEST_F(Interruption, OfARunKeepsFinishedCases) {
  // The second recording's cases would take hours.
  Program run_of_two(directory_,
                     {"--headless", "freefall", "--objects", "10,2000", "--frames", "20",
                      "--algorithm", "bf,bf-mt", "--json", "results.json", "--repetitions", "1000",
                      "--filter", "(N10/.*/bf$)|(N2000/.*/bf-mt)", "--time-limit", "100"});
  // A slow run writes unfinished cases, too.
  const auto has_finished_case = [&] {
    if (!fs::exists(file("results.json"))) return false;
    const Json cases = readJson(file("results.json")).at("cases");
    return !cases.empty() && cases[0].at("frames").at("total").size() == 1000;
  };
  ASSERT_TRUE(run_of_two.waitUntil(has_finished_case));
  run_of_two.signal(SIGINT);
  const ProgramResult ended = run_of_two.wait();
  EXPECT_EQ(ended.status, 130);
  EXPECT_THAT(linesOf(ended.err).back(), StartsWith("broadmark: interrupted"));
  EXPECT_THAT(ended.out, HasSubstr("written: results.json"));
  const Json cases = readJson(file("results.json")).at("cases");
  ASSERT_GE(cases.size(), 1U);
  EXPECT_EQ(cases[0].at("recording").at("objects"), 10);
  EXPECT_EQ(cases[0].at("frames").at("total").size(), 1000U);
}

TEST_F(Interruption, OfARunsFirstSimulationWritesNothing) {
  Program endless(directory_, {"--headless", "brownian", "--objects", "100", "--frames", kEndless,
                               "--json", "results.json", "--record", "out", "--quiet"});
  ASSERT_TRUE(endless.waitUntil([&] { return hasGrown(kEndlessFile + ".part"); }));
  endless.signal(SIGINT);
  const ProgramResult ended = endless.wait();
  EXPECT_EQ(ended.status, 130);
  EXPECT_EQ(linesOf(ended.err).size(), 1U) << ended.err;
  EXPECT_THAT(ended.out, Not(HasSubstr("results.json")));
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(Interruption, OfADuelWritesNothing) {
  const std::string printing = places::unrulyPlugin() + ":unruly/deed=print";
  const Arguments duel = {"duel",        "freefall", "--objects",     "20",   "--frames", "20",
                          "bf",          printing,   "--max-seconds", "1000", "--json",   "d.json",
                          "--precision", "1e-9",     "--quiet"};
  Program endless(directory_, duel);
  ASSERT_TRUE(endless.waitForText("printed on purpose", 20));
  endless.signal(SIGINT);
  const ProgramResult ended = endless.wait();
  EXPECT_EQ(ended.status, 130);
  std::vector<std::string> complaints = linesOf(ended.err);
  std::erase(complaints, "printed on purpose");
  EXPECT_THAT(complaints, ElementsAre("broadmark: interrupted"));
  EXPECT_EQ(ended.out, "");
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(Interruption, OfAdviceBeforeTheFirstAnswerWritesNothing) {
  Program endless(directory_,
                  {"advise", "freefall", "--objects", "20", "--frames", "20", "--algorithm",
                   "bf,unruly", "--plugin", places::unrulyPlugin(), "--param", "deed=print",
                   "--max-seconds", "100000", "--json", "advice.json", "--quiet"});
  ASSERT_TRUE(endless.waitForText("printed on purpose", 20));
  endless.signal(SIGINT);
  const ProgramResult ended = endless.wait();
  EXPECT_EQ(ended.status, 130);
  EXPECT_THAT(ended.err, HasSubstr("broadmark: interrupted"));
  EXPECT_EQ(ended.out, "");
  EXPECT_THAT(files(), IsEmpty());
}

// The first case is saved although the second case of the same recording takes long.
TEST_F(Interruption, AKilledRunLosesNoFinishedCase) {
  Program two(directory_, {"--headless", "freefall", "--objects", "10", "--frames", "100",
                           "--algorithm", "sap,time-validator", "--param", "phase_us=200000",
                           "--time-limit", "100", "--jsonl", "results.jsonl", "--quiet"});
  const auto cases = [&] {
    std::size_t found = 0;
    for (const std::string& line : linesOf(readFile(file("results.jsonl")))) {
      found += line.starts_with("{\"case\"") ? 1 : 0;
    }
    return found;
  };
  ASSERT_TRUE(two.waitUntil([&] { return fs::exists(file("results.jsonl")) && cases() == 1; }));
  two.signal(SIGKILL);
  two.wait();
  const ProgramResult compared = run({"compare", "results.jsonl", "results.jsonl"});
  EXPECT_EQ(compared.status, 0) << compared.err;
  EXPECT_THAT(compared.out, HasSubstr("results.jsonl: partial"));
  EXPECT_THAT(linesOf(compared.out).back(), StartsWith("1 case: "));
}

TEST_F(Interruption, AKilledRunLeavesWholeResultsOrNone) {
  std::string counts = "1";
  for (int n = 2; n <= 120; ++n) counts += fmt::format(",{}", n);
  const auto cases = [&] { return readJson(file("results.json")).at("cases").size(); };
  for (const std::size_t finished : {1U, 2U, 5U, 20U}) {
    fs::remove(file("results.json"));
    Program many(directory_, {"--headless", "freefall", "--objects", counts, "--frames", "3",
                              "--json", "results.json", "--quiet", "--algorithm", "bf,sap"});
    ASSERT_TRUE(
        many.waitUntil([&] { return fs::exists(file("results.json")) && cases() >= finished; }));
    many.signal(SIGKILL);
    many.wait();
    EXPECT_GE(cases(), finished);
  }
}

class FullDisc : public EndToEnd {
 protected:
  /// Expects an error of one line that names the file, and no new files.
  void expectNoSpace(const Arguments& arguments, const std::vector<std::string>& words,
                     const ProgramEnvironment& around) const {
    const auto before = files();
    const ProgramResult ended = run(arguments, around);
    EXPECT_EQ(ended.status, 2);
    EXPECT_EQ(linesOf(ended.err).size(), 1U) << ended.err;
    for (const std::string& word : words) EXPECT_THAT(ended.err, HasSubstr(word));
    EXPECT_EQ(files(), before);
  }
};

// Without the OpenCL families: PoCL ends the program if it cannot store a kernel on a full disc.
const Arguments kLargeRun = {
    "--headless", "freefall", "--objects",         "2",      "--frames", "40", "--algorithm",
    "bf*,sap*",   "--json",   "disc/results.json", "--quiet"};
const Arguments kLargeBake = {"bake",     "--scenes", "freefall", "--objects", "200",
                              "--frames", "40",       "--output", "disc",      "--quiet"};

// A limit on the size of files simulates a full disc where mounting is not permitted.
TEST_F(FullDisc, AsALimitOnFiles) {
  fs::create_directory(file("disc"));
  const ProgramEnvironment small{.max_file_bytes = 8000};
  expectNoSpace(kLargeBake, {"FreeFall Cubes N200", "cannot write", "File too large"}, small);
  expectNoSpace(kLargeRun, {"disc/results.json", "cannot write", "File too large"}, small);
}

TEST_F(FullDisc, AsASmallFileSystem) {
  fs::create_directory(file("disc"));
  if (::mount("tmpfs", file("disc").c_str(), "tmpfs", 0, "size=16k") != 0) {
    GTEST_SKIP() << "cannot mount a file system: " << std::strerror(errno);
  }
  expectNoSpace(kLargeBake, {"disc", "bytes"}, {});
  expectNoSpace(kLargeRun, {"disc/results.json", "cannot write", "No space left"}, {});
  // Recordings simulated for a single run are in the temporary directory.
  expectNoSpace({"--headless", "freefall", "--objects", "200", "--frames", "40", "--algorithm",
                 "sap", "--quiet"},
                {"temporary", "No space left"},
                {.environment = {{"TMPDIR", file("disc").string()}}});
  EXPECT_EQ(::umount(file("disc").c_str()), 0);
}

}  // namespace
}  // namespace broadmark::tests
