// Results: JSON and back, stable keys, CSV.

#include "broadmark/results/results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "broadmark/files.h"
#include "engine/helpers.h"
#include "support/places.h"

namespace broadmark::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::SizeIs;
using testing::StartsWith;
using Json = nlohmann::ordered_json;

std::string format(const Results& results, std::string_view name) {
  for (const ResultWriter& writer : resultWriters()) {
    if (writer.name == name) return writer.format(results);
  }
  ADD_FAILURE() << "no writer " << name;
  return {};
}

FrameTimes times(std::int64_t ns) {
  FrameTimes times;
  for (const auto& phase : kPhases.entries) {
    times[phase.value] = ns + static_cast<std::int64_t>(phase.value);
  }
  return times;
}

/// The offset of the total in times().
constexpr auto kTotal = static_cast<std::int64_t>(Phase::total);

/// Two cases: the first has all fields set, the second little more than its name.
Results everything() {
  Results results;
  results.environments = {{.host = "desk",
                           .cpu = "A \"fast\" one",
                           .logical_cores = 8,
                           .physical_cores = 4,
                           .caches = {"L1 Data 48K", "L2 Unified 2048K"},
                           .isa = "avx2",
                           .memory_bytes = std::uint64_t{1} << 40,
                           .governor = "performance",
                           .load_average = 0.1,
                           .os = "Linux",
                           .compiler = "gcc 12",
                           .compiler_flags = "-O3",
                           .build_type = "Release",
                           .version = "1.2.3",
                           .commit = "0123456789abcdef0123456789abcdef01234567",
                           .commit_date = "2025-01-01T00:00:00Z",
                           .dirty = true,
                           .started = "2025-01-02T03:04:05Z"}};
  results.complete = true;
  results.options = {"broadmark", "--headless", "FreeFall"};

  CaseResult& full = results.cases.emplace_back();
  full.id = "FreeFall/Cubes/N10/F2/s7/sap";
  full.recording.scene = {"FreeFall", "Cubes", 10, 2, {{-0.1F, -1e30F, 0, 0}, {0.1F, 3, 1, 0}}};
  full.recording.seed = UINT64_MAX;
  full.recording.hash = "0123";
  full.recording.path = "some/file.aabbs";
  full.algorithm = "sap";
  full.family = "SAP";
  full.isa = Isa::avx512;
  full.vectorised = true;
  full.threads = 3;
  full.device = "pthread";
  full.plugin = "my plug-in.so";
  full.parameters = {{"cells", "2"}, {"margin", "0.01"}};
  full.answer = AnswerKind::events;
  full.status = Status::mismatch;
  full.reason = "frame 1: 1 missed, 1 false, 1 invalid";
  full.pairs_mean = 1.0 / 3;
  full.pairs_max = std::uint64_t{1} << 33;
  full.bodies = Population{.mean = 2.5, .max = 4};
  full.checked = true;
  full.missed_count = 1;
  full.false_count = 1;
  full.allowed_extra_count = 1;
  full.invalid_count = 3;
  full.differences = {{.repetition = 2,
                       .frame = 1,
                       .missed_count = 1,
                       .false_count = 1,
                       .allowed_extra_count = 1,
                       .invalid_count = 3,
                       .missed_pairs = {{0, 1}},
                       .false_pairs = {{2, 3}},
                       .allowed_extra_pairs = {{4, 5}},
                       .invalid_pairs = {{1, 1}, {9, 0xFFFFFFFF}, {0, 1}}}};
  full.setup = {{"kernel_build_ns", 77}};
  full.ageing = {{{"private_bytes", 4096}, {"tests", 1.5}},
                 {{"private_bytes", 8192}, {"tests", 3}}};
  full.peak_bytes = 12345;
  full.repetitions = {{.initialize_ns = 5, .frames = {times(1000), times(2000)}},
                      {.initialize_ns = 6, .frames = {times(3000)}}};
  full.frames = {{{1, 10, 1, 1, 1, 3}}, {{2, 4, 0, 0, 0, 0}}};
  full.conditions = {.check = CheckMode::hash,
                     .warmup = 1,
                     .repetitions = 3,
                     .frame_limit_seconds = 0.5,
                     .call_limit_seconds = 60,
                     .in_process = true,
                     .load_average = 0.25,
                     .plugin = {"ab12", "-O2"},
                     .warnings = {"busy"}};

  CaseResult& bare = results.cases.emplace_back();
  bare.id = "bare";
  bare.recording.scene_parameters = {{"density", "0.1"}};
  bare.recording.swept = {{"density", "0.1"}};
  bare.recording.reading = {{"swept", "on"}};
  bare.status = Status::unsupported;
  return results;
}

