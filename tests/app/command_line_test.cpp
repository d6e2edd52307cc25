// Accepted and rejected command lines. Nothing is run.

#include "commands/command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "command_line/option_types.h"
#include "engine/helpers.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using Arguments = std::vector<std::string>;

/// The options of a headless session on FreeFall with these further arguments.
SessionOptions session(const Arguments& more = {}) {
  Arguments arguments = {"--headless", "freefall"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return parseSession(arguments);
}

/// The error message for a command line must be one line that contains all of these words.
void expectRefused(const Arguments& arguments, const Arguments& words) {
  SCOPED_TRACE(testing::PrintToString(arguments));
  const std::string message = inputErrorOf([&] { parseCommandLine(arguments); });
  for (const std::string& word : words) EXPECT_THAT(message, HasSubstr(word));
  EXPECT_THAT(message, Not(HasSubstr("\n")));
}

void expectSessionRefused(const Arguments& more, const Arguments& words) {
  Arguments arguments = {"--headless", "freefall"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  expectRefused(arguments, words);
}

TEST(Session, Defaults) {
  const SessionOptions options = session();
  EXPECT_THAT(options.sources, ElementsAre("freefall"));
  EXPECT_TRUE(options.headless);
  EXPECT_FALSE(options.inspector());
  EXPECT_THAT(options.scene.objects, IsEmpty());
  EXPECT_THAT(options.scene.parameters, IsEmpty());
  EXPECT_THAT(options.scene.recorders, IsEmpty());
  EXPECT_THAT(options.cases.algorithms, IsEmpty());
  EXPECT_EQ(options.repetitions.max_count, 1);
  EXPECT_EQ(options.repetitions.warmup, 0);
  EXPECT_EQ(options.policy.check, CheckMode::full);
  EXPECT_EQ(options.policy.frame_limit_seconds, 0.5);
  EXPECT_THAT(options.outputs, IsEmpty());
  EXPECT_EQ(options.picture.width, 1280);
  EXPECT_EQ(options.picture.height, 720);
  EXPECT_FALSE(options.frame);
  EXPECT_EQ(options.shard.count, 1);
}

TEST(Session, ListsMayBeDividedByCommasAndRepeated) {
  const SessionOptions options =
      session({"--objects", "30,10", "--objects", "20,10", "--object-type", "cubes,spheres",
               "--algorithm", "bf,,sap*", "--algorithm", "KD", "--threads", "4,1", "--isa",
               "sse2,auto", "--recorder", "posrot,aabbs,posrot", "--record", "directory"});
  EXPECT_THAT(options.scene.objects, ElementsAre(10, 20, 30)) << "ascending, each once";
  EXPECT_THAT(options.scene.object_types, ElementsAre("cubes", "spheres"));
  EXPECT_THAT(options.cases.algorithms, ElementsAre("bf", "sap*", "KD"));
  EXPECT_THAT(options.cases.threads, ElementsAre(1, 4)) << "by size";
  EXPECT_THAT(options.cases.isas, ElementsAre(Isa::sse2, bestIsa()));
  EXPECT_THAT(options.scene.recorders, ElementsAre("posrot", "aabbs"));
}

TEST(Session, AnOptionsValueIsNoSource) {
  EXPECT_THAT(parseSession({"--headless", "--objects", "5", "freefall", "brownian"}).sources,
              ElementsAre("freefall", "brownian"));
}

TEST(Session, ParametersKeepTheirCommas) {
  const SessionOptions options =
      session({"--param", "a=1,2", "--param", "b=x=y", "--param", "c=", "--frames", "7", "--seed=3",
               "--density", "0.5", "--engine", "ode", "--input", "there"});
  EXPECT_EQ(options.parameters, (ParameterValues{{"a", "1,2"}, {"b", "x=y"}, {"c", ""}}));
  EXPECT_EQ(options.scene.parameters, (ParameterValues{{"frames", "7"},
                                                       {"seed", "3"},
                                                       {"density", "0.5"},
                                                       {"engine", "ode"},
                                                       {"input", "there"}}));
}

TEST(Session, OptionsOfScenesMayHaveSeveralValues) {
  const SessionOptions options = session({"--seed", "2,1", "--seed", "3", "--engine", "ode,bullet",
                                          "--input", "a,b", "--param", "kd:margin=1,2"});
  EXPECT_EQ(options.scene.parameters,
            (ParameterValues{{"seed", "2,1,3"}, {"engine", "ode,bullet"}, {"input", "a,b"}}));
  EXPECT_EQ(options.parameters, (ParameterValues{{"kd:margin", "1,2"}}));
}

TEST(Session, ValuesAreUnderstood) {
  const SessionOptions options = session({"--repetitions",
                                          "5",
                                          "--warmup",
                                          "2",
                                          "--time-limit",
                                          "1e-3",
                                          "--check",
                                          "hash",
                                          "--frame",
                                          "0",
                                          "--size",
                                          "16x9",
                                          "--gl",
                                          "egl",
                                          "--shard",
                                          "1/4",
                                          "--json",
                                          "r",
                                          "--csv",
                                          "c",
                                          "--filter",
                                          "x.*",
                                          "--device",
                                          "pocl",
                                          "--answer",
                                          "events",
                                          "--plugin",
                                          "p",
                                          "--plugin",
                                          "q",
                                          "--record",
                                          "dir",
                                          "--screenshot",
                                          "s.png",
                                          "--quiet",
                                          "--hard-limit",
                                          "2.5",
                                          "--memory-limit",
                                          "0.5"});
  EXPECT_EQ(options.repetitions.max_count, 5);
  EXPECT_EQ(options.repetitions.warmup, 2);
  EXPECT_EQ(options.policy.frame_limit_seconds, 1e-3);
  EXPECT_EQ(options.policy.check, CheckMode::hash);
  EXPECT_EQ(options.frame, 0U);
  EXPECT_EQ(options.picture.width, 16);
  EXPECT_EQ(options.picture.height, 9);
  EXPECT_EQ(options.picture.gl, GlSource::egl);
  EXPECT_EQ(options.shard.index, 1);
  EXPECT_EQ(options.shard.count, 4);
  EXPECT_EQ(options.outputs.size(), 2U);
  EXPECT_EQ(options.outputs.at("json"), "r");
  EXPECT_EQ(options.filter, "x.*");
  EXPECT_EQ(options.cases.device, "pocl");
  EXPECT_EQ(options.cases.answer, AnswerKind::events);
  EXPECT_THAT(options.plugins, ElementsAre("p", "q"));
  EXPECT_FALSE(options.hosts.in_process);
  EXPECT_EQ(options.hosts.hard_limit_seconds, 2.5);
  EXPECT_EQ(options.hosts.memory_limit_gib, 0.5);
  EXPECT_TRUE(options.quiet);
}

TEST(Session, AutomaticRepetitions) {
  const SessionOptions options = session(
      {"--repetitions", "auto", "--precision", "1%", "--max-seconds", "60", "--order-seed", "7"});
  EXPECT_TRUE(options.repetitions.until_precise);
  EXPECT_EQ(options.repetitions.max_count, RepetitionOptions::kMaxUntilPrecise);
  EXPECT_EQ(options.repetitions.precision, 0.01);
  EXPECT_EQ(options.repetitions.max_seconds, 60);
  EXPECT_EQ(options.repetitions.order_seed, 7U);
  EXPECT_FALSE(session({}).repetitions.until_precise);
}

TEST(Session, FormerNamesAreAccepted) {
  const SessionOptions options = session({"--repetitions", "auto", "--most-seconds=60", "--param",
                                          "tide:from_scratch_cost=50", "--param", "crowded=7"});
  EXPECT_EQ(options.repetitions.max_seconds, 60);
  EXPECT_EQ(options.parameters,
            (ParameterValues{{"tide:full_search_cost_scale", "50"}, {"split_threshold", "7"}}));
}

TEST(Session, NumbersOutOfRangeAreNamed) {
  for (const char* count : {"-1", "0x", "1e99", "abc", "99999999999", "1.5", "10000001"}) {
    expectSessionRefused({"--objects", count}, {"--objects", count});
  }
  for (const char* threads : {"0", "1025", "two", "1.5"}) {
    expectSessionRefused({"--threads", threads}, {"--threads", threads});
    expectRefused({"bake", "--output", "o", "--threads", threads}, {"--threads", threads});
  }
  for (const char* limit : {"0", "-1", "nan", "inf", "1s", ""}) {
    expectSessionRefused({std::string("--time-limit=") + limit}, {"--time-limit", limit});
  }
  for (const char* share : {"-0.1", "nan", "inf", "x"}) {
    expectRefused({"compare", "a", "b", std::string("--fail-above=") + share},
                  {"--fail-above", share});
  }
  expectSessionRefused({"--repetitions", "0"}, {"--repetitions", "'0'"});
  expectSessionRefused({"--repetitions", "x"}, {"--repetitions", "'x'"});
  expectSessionRefused({"--precision", "1%"}, {"--precision", "--repetitions auto"});
  expectSessionRefused({"--max-seconds", "9", "--repetitions", "5"},
                       {"--max-seconds", "--repetitions auto"});
  expectSessionRefused({"--repetitions", "auto", "--precision", "0"}, {"--precision", "'0'"});
  expectSessionRefused({"--warmup", "-1"}, {"--warmup", "'-1'"});
  expectSessionRefused({"--frame", "-1"}, {"--frame", "'-1'"});
  expectSessionRefused({"--size", "640"}, {"--size", "'640'", "WxH"});
  expectSessionRefused({"--size", "0x5"}, {"--size", "'0'"});
  expectSessionRefused({"--size", "5x99999"}, {"--size", "'99999'"});
  expectSessionRefused({"--shard", "4/4"}, {"--shard", "'4'"});
  expectSessionRefused({"--shard", "0/0"}, {"--shard", "'0'"});
  expectSessionRefused({"--shard", "1"}, {"--shard", "'1'", "I/N"});
  expectRefused({"bake", "--output", "o", "--movie", "m", "--movie-every", "0"},
                {"--movie-every", "'0'"});
}

TEST(Session, UnknownNamesAreSuggested) {
  expectSessionRefused({"--algoritm", "sap"}, {"'--algoritm'", "'--algorithm'"});
  expectSessionRefused({"--shards=0/1"}, {"'--shards'", "'--shard'"});
  expectSessionRefused({"--zzzzzzzzzzzz"}, {"'--zzzzzzzzzzzz'", "--help"});
  expectSessionRefused({"-x"}, {"'-x'"});
  expectSessionRefused({"--isa", "avx3"}, {"--isa", "'avx3'", "'avx2'"});
  expectSessionRefused({"--check", "ful"}, {"--check", "'ful'", "'full'"});
  expectSessionRefused({"--gl", "egll"}, {"--gl", "'egll'", "'egl'"});
  expectSessionRefused({"--recorder", "posrat"}, {"--recorder", "'posrat'", "'posrot'"});
  expectSessionRefused({"--param", "friction"}, {"--param", "'friction'", "KEY=VALUE"});
  expectSessionRefused({"--param", "=5"}, {"--param", "'=5'"});
  expectSessionRefused({"--param", ":margin=5"}, {"--param", "':margin=5'", "ALGORITHM:KEY=VALUE"});
  expectSessionRefused({"--param", "kd:=5"}, {"--param", "'kd:=5'"});
  expectSessionRefused({"--param", "kd:a=1", "--param", "kd:a=2"}, {"'kd:a'", "twice"});
  expectSessionRefused({"--param", "a=1", "--param", "a=2"}, {"--param", "'a'", "twice"});
  expectSessionRefused({"--objects", ""}, {"--objects", "is an empty list"});
  expectSessionRefused({"--algorithm", ","}, {"--algorithm", "','"});
  expectSessionRefused({"--screenshot", "a.txt"}, {"--screenshot", "'a.txt'", ".png"});
  expectRefused({"bake", "--thread", "2", "--output", "o"}, {"bake", "'--threads'"});
  expectRefused({"verify", "--descrbe", "a"}, {"verify", "'--describe'"});
  expectRefused({"compare", "a", "b", "--fail-abov", "1"}, {"compare", "'--fail-above'"});
  expectRefused({"verfy", "a.aabbs"}, {"'verfy'", "'verify'"});
  expectRefused({"--headless", "lst"}, {"'lst'", "'list'"});
}

TEST(Session, MissingPartsAreNamed) {
  expectRefused({"--headless"}, {"no source", "freefall", ".aabbs", "broadmark-scene/1"});
  expectRefused({"bake"}, {"bake", "--output"});
  expectRefused({"verify"}, {"verify", "no FILE"});
  expectRefused({"compare"}, {"compare", "A"});
  expectRefused({"bake", "freefall", "--output", "o"}, {"bake", "'freefall'"});
  expectSessionRefused({"--json"}, {"--json"});
  expectRefused({"verify", "a", "--json", "b"}, {"--json", "--describe"});
  expectRefused({"bake", "--output", "o", "--movie-every", "2"}, {"--movie-every", "--movie"});
  expectRefused({"bake", "--output", "o", "--size", "2x2"}, {"--size", "--movie"});
}

TEST(Session, OptionsBeforeACommandAreRefused) {
  expectRefused({"--objects", "5", "bake", "--output", "o"}, {"--objects", "'bake'"});
  expectRefused({"--headless", "list"}, {"--headless", "'list'"});
}

TEST(Session, ACaseOfResultsStatesItself) {
  EXPECT_EQ(parseSession({"--headless", "r.json", "--case", "x"}).case_id, "x");
  for (const Arguments& stated :
       {Arguments{"--algorithm", "sap"}, Arguments{"--threads", "1"}, Arguments{"--isa", "sse2"},
        Arguments{"--device", "0"}, Arguments{"--answer", "events"}, Arguments{"--objects", "5"},
        Arguments{"--object-type", "a"}, Arguments{"--frames", "5"}, Arguments{"--seed", "2"},
        Arguments{"--density", "1"}, Arguments{"--engine", "ode"}, Arguments{"--input", "a"},
        Arguments{"--param", "a=b"}, Arguments{"--filter", "x"}, Arguments{"--shard", "0/2"}}) {
    expectRefused({"--headless", "r.json", "--case", "x", stated[0], stated[1]},
                  {"--case", stated[0]});
  }
  expectRefused({"--headless", "--case", "x"}, {"--case", "results file"});
  expectRefused({"--headless", "a.json", "b.json", "--case", "x"}, {"--case", "one"});
}

TEST(Session, ExportingACaseWritesNothingElse) {
  const Arguments exporting = {"--headless", "r.json", "--case", "x", "--export-case", "a.aabbs"};
  EXPECT_EQ(parseSession(exporting).export_case, "a.aabbs");
  for (const Arguments& lost :
       {Arguments{"--json", "j"}, Arguments{"--csv", "c"}, Arguments{"--csv-frames", "c"},
        Arguments{"--record", "d"}, Arguments{"--screenshot", "s.png"}, Arguments{"--list"}}) {
    Arguments arguments = exporting;
    arguments.insert(arguments.end(), lost.begin(), lost.end());
    expectRefused(arguments, {"--export-case", lost[0]});
  }
  expectRefused({"--headless", "freefall", "--export-case", "a.aabbs"},
                {"--export-case", "--case"});
}

TEST(Session, TheInspectorRefusesWhatItWouldNotUse) {
  for (const Arguments& lost :
       {Arguments{"--repetitions", "2"}, Arguments{"--warmup", "2"}, Arguments{"--time-limit", "1"},
        Arguments{"--record", "d"}, Arguments{"--shard", "0/2"}, Arguments{"--filter", "x"},
        Arguments{"--list"}, Arguments{"--allow-timeout"}, Arguments{"--print-pairs"},
        Arguments{"--json", "j"}, Arguments{"--csv", "c"}, Arguments{"--csv-frames", "c"}}) {
    Arguments window = {"freefall"};
    window.insert(window.end(), lost.begin(), lost.end());
    expectRefused(window, {lost[0], "--headless"});
    window.insert(window.end(), {"--headless", "--ui"});
    expectRefused(window, {lost[0], "--ui"});
  }
  for (const Arguments& lost :
       {Arguments{"--screenshot", "s.png"}, Arguments{"--size", "2x2"}, Arguments{"--gl", "egl"}}) {
    expectRefused({"freefall", lost[0], lost[1]}, {lost[0], "--headless"});
    EXPECT_TRUE(parseSession({"freefall", lost[0], lost[1], "--headless", "--ui", "--script", "s"})
                    .inspector());
  }
  EXPECT_EQ(parseSession({"freefall", "--frame", "7"}).frame, 7U);
  EXPECT_EQ(parseSession({"freefall", "--check", "off"}).policy.check, CheckMode::off);
  expectRefused({"freefall", "brownian"}, {"'brownian'", "one source"});
  EXPECT_THAT(parseSession({}).sources, IsEmpty()) << "the inspector needs none";
}

TEST(Commands, AreParsedWithoutBeingRun) {
  EXPECT_TRUE(parseCommandLine({"bake", "--scenes", "no such scene", "--output", "o"}));
  EXPECT_TRUE(parseCommandLine({"compare", "missing.json", "missing.json"}));
  EXPECT_TRUE(parseCommandLine({"verify", "missing.aabbs"}));
  EXPECT_TRUE(parseCommandLine({"list", "no such kind"}));
  EXPECT_TRUE(parseCommandLine({"--headless", "missing.aabbs"}));
}

TEST(Commands, ErrorsNameArgumentsAsHelpDoes) {
  expectRefused({"verify"}, {"verify: no FILE given (see 'broadmark verify --help')"});
  expectRefused({"convert", "a.aabbs"}, {"no OUT given"});
  expectRefused({"verify", "a.aabbs", "--json"}, {"--json: a value (FILE) is missing"});
  expectRefused({"verify", "a.aabbs", "--json", "b", "--json", "c"},
                {"--json: given more than once"});
  expectRefused({"torture", "--only-sources"}, {"--only-sources: only with SOURCE"});
  expectSessionRefused({"--queries", "rays:9", "--answer", "events"}, {"cannot be combined with"});
}

TEST(Commands, HelpIsWholeAndSucceeds) {
  for (const Arguments& call : {Arguments{"--help"}, Arguments{"--help-all"},
                                Arguments{"bake", "--help"}, Arguments{"--version"}}) {
    testing::internal::CaptureStdout();
    const int status = parseCommandLine(call)();
    EXPECT_THAT(testing::internal::GetCapturedStdout(), Not(IsEmpty()));
    EXPECT_EQ(status, 0);
  }
}

TEST(ParseNumber, TakesFiniteNumbersOnly) {
  EXPECT_EQ(parseNumber("0", "x", 0, false), 0);
  EXPECT_EQ(parseNumber("2.5e-1", "x", 0, true), 0.25);
  for (const char* bad : {"", " 1", "1 ", "0x1", "nan", "-inf", "1,5"}) {
    EXPECT_THAT(inputErrorOf([&] { parseNumber(bad, "--x", 0, false); }),
                AllOf(HasSubstr("--x"), HasSubstr(bad)));
  }
}

}  // namespace
}  // namespace broadmark::tests
