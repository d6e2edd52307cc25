// Runs: checked and measured cases on recordings.

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <map>
#include <set>
#include <thread>

#include "broadmark/algorithms.h"
#include "broadmark/execution.h"
#include "e2e/end_to_end.h"

namespace broadmark::tests {
namespace {

class Run : public EndToEnd {
 protected:
  /// The cases of results.json.
  [[nodiscard]] Json cases() const { return readJson(file("results.json")).at("cases"); }

  /// Runs a small FreeFall scene with these further arguments, and returns its cases.
  [[nodiscard]] Json casesOf(const Arguments& more) const {
    Arguments arguments = {"--headless", "freefall", "--objects", "60",
                           "--frames",   "5",        "--json",    "results.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    runQuietly(arguments);
    return cases();
  }
};

/// The number of table lines marked as the fastest.
std::ptrdiff_t marks(const std::vector<std::string>& lines) {
  return std::ranges::count_if(lines,
                               [](const std::string& line) { return line.starts_with("* "); });
}

TEST_F(Run, MainJob) {
  const ProgramResult ended =
      run({"--headless", "freefall", "brownian", "gravity", "--objects", "80", "--frames", "6",
           "--check", "full", "--json", "results.json", "--csv", "results.csv", "--csv-frames",
           "frames.csv", "--record", "recordings"});
  ASSERT_EQ(ended.status, 0) << ended.out << ended.err;

  std::size_t algorithms = 0;
  for (const Algorithm& algorithm : builtinAlgorithms()) {
    if (!algorithm.traits.finds_pairs) continue;
    ++algorithms;
    EXPECT_THAT(ended.out, HasSubstr(" " + algorithm.id + " "));
  }
  EXPECT_EQ(marks(linesOf(ended.out)), 3) << ended.out;

  const Json results = readJson(file("results.json"));
  EXPECT_EQ(results.at("schema"), "broadmark-results/2");
  for (const char* key :
       {"cpu", "caches", "logical_cores", "physical_cores", "isa", "memory_bytes", "governor",
        "load_average", "os", "compiler", "compiler_flags", "build_type", "version", "started"}) {
    EXPECT_TRUE(results.at("environments").at(0).contains(key)) << key;
  }
  EXPECT_EQ(results.at("options").at(1), "freefall");
  ASSERT_EQ(results.at("cases").size(), 3 * algorithms);
  std::map<std::string, std::set<double>> pairs;  // by recording
  for (const Json& result : results.at("cases")) {
    SCOPED_TRACE(result.at("id"));
    for (const char* key : {"family", "isa", "threads", "params", "reason", "missed", "false",
                            "allowed_extra", "invalid", "differences", "peak_bytes", "summary"}) {
      EXPECT_TRUE(result.contains(key)) << key;
    }
    for (const char* key : {"name", "object_type", "objects", "frames", "seed", "hash", "source"}) {
      EXPECT_TRUE(result.at("recording").contains(key)) << key;
    }
    for (const char* key : {"seconds_per_frame", "median", "p95", "p99", "min", "stddev", "ci95"}) {
      EXPECT_TRUE(result.at("summary").contains(key)) << key;
    }
    EXPECT_EQ(result.at("status"), "ok");
    EXPECT_EQ(result.at("checked"), true);
    EXPECT_EQ(result.at("missed"), 0);
    EXPECT_EQ(result.at("false"), 0);
    EXPECT_EQ(result.at("recording").at("source").at("density"), "0.1");
    EXPECT_GT(result.at("summary").at("seconds_per_frame"), 0);
    for (const char* phase :
         {"update_objects", "clean_cache", "update_structures", "search_overlaps", "total"}) {
      ASSERT_EQ(result.at("frames").at(phase).size(), 1U);
      EXPECT_EQ(result.at("frames").at(phase).at(0).size(), 6U);
    }
    if (result.at("allowed_extra") == 0)
      pairs[result.at("recording").at("hash")].insert(result.at("pairs").at("mean").get<double>());
  }
  EXPECT_EQ(pairs.size(), 3U);
  for (const auto& [hash, means] : pairs) {
    EXPECT_EQ(means.size(), 1U) << hash;
    EXPECT_GT(*means.begin(), 0) << hash;
  }

  EXPECT_EQ(linesOf(readFile(file("results.csv"))).size(), 1 + 3 * algorithms);
  EXPECT_EQ(linesOf(readFile(file("frames.csv"))).size(), 1 + 3 * algorithms * 6);
  for (const std::string scene : {"FreeFall", "Brownian", "Gravity"}) {
    EXPECT_EQ(fs::file_size(file(recordingIn("recordings", scene + " Cubes N80 F6frames"))),
              304U + 32 * 80 * 7);
  }
}

TEST_F(Run, EventsOfEveryAlgorithm) {
  const auto of_pairs = casesOf({"--algorithm", "bf"});
  EXPECT_EQ(of_pairs.at(0).at("answer"), "pairs");
  for (const char* check : {"full", "hash"}) {
    // Not runQuietly(), because PoCL prints warnings when it builds kernels for the first time.
    const ProgramResult ended =
        run({"--headless", "freefall", "--objects", "60", "--frames", "5", "--answer", "events",
             "--check", check, "--repetitions", "1", "--json", "results.json"});
    ASSERT_EQ(ended.status, 0) << ended.out << ended.err;
    for (const Json& result : cases()) {
      SCOPED_TRACE(result.at("id").get<std::string>());
      EXPECT_EQ(result.at("answer"), "events");
      EXPECT_THAT(result.at("id").get<std::string>(), HasSubstr("/events"));
      EXPECT_THAT(result.at("status"), testing::AnyOf("ok", "unsupported"));
      EXPECT_EQ(result.at("checked"), true);
      EXPECT_LT(result.at("pairs").at("max"), of_pairs.at(0).at("pairs").at("max"));
    }
  }
}

TEST_F(Run, QueriesOfEachKind) {
  for (const std::string kind : {"boxes", "rays", "sweeps", "nearest"}) {
    runQuietly({"--headless", "freefall", "--objects", "60", "--frames", "5", "--queries",
                kind + ":40", "--repetitions", "1", "--json", "results.json"});
    std::set<double> hits;
    for (const Json& result : cases()) {
      SCOPED_TRACE(result.at("id").get<std::string>());
      EXPECT_EQ(result.at("answer"), kind + ":40");
      EXPECT_EQ(result.at("status"), "ok");
      EXPECT_EQ(result.at("checked"), true);
      hits.insert(result.at("pairs").at("mean").get<double>());
    }
    EXPECT_GE(cases().size(), 4U) << kind;
    // All rays and distances of this scene are far from the limits of rounding.
    EXPECT_EQ(hits.size(), 1U) << kind;
    EXPECT_GT(*hits.begin(), 0) << kind;
  }
}

TEST_F(Run, RefusesQueriesThatItCannotAnswer) {
  const auto error = [&](const std::vector<std::string>& words) {
    std::vector<std::string> all = {"--headless", "freefall", "--objects", "20", "--frames", "2"};
    all.insert(all.end(), words.begin(), words.end());
    const ProgramResult ended = run(all);
    EXPECT_EQ(ended.status, 2) << ended.out;
    return ended.err;
  };
  EXPECT_THAT(error({"--queries", "rays"}), HasSubstr("KIND:N is expected"));
  EXPECT_THAT(error({"--queries", "rays:9", "--answer", "events"}),
              HasSubstr("--answer: cannot be combined with --queries"));
  run({"--headless", "freefall", "--objects", "20", "--frames", "2", "--queries", "rays:9",
       "--algorithm", "bf,kd", "--json", "results.json"});
  EXPECT_EQ(cases().at(0).at("status"), "ok");
  EXPECT_EQ(cases().at(1).at("reason"), "does not answer queries of the kind rays");
}

TEST_F(Run, ARecordingGivesTheSameAnswersAsItsSimulation) {
  const Json simulated = casesOf({"--record", "kept", "--algorithm", "sap"});
  runQuietly({"--headless", recordingIn("kept", "FreeFall Cubes N60 F5frames"), "--algorithm",
              "sap", "--json", "results.json"});
  const Json replayed = cases();
  EXPECT_EQ(replayed[0].at("pairs"), simulated[0].at("pairs"));
  EXPECT_EQ(replayed[0].at("recording").at("hash"), simulated[0].at("recording").at("hash"));
  EXPECT_EQ(replayed[0].at("recording").at("source"),
            recordingIn("kept", "FreeFall Cubes N60 F5frames"));
}

TEST_F(Run, FewBodies) {
  const ProgramResult ended = run({"--headless", "freefall", "--objects", "2,0,1,1", "--frames",
                                   "3", "--json", "results.json"});
  ASSERT_EQ(ended.status, 0) << ended.out << ended.err;
  std::set<int> counts;
  std::set<std::string> ids;
  for (const Json& result : cases()) {
    EXPECT_EQ(result.at("status"), "ok") << result.at("id");
    counts.insert(result.at("recording").at("objects").get<int>());
    EXPECT_TRUE(ids.insert(result.at("id")).second) << "twice: " << result.at("id");
  }
  EXPECT_EQ(counts, (std::set{0, 1, 2}));
}

TEST_F(Run, ARecordingWithoutFramesIsNothingToRun) {
  writeFile(file("still.aabbs"), recordingOf(2, 0, unitBoxes(2)));
  expectRefusal({"--headless", "still.aabbs", "--algorithm", "sap"},
                {"still.aabbs", "nothing to run"});
}

TEST_F(Run, SelfChecksStandLastAndAreNeverTheFastest) {
  const ProgramResult ended =
      runQuietly({"--headless", "freefall", "--objects", "60", "--frames", "3", "--algorithm",
                  "time-validator,none,sap,bf", "--param", "phase_us=1"});
  const auto lines = linesOf(ended.out);
  ASSERT_EQ(marks(lines), 1) << ended.out;
  const auto row = [&](const std::string& id) {
    return std::ranges::find_if(lines, [&](const std::string& line) {
      return line.find("  " + id + " ") != std::string::npos;
    });
  };
  for (const char* check : {"none", "time-validator"}) {
    ASSERT_NE(row(check), lines.end()) << ended.out;
    EXPECT_LT(row("sap"), row(check)) << ended.out;
  }
}

TEST_F(Run, ARequestRunsWhatItsCommandLineDoes) {
  const Arguments given = {"--headless", "freefall",    "--objects", "20,30",         "--frames",
                           "3",          "--algorithm", "sap,kd",    "--repetitions", "2"};
  Arguments writing = given;
  writing.insert(writing.end(), {"--write-request", "run.json"});
  EXPECT_THAT(runQuietly(writing).out, IsEmpty());
  EXPECT_THAT(files(), testing::ElementsAre("run.json")) << "nothing was run";
  runQuietly({"--headless", "--request", "run.json", "--json", "r.json"});
  const Json results = readJson(file("r.json"));
  std::vector<std::string> ids;
  for (const Json& result : results.at("cases")) {
    ids.push_back(result.at("id"));
    EXPECT_EQ(result.at("frames").at("total").size(), 2U);
  }
  Arguments listing = given;
  listing.emplace_back("--list");
  EXPECT_EQ(ids, linesOf(runQuietly(listing).out));
  ASSERT_EQ(shell("broadmark --headless --request - --list <run.json"), 0);
  EXPECT_EQ(linesOf(readFile(file("shell.out"))), ids) << "from standard input";
}

TEST_F(Run, RepetitionsAndWarmup) {
  const Json done = casesOf({"--algorithm", "sap,bf", "--repetitions", "3", "--warmup", "1"});
  for (const Json& result : done) {
    EXPECT_EQ(result.at("frames").at("total").size(), 3U);
    EXPECT_EQ(result.at("initialize_ns").size(), 3U);
    EXPECT_EQ(result.at("summary").at("ci95").size(), 2U);
  }
}

TEST_F(Run, ThreadsMakeCasesOfParallelVariantsOnly) {
  const Json done = casesOf({"--algorithm", "sap,sap-mt", "--threads", "1,2,2"});
  ASSERT_EQ(done.size(), 3U);
  EXPECT_EQ(done[0].at("threads"), 1);
  EXPECT_EQ(done[1].at("threads"), 1);
  EXPECT_EQ(done[2].at("threads"), 2);
  EXPECT_EQ(done[1].at("pairs"), done[2].at("pairs"));
}

TEST_F(Run, EveryInstructionSetIsRightOrUnsupported) {
  const Json done = casesOf({"--algorithm", "sap-simd,bf-simd", "--isa",
                             fmt::format("{}", fmt::join(kIsas.names(), ","))});
  ASSERT_EQ(done.size(), 2 * kIsas.entries.size());
  for (const Json& result : done) {
    const auto isa = kIsas.find(result.at("isa").get<std::string>());
    ASSERT_TRUE(isa);
    EXPECT_EQ(result.at("status"), isaSupported(*isa) ? "ok" : "unsupported") << result.at("id");
    EXPECT_EQ(result.at("reason") == "", isaSupported(*isa));
  }
}

TEST_F(Run, CheckModes) {
  for (const Json& result : casesOf({"--check", "hash"})) {
    EXPECT_EQ(result.at("status"), "ok") << result.at("id");
    EXPECT_EQ(result.at("checked"), true);
  }
  for (const Json& result : casesOf({"--check", "off"})) EXPECT_EQ(result.at("checked"), false);
}

TEST_F(Run, MemoryIsMeasured) {
  for (const Json& result : casesOf({"--algorithm", "sap,sap-mt"})) {
    EXPECT_TRUE(result.at("peak_bytes").is_number_unsigned()) << result.at("id");
    EXPECT_FALSE(result.contains("ageing"));  // of a few frames
  }
  const fs::path output = file("ageing.json");
  ASSERT_EQ(run({"--headless", "fountain", "--objects", "20000", "--frames", "100", "--algorithm",
                 "kd", "--check", "off", "--json", output.string()})
                .status,
            0);
  const Json ageing = readJson(output).at("cases").at(0).at("ageing");
  for (const char* const when : {"early", "late"}) {
    // At least two arrays with a float per body, at most a hundred.
    EXPECT_GT(ageing.at(when).at("private_bytes").get<double>(), 20000 * 8) << when;
    EXPECT_LT(ageing.at(when).at("private_bytes").get<double>(), 20000 * 400) << when;
    EXPECT_GT(ageing.at(when).size(), 2U) << when;
  }
}

TEST_F(Run, ParametersReachTheAlgorithmAndItsId) {
  const Json done = casesOf({"--algorithm", "time-validator", "--param", "phase_us=2000"});
  ASSERT_EQ(done.size(), 1U);
  EXPECT_THAT(done[0].at("id"), HasSubstr("phase_us=2000"));
  EXPECT_EQ(done[0].at("params").at("phase_us"), "2000");
  EXPECT_GE(done[0].at("summary").at("min"), 0.002);
}

TEST_F(Run, AlgorithmsAreChosen) {
  const Json done = casesOf({"--algorithm", "BF_SSE,sap-m*"});
  ASSERT_EQ(done.size(), 2U);
  EXPECT_THAT(done[0].at("id"), HasSubstr("bf-simd/sse2"));
  EXPECT_EQ(done[1].at("algorithm"), "sap-mt");
}

TEST_F(Run, ListPrintsTheCasesAndRunsNothing) {
  const Arguments call = {"--headless", "freefall", "--objects", "60",     "--frames",
                          "5",          "--list",   "--json",    "no.json"};
  const ProgramResult listed = run(call);
  EXPECT_EQ(listed.status, 0);
  EXPECT_EQ(listed.err, "");
  EXPECT_THAT(entries(), IsEmpty());

  std::vector<std::string> ids;
  for (const Json& result : casesOf({})) ids.push_back(result.at("id"));
  EXPECT_EQ(linesOf(listed.out), ids);
}

TEST_F(Run, ShardsDivideTheCases) {
  const auto list = [&](Arguments more) {
    Arguments call = {"--headless", "freefall", "--objects",  "9,8",
                      "--list",     "--isa",    "scalar,sse2"};
    call.insert(call.end(), more.begin(), more.end());
    return linesOf(run(call).out);
  };
  std::vector<std::string> divided;
  for (const char* shard : {"0/3", "1/3", "2/3"}) {
    const auto part = list({"--shard", shard});
    EXPECT_FALSE(part.empty());
    divided.insert(divided.end(), part.begin(), part.end());
  }
  EXPECT_THAT(divided, ::testing::UnorderedElementsAreArray(list({})));
  EXPECT_EQ(std::set(divided.begin(), divided.end()).size(), divided.size());
}

TEST_F(Run, FilterChoosesByCaseId) {
  const Json done = casesOf({"--filter", "/sap(-mt/t2)?$", "--threads", "2"});
  ASSERT_EQ(done.size(), 2U);
  EXPECT_EQ(done[0].at("algorithm"), "sap");
  EXPECT_EQ(done[1].at("algorithm"), "sap-mt");
}

TEST_F(Run, ResultsMayGoToStandardOutputAndNothingElseThen) {
  const Arguments call = {"--headless", "freefall", "--objects",   "9,20",  "--frames",
                          "3",          "--quiet",  "--algorithm", "bf,sap"};
  const auto printed = [&](const Arguments& more) {
    Arguments arguments = call;
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult ended = run(arguments);
    EXPECT_EQ(ended.status, 0) << ended.err;
    return ended;
  };
  for (const char* output : {"-", "/dev/stdout"}) {
    const Json results = Json::parse(printed({"--json", output}).out, nullptr, false);
    ASSERT_TRUE(results.is_object()) << output;
    EXPECT_EQ(results.at("cases").size(), 4U);
  }
  const ProgramResult csv = printed({"--csv", "-", "--json", "results.json"});
  EXPECT_EQ(linesOf(csv.out).size(), 5U) << csv.out;
  EXPECT_THAT(csv.err, HasSubstr("written: results.json"));
  EXPECT_EQ(linesOf(printed({"--csv-frames", "-"}).out).size(), 1U + 4 * 3);
  EXPECT_EQ(files(), std::set<std::string>{"results.json"});

  Arguments twice = call;
  twice.insert(twice.end(), {"--json", "-", "--csv", "-"});
  expectRefusal(twice, {"--csv", "--json", "-"});
}

TEST_F(Run, ProgressSpeaksUnlessQuiet) {
  const Arguments call = {"--headless", "freefall", "--objects", "20", "--frames", "3"};
  EXPECT_THAT(run(call).err, HasSubstr("running FreeFall N20"));
  runQuietly(call);
}

TEST_F(Run, TheTimeLimitStopsACaseAndSparesItLargerScenes) {
  const Arguments call = {"--headless",   "freefall", "--objects",   "40,20,30",
                          "--frames",     "5",        "--algorithm", "bf",
                          "--time-limit", "1e-12",    "--json",      "results.json"};
  const ProgramResult ended = run(call);
  EXPECT_EQ(ended.status, 4) << ended.err;
  const Json done = cases();
  ASSERT_EQ(done.size(), 3U);
  EXPECT_EQ(done[0].at("recording").at("objects"), 20);
  EXPECT_EQ(done[0].at("frames").at("total").at(0).size(), 3U);
  for (const Json& result : done) EXPECT_EQ(result.at("status"), "timeout");
  for (const std::size_t larger : {1U, 2U}) {
    EXPECT_THAT(done[larger].at("reason"), HasSubstr("not run"));
    EXPECT_THAT(done[larger].at("reason"), HasSubstr("20 bodies"));
  }
  EXPECT_EQ(marks(linesOf(ended.out)), 0);

  // A time limit exceeded on purpose is no failure, but the cases are timeouts.
  Arguments on_purpose = call;
  on_purpose.emplace_back("--allow-timeout");
  const ProgramResult allowed = run(on_purpose);
  EXPECT_EQ(allowed.status, 0) << allowed.err;
  EXPECT_THAT(allowed.out, HasSubstr("timeout"));
  for (const Json& result : cases()) EXPECT_EQ(result.at("status"), "timeout");
}

TEST_F(Run, PinsThreadsWhereTheyFit) {
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  const Arguments call = {"--algorithm", "bf,bf-mt", "--threads", fmt::format("{}", cores + 1)};
  Arguments pinned = call;
  pinned.emplace_back("--pin");
  for (const Json& result : casesOf(pinned)) {
    EXPECT_EQ(result.at("conditions").at("pinned"), result.at("threads") == 1);
  }
  for (const Json& result : casesOf(call)) {
    EXPECT_EQ(result.at("conditions").at("pinned"), false);
  }
  expectRefusal({"--headless", "freefall", "--pin", "--in-process"}, {"--pin", "--in-process"});
}

TEST_F(Run, WarnsOnceOfWhatDisturbsTimes) {
  const ProgramResult ended =
      run({"--headless", "freefall", "brownian", "--objects", "20", "--frames", "2", "--algorithm",
           "bf-mt,sap-mt", "--threads", "500", "--quiet", "--json", "results.json"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  const auto tells = [](const std::string& warning) {
    return warning.find("500 threads share") != std::string::npos;
  };
  EXPECT_EQ(std::ranges::count_if(ended.warnings, tells), 1);
  ASSERT_EQ(cases().size(), 4U);
  for (const Json& result : cases()) {
    const auto warnings = result.at("conditions").at("warnings").get<std::vector<std::string>>();
    EXPECT_EQ(std::ranges::count_if(warnings, tells), 1);
    EXPECT_LE(warnings.size(), ended.warnings.size());
  }
}

TEST_F(Run, SaysWhichMeansAreNotPrecise) {
  const auto imprecise = [&](const std::string& precision) {
    const ProgramResult ended =
        run({"--headless", "freefall", "--objects", "20", "--frames", "5", "--algorithm", "sap,bf",
             "--repetitions", "auto", "--precision", precision, "--max-seconds", "0.001", "--quiet",
             "--json", "results.json"});
    EXPECT_EQ(ended.status, 0) << ended.err;
    const auto tells = [](const std::string& warning) {
      return warning.find("not reached") != std::string::npos;
    };
    for (const Json& result : cases()) {
      const auto own = result.at("conditions").at("warnings").get<std::vector<std::string>>();
      EXPECT_EQ(std::ranges::count_if(own, tells), precision == "0.0001%" ? 1 : 0);
    }
    return std::ranges::count_if(ended.warnings, tells);
  };
  EXPECT_EQ(imprecise("0.0001%"), 2);
  EXPECT_EQ(imprecise("100000%"), 0);
}

TEST_F(Run, CountsOfTheProcessorAreThereOrNull) {
  for (const Arguments& where : {Arguments{}, Arguments{"--in-process"}}) {
    Arguments call = {"--algorithm", "bf", "--repetitions", "2"};
    call.insert(call.end(), where.begin(), where.end());
    const Json processor = casesOf(call).at(0).at("processor");
    for (const char* name :
         {"cycles", "instructions", "cache_misses", "branches", "branch_misses"}) {
      ASSERT_EQ(processor.at(name).size(), 2U);
      for (const Json& count : processor.at(name)) {
        EXPECT_TRUE(count.is_null() || count.is_number_unsigned()) << name << ": " << count;
      }
    }
  }
}

TEST_F(Run, AutomaticRepetitionsAreWholeAndInTheOrderOfThePlan) {
  const Json once = casesOf({"--algorithm", "bf,sap,kd"});
  const Json often = casesOf({"--algorithm", "bf,sap,kd", "--repetitions", "auto", "--precision",
                              "1000%", "--warmup", "1"});
  ASSERT_EQ(often.size(), 3U);
  for (std::size_t i = 0; i < often.size(); ++i) {
    EXPECT_EQ(often[i].at("id"), once[i].at("id"));
    EXPECT_EQ(often[i].at("initialize_ns").size(), often[i].at("conditions").at("repetitions"));
    EXPECT_GE(often[i].at("initialize_ns").size(), 5U);
  }
}

}  // namespace
}  // namespace broadmark::tests