/// everything() as JSON with one value replaced.
std::string spoilt(const std::string& pointer, const Json& value) {
  Json json = Json::parse(format(everything(), "json"));
  json[Json::json_pointer(pointer)] = value;
  return json.dump();
}

TEST(ResultsJson, ReadsBackAsItWasWritten) {
  const std::string text = format(everything(), "json");
  const Results copy = parseResults(text, "a.json");
  EXPECT_EQ(format(copy, "json"), text);

  const CaseResult& full = copy.cases.at(0);
  EXPECT_EQ(full.recording.scene, everything().cases[0].recording.scene) << "floats are exact";
  EXPECT_EQ(full.recording.seed, UINT64_MAX);
  EXPECT_EQ(full.pairs_mean, 1.0 / 3);
  ASSERT_TRUE(full.bodies);
  EXPECT_EQ(full.bodies->mean, 2.5);
  EXPECT_EQ(full.bodies->max, 4U);
  EXPECT_FALSE(copy.cases.at(1).bodies) << "all bodies are present";
  EXPECT_EQ(full.differences.at(0).invalid_pairs.at(1), (Pair{9, 0xFFFFFFFF}));
  EXPECT_EQ(full.repetitions.at(1).frames.at(0)[Phase::total], 3000 + kTotal);
  EXPECT_EQ(full.frames.at(0)[FrameCount::invalid], 3U);
  EXPECT_EQ(full.conditions.check, CheckMode::hash);
  EXPECT_EQ(full.conditions.frame_limit_seconds, 0.5);
  EXPECT_FALSE(full.conditions.initialize_limit_seconds);
  EXPECT_EQ(full.conditions.plugin.flags, "-O2");
  EXPECT_THAT(full.conditions.warnings, testing::ElementsAre("busy"));
  EXPECT_EQ(full.device, "pthread");
  EXPECT_EQ(full.plugin, "my plug-in.so");
  EXPECT_EQ(full.answer, AnswerKind::events);
  EXPECT_EQ(full.parameters, (ParameterValues{{"cells", "2"}, {"margin", "0.01"}}));
  const CaseResult& bare = copy.cases.at(1);
  EXPECT_FALSE(bare.recording.seed);
  EXPECT_FALSE(bare.peak_bytes);
  EXPECT_EQ(bare.recording.path, "");
  EXPECT_EQ(bare.recording.scene_parameters, (ParameterValues{{"density", "0.1"}}));
  EXPECT_EQ(bare.recording.swept, bare.recording.scene_parameters);
  EXPECT_EQ(bare.recording.reading, (ParameterValues{{"swept", "on"}}));
  EXPECT_EQ(bare.status, Status::unsupported);
}

TEST(ResultsJson, EveryStatusAndInstructionSetSurvives) {
  for (const auto& [status, status_name] : kStatuses.entries) {
    for (const auto& [isa, name] : kIsas.entries) {
      Results results = everything();
      results.cases[0].status = status;
      results.cases[0].isa = isa;
      const Results copy = parseResults(format(results, "json"), "a.json");
      EXPECT_EQ(copy.cases[0].status, status);
      EXPECT_EQ(copy.cases[0].isa, isa);
    }
  }
}

TEST(ResultsJson, HasTheKeysThatOthersRelyOn) {
  const Json json = Json::parse(format(everything(), "json"));
  EXPECT_EQ(json["schema"], "broadmark-results/2");
  const auto expect_keys = [](const Json& object, const std::vector<std::string>& keys) {
    for (const std::string& key : keys) EXPECT_TRUE(object.contains(key)) << key;
  };
  expect_keys(json, {"environments", "options", "cases", "complete"});
  expect_keys(json["environments"][0],
              {"cpu", "caches", "logical_cores", "physical_cores", "isa", "memory_bytes",
               "governor", "load_average", "os", "compiler", "compiler_flags", "build_type",
               "version", "commit", "dirty"});
  ASSERT_THAT(json["cases"], SizeIs(2));
  const Json& full = json["cases"][0];
  expect_keys(full, {"id", "recording", "algorithm", "family", "isa", "threads", "params", "status",
                     "reason", "pairs", "missed", "false", "allowed_extra", "invalid",
                     "differences", "peak_bytes", "summary", "setup", "frames"});
  expect_keys(full["recording"],
              {"name", "object_type", "objects", "frames", "seed", "hash", "source"});
  expect_keys(full["pairs"], {"mean", "max"});
  expect_keys(full["summary"],
              {"seconds_per_frame", "median", "p95", "p99", "min", "stddev", "ci95"});
  expect_keys(full["differences"][0],
              {"repetition", "frame", "missed", "false", "allowed_extra", "invalid"});
  EXPECT_EQ(full["recording"]["source"], "some/file.aabbs");
  EXPECT_EQ(json["cases"][1]["recording"]["source"], (Json{{"density", "0.1"}}));
  EXPECT_TRUE(json["cases"][1]["peak_bytes"].is_null());
  // One array per phase and repetition.
  EXPECT_EQ(full["frames"]["update_objects"], Json::parse("[[1000, 2000], [3000]]"));
  EXPECT_EQ(full["frames"]["total"],
            (Json{{1000 + kTotal, 2000 + kTotal}, Json::array({3000 + kTotal})}));
  expect_keys(full["frames"], {"clean_cache", "update_structures", "search_overlaps"});
}

TEST(ResultsJson, TextThatIsNotUtf8IsMended) {
  Results results = everything();
  results.cases[0].recording.path = "caf\xE9.aabbs";
  const std::string text = format(results, "json");
  EXPECT_EQ(format(parseResults(text, "a.json"), "json"), text);
}

TEST(ResultsJson, ErrorsNameFileAndKey) {
  struct Fault {
    const char* pointer;
    Json value;
    const char* place;
    const char* word;
  };
  const Fault faults[] = {
      {"/environments/0/cpu", 5, "environments[0]: cpu", "string"},
      {"/environments/0/caches", Json::array({1}), "environments[0]: caches", "strings"},
      {"/environments/0/memory_bytes", -1, "environments[0]: memory_bytes", "from 0 to"},
      {"/complete", 1, "complete", "true or false"},
      {"/cases/1/environment", 1, "case 'bare'", "no environment 1"},
      {"/cases/0/conditions/check", "some", "cases[0]: conditions: check", "'some'"},
      {"/cases/0/frame_counts/missed", Json::array({1}), "cases[0]: frame_counts: missed",
       "same number"},
      {"/options", "x", "options", "array"},
      {"/cases/0", 1, "cases[0]", "object"},
      {"/cases/1/threads", 0, "cases[1]: threads", "from 1 to"},
      {"/cases/1/threads", 1.5, "cases[1]: threads", "integer"},
      {"/cases/1/threads", 3000000000U, "cases[1]: threads", "integer"},
      {"/cases/0/isa", "mmx", "cases[0]: isa", "'mmx'"},
      {"/cases/0/status", "fine", "cases[0]: status", "'fine'"},
      {"/cases/0/checked", 1, "cases[0]: checked", "true or false"},
      {"/cases/0/pairs/mean", "1", "cases[0]: pairs: mean", "number"},
      {"/cases/0/params", 1, "cases[0]: params", "object"},
      {"/cases/0/params/cells", 2, "cases[0]: params: cells", "string"},
      {"/cases/0/recording/objects", -2, "cases[0]: recording: objects", "integer"},
      {"/cases/0/recording/source", 1, "cases[0]: recording: source", "object"},
      {"/cases/0/recording/world/min", Json::array({1, 2}), "cases[0]: recording: world: min",
       "three"},
      {"/cases/0/recording/world/max/0", 1e300, "cases[0]: recording: world: max", "32-bit"},
      {"/cases/0/differences/0/missed/0", Json::array({1}), "cases[0]: differences[0]: missed",
       "pairs"},
      {"/cases/0/differences/0/false/0/1", -1, "cases[0]: differences[0]: false", "from 0 to"},
      {"/cases/0/initialize_ns", Json::array({5}), "cases[0]: frames: update_objects",
       "2 repetitions"},
      {"/cases/0/frames/total/0", Json::array({5}), "cases[0]: frames: total", "same number"},
      {"/cases/0/frames/clean_cache/0", 5, "cases[0]: frames: clean_cache", "arrays"},
      {"/cases/0/frames/total/0/0", -1, "cases[0]: frames: total", "from 0"}};
  for (const Fault& fault : faults) {
    EXPECT_THAT(
        inputErrorOf([&] { parseResults(spoilt(fault.pointer, fault.value), "a.json"); }),
        AllOf(StartsWith("a.json: " + std::string(fault.place) + ": "), HasSubstr(fault.word)));
  }
}

TEST(ResultsJson, ParametersByFormerNamesAreRead) {
  const Results results =
      parseResults(spoilt("/cases/0/params", {{"crowded", "7"}, {"cells", "2"}}), "a.json");
  EXPECT_EQ(results.cases.front().parameters,
            (ParameterValues{{"split_threshold", "7"}, {"cells", "2"}}));
}

TEST(ResultsJson, MissingKeysAreNamed) {
  const Json whole = Json::parse(format(everything(), "json"));
  for (const auto& item : whole["cases"][0].items()) {
    // Without conditions, it is read as results/1.
    const std::set<std::string> optional = {"peak_bytes", "counters",   "setup",     "device",
                                            "plugin",     "conditions", "processor", "bodies",
                                            "answer",     "ageing"};
    if (optional.contains(item.key()) || item.key() == "summary") continue;  // derived
    Json json = whole;
    json["cases"][0].erase(item.key());
    EXPECT_THAT(inputErrorOf([&] { parseResults(json.dump(), "a.json"); }),
                AllOf(StartsWith("a.json: cases[0]"), HasSubstr("'" + item.key() + "'"),
                      HasSubstr("missing")));
  }
}

/// everything() in the format of an earlier version.
Json asResults1() {
  Json json = Json::parse(format(everything(), "json"));
  json["schema"] = "broadmark-results/1";
  json["environment"] = json["environments"][0];
  json.erase("environments");
  json.erase("complete");
  for (Json& result : json["cases"]) {
    for (const char* key : {"environment", "conditions", "frame_counts"}) {
      result.erase(key);
    }
  }
  return json;
}

TEST(ResultsJson, FilesOfEarlierVersionsAreRead) {
  Json json = asResults1();
  for (const char* key : {"counters", "device", "plugin", "answer"}) json["cases"][0].erase(key);
  json["environment"].erase("host");
  const Results results = parseResults(json.dump(), "a.json");
  EXPECT_EQ(results.cases[0].device, "");
  EXPECT_EQ(results.cases[0].plugin, "");
  EXPECT_EQ(results.cases[0].answer, AnswerKind::pairs);
  EXPECT_EQ(results.environments.at(0).host, "");
  EXPECT_EQ(results.environments.at(0).cpu, everything().environments[0].cpu);
  EXPECT_TRUE(results.complete) << "they did not say";
  EXPECT_TRUE(results.cases[0].isComplete());
}

TEST(ResultsLines, HoldTheSame) {
  const std::string lines = format(everything(), "jsonl");
  EXPECT_EQ(std::ranges::count(lines, '\n'), 1 + 1 + 2 + 1);
  EXPECT_EQ(format(parseResults(lines, "a.jsonl"), "json"), format(everything(), "json"));
}

// A run may end at any time: complete lines are read, and the results are marked incomplete.
TEST(ResultsLines, ArePartialWhereverTheyEnd) {
  const std::string lines = format(everything(), "jsonl");
  const std::size_t first_line = lines.find('\n') + 1;
  const std::size_t first_case = lines.find('\n', first_line) + 1;
  for (std::size_t length = first_case; length + 1 < lines.size(); length += 7) {
    const std::string text = lines.substr(0, length);
    const Results results = parseResults(text, "a.jsonl");
    EXPECT_FALSE(results.complete) << length;
    EXPECT_LE(results.cases.size(), 2U);
    const auto whole = static_cast<std::size_t>(std::ranges::count(text, '\n'));
    EXPECT_GE(results.cases.size() + 2, whole) << length;
  }
  EXPECT_EQ(parseResults(lines.substr(0, lines.find("{\"end\"")), "a.jsonl").cases.size(), 2U);
}

TEST(ResultsLines, ErrorsNameTheLine) {
  const std::string lines = format(everything(), "jsonl");
  EXPECT_THAT(inputErrorOf([&] { parseResults(lines + "{}\n", "a.jsonl"); }),
              StartsWith("a.jsonl: line 6: "));
  const std::size_t second = lines.find('\n') + 1;
  const std::string broken = lines.substr(0, second) + "{\n" + lines.substr(second);
  EXPECT_THAT(inputErrorOf([&] { parseResults(broken, "a.jsonl"); }),
              StartsWith("a.jsonl: line 2: not valid JSON"));
  const std::string other = lines.substr(0, second) + "{\"what\": 1}\n";
  EXPECT_THAT(inputErrorOf([&] { parseResults(other, "a.jsonl"); }),
              HasSubstr("line 2: neither an environment, a case nor the end"));
}

// They have a single list of false and allowed extra pairs.
TEST(ResultsJson, FilesWithExtraPairsOnlyAreRead) {
  Json json = asResults1();
  const auto restate = [](Json& object, const std::string& suffix) {
    object.erase("false" + suffix);
    object.erase("allowed_extra" + suffix);
    object["extra" + suffix] = 2;
  };
  Json& first = json["cases"][0];
  restate(first, "");
  Json& difference = first["differences"][0];
  restate(difference, "_count");
  restate(difference, "");
  difference["forbidden_count"] = 1;
  difference["extra"] = Json::parse("[[2, 3], [4, 5]]");
  Json& bare = json["cases"][1];
  restate(bare, "");

  const Results results = parseResults(json.dump(), "a.json");
  EXPECT_EQ(results.cases[0].false_count, 1U);
  EXPECT_EQ(results.cases[0].allowed_extra_count, 1U);
  EXPECT_EQ(results.cases[0].differences[0].false_count, 1U);
  EXPECT_EQ(results.cases[0].differences[0].allowed_extra_count, 1U);
  EXPECT_EQ(results.cases[0].differences[0].false_pairs.size(), 2U);
  EXPECT_EQ(results.cases[1].allowed_extra_count, 2U);
}

TEST(ResultsJson, WhatIsNoResultsFile) {
  const std::pair<const char*, const char*> texts[] = {
      {"", "not valid JSON"},
      {"{", "not valid JSON"},
      {"\xFF", "not valid JSON"},
      {"[1e999]", "not valid JSON"},
      {"[]", "a JSON object is expected"},
      {"{}", "not a results file"},
      {R"({"schema": 1})", "schema: a string is expected"},
      {R"({"schema": "broadmark-scene/1"})", "not a results file"},
      {R"({"schema": "broadmark-results/2"})", "'options' is missing"}};
  for (const auto& [text, fault] : texts) {
    EXPECT_THAT(inputErrorOf([text] { parseResults(text, "a.json"); }),
                AllOf(StartsWith("a.json: "), HasSubstr(fault), testing::Not(HasSubstr("\n"))));
  }
  const std::string deep(100'000, '[');
  EXPECT_THAT(inputErrorOf([&] { parseResults(deep, "a.json"); }), HasSubstr("not valid JSON"));
}

std::string documentation() { return readTextFile(places::source("docs/results.md")); }

Json withoutSummary(Json line) {
  if (line.contains("case")) line["case"].erase("summary");
  return line;
}

TEST(ResultsDocumentation, ItsExampleIsAResultsFile) {
  const std::string text = documentation();
  const std::size_t begin = text.find("```json\n") + 8;
  const std::string example = text.substr(begin, text.find("```", begin) - begin);
  const Results results = parseResults(example, "example");
  EXPECT_TRUE(results.complete);
  ASSERT_THAT(results.cases, SizeIs(1));
  EXPECT_TRUE(results.cases[0].isComplete());
  // In the current format, except for digits of derived values.
  std::istringstream lines(format(results, "jsonl"));
  std::istringstream documented(example);
  for (std::string line, shown; std::getline(lines, line) && std::getline(documented, shown);) {
    EXPECT_EQ(withoutSummary(Json::parse(line)), withoutSummary(Json::parse(shown)));
  }
}

/// Calls visit(key) for all keys of an object, recursively, except for keys that are data.
template <class Visit>
void eachKey(const Json& json, Visit&& visit) {
  for (const auto& [key, value] : json.items()) {
    if (json.is_object()) visit(key);
    if (key != "params" && key != "counters" && key != "setup" && key != "source" &&
        key != "swept" && key != "reading" && key != "early" && key != "late") {
      if (value.is_structured()) eachKey(value, visit);
    }
  }
}

TEST(ResultsDocumentation, NamesEveryKey) {
  const std::string text = documentation();
  eachKey(Json::parse(format(everything(), "json")),
          [&](const std::string& key) { EXPECT_THAT(text, HasSubstr('`' + key + '`')); });
}

/// Splits CSV (RFC 4180) into rows of fields.
std::vector<std::vector<std::string>> parseCsv(const std::string& text) {
  std::vector<std::vector<std::string>> rows = {{""}};
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') {
      const bool literal = quoted && i + 1 < text.size() && text[i + 1] == '"';
      if (literal) {
        rows.back().back() += c;
        ++i;
      } else {
        quoted = !quoted;
      }
    } else if (c == ',' && !quoted) {
      rows.back().emplace_back();
    } else if (c == '\n' && !quoted) {
      rows.push_back({""});
    } else {
      rows.back().back() += c;
    }
  }
  rows.pop_back();  // the text ends with a newline
  return rows;
}

/// A row by column names.
std::map<std::string, std::string> rowOf(const std::vector<std::vector<std::string>>& rows,
                                         std::size_t row) {
  std::map<std::string, std::string> fields;
  for (std::size_t i = 0; i < rows[0].size(); ++i) fields[rows[0][i]] = rows[row].at(i);
  return fields;
}

TEST(ResultsCsv, OneRowPerCase) {
  const auto rows = parseCsv(format(everything(), "csv"));
  ASSERT_THAT(rows, SizeIs(3));
  for (const auto& row : rows) EXPECT_EQ(row.size(), rows[0].size());
  auto full = rowOf(rows, 1);
  EXPECT_EQ(full["algorithm"], "sap");
  EXPECT_EQ(full["objects"], "10");
  EXPECT_EQ(full["params"], "cells=2;margin=0.01");
  EXPECT_EQ(full["status"], "mismatch");
  EXPECT_EQ(full["repetitions"], "2");
  EXPECT_DOUBLE_EQ(std::stod(full["seconds_per_frame"]), (2000 + kTotal) * 1e-9);
  EXPECT_DOUBLE_EQ(std::stod(full["min_seconds"]), (1000 + kTotal) * 1e-9);
  EXPECT_DOUBLE_EQ(std::stod(full["initialize_seconds"]), 5.5e-9);
  EXPECT_DOUBLE_EQ(std::stod(full["update_objects_seconds"]), 2000e-9);
  EXPECT_EQ(full["missed"], "1");
  EXPECT_EQ(full["peak_bytes"], "12345");

  auto bare = rowOf(rows, 2);
  for (const char* unknown :
       {"seconds_per_frame", "median_seconds", "ci95_low_seconds", "outliers", "initialize_seconds",
        "missed", "false", "allowed_extra", "invalid", "peak_bytes", "seed"}) {
    EXPECT_EQ(bare[unknown], "") << unknown << ": unknown values are empty, not 0";
  }
}

TEST(ResultsCsv, QuotesWhatNeedsIt) {
  Results results = everything();
  results.cases[0].reason = "a, \"b\"\nc";
  results.cases[0].recording.scene.name = "Free,Fall";
  results.cases[0].recording.hash = "not,a,hash";
  const std::string text = format(results, "csv");
  EXPECT_THAT(text, HasSubstr("\"a, \"\"b\"\"\nc\""));
  const auto rows = parseCsv(text);
  ASSERT_THAT(rows, SizeIs(3));
  EXPECT_EQ(rowOf(rows, 1)["reason"], "a, \"b\"\nc");
  EXPECT_EQ(rowOf(rows, 1)["scene"], "Free,Fall");
  EXPECT_EQ(rowOf(rows, 1)["recording_hash"], "not,a,hash");
}

TEST(ResultsCsv, OneRowPerFrame) {
  const auto rows = parseCsv(format(everything(), "csv-frames"));
  ASSERT_THAT(rows, SizeIs(1 + 3));
  auto last = rowOf(rows, 3);
  EXPECT_EQ(last["repetition"], "2");
  EXPECT_EQ(last["frame"], "1");
  EXPECT_EQ(last["update_objects_ns"], "3000");
  EXPECT_EQ(last["total_ns"], std::to_string(3000 + kTotal));
  EXPECT_EQ(last["pairs"], "1");
  EXPECT_EQ(last["changed_bodies"], "10");
  EXPECT_EQ(last["missed"], "1");
}

}  // namespace
}  // namespace broadmark::tests
