#include "commands/torture_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "broadmark/error.h"
#include "broadmark/json_fields.h"
#include "support/table.h"
#include "support/words.h"

namespace broadmark {
namespace {

constexpr const char* kSchema = "broadmark-torture/1";

Json toJson(const FoundFault& fault) {
  return {{"algorithm", fault.algorithm}, {"kind", fault.kind},       {"case", fault.test_case},
          {"world", fault.world},         {"text", fault.text},       {"round", fault.round},
          {"file", fault.file},           {"bodies", fault.bodies},   {"frames", fault.frames},
          {"minimal", fault.minimal},     {"command", fault.command}, {"boxes", fault.boxes}};
}

/// The kind of fault in a log. Logs of older versions call some faults "unsteady".
std::string kindIn(const JsonFields& json) {
  const std::string kind = json.text("kind");
  return kind == "unsteady" ? std::string(kFaultKinds.nameOf(FaultKind::nondeterministic)) : kind;
}

FoundFault foundFrom(const JsonFields& json) {
  return {.algorithm = json.text("algorithm"),
          .kind = kindIn(json),
          .test_case = json.text("case"),
          .world = json.text("world"),
          .text = json.text("text"),
          .round = json.integer<std::uint64_t>("round"),
          .file = json.text("file"),
          .bodies = json.integer<std::size_t>("bodies"),
          .frames = json.integer<std::size_t>("frames"),
          .minimal = json.boolean("minimal"),
          .boxes = json.has("boxes") ? json.text("boxes") : "",
          .command = json.text("command")};
}

Json toJson(const TortureKey& key, const TortureCount& count) {
  return {{"algorithm", key.algorithm},
          {"isa", key.isa},
          {"threads", key.threads},
          {"answer", key.answer},
          {"world", key.world},
          {"worlds", count.worlds},
          {"frames", count.frames},
          {"changing", count.changing},
          {"filtered", count.filtered},
          {"filter_changes", count.filter_changes},
          {"max_bodies", count.max_bodies},
          {"max_frames", count.max_frames}};
}

void addCount(TortureCoverage& coverage, const JsonFields& json) {
  // Logs of older versions lack some.
  const auto later = [&](const char* key, std::uint64_t before) {
    return json.has(key) ? json.integer<std::uint64_t>(key) : before;
  };
  coverage[{json.text("algorithm"), json.text("isa"), json.integer<int>("threads", 1),
            json.text("answer"), json.text("world")}] +=
      {.worlds = json.integer<std::uint64_t>("worlds"),
       .frames = json.integer<std::uint64_t>("frames"),
       .changing = json.integer<std::uint64_t>("changing"),
       .filtered = json.integer<std::uint64_t>("filtered"),
       .filter_changes = later("filter_changes", 0),
       .max_bodies = later("max_bodies", 1000),
       .max_frames = later("max_frames", 30)};
}

/// Coverage of an algorithm.
struct Covered {
  TortureCount count;
  std::uint64_t events = 0;  ///< frames
  std::set<std::string> worlds;
  std::set<std::string> isas;
  std::set<int> threads;
};

std::map<std::string, Covered> coverageByAlgorithm(const TortureCoverage& coverage) {
  std::map<std::string, Covered> rows;
  for (const auto& [key, count] : coverage) {
    Covered& row = rows[key.algorithm];
    row.count += count;
    if (key.answer == kAnswerKinds.nameOf(AnswerKind::events)) row.events += count.frames;
    row.worlds.insert(key.world);
    row.isas.insert(key.isa);
    row.threads.insert(key.threads);
  }
  return rows;
}

std::string share(std::uint64_t part, std::uint64_t total) {
  if (total == 0) return "–";
  return fmt::format("{:.0f} %", 100 * static_cast<double>(part) / static_cast<double>(total));
}

std::string coverageTable(const TortureLog& log) {
  std::vector<std::vector<std::string>> table = {{"algorithm", "worlds", "frames", "world kinds",
                                                  "events", "changing", "filtered",
                                                  "filter changes", "threads", "instruction sets"}};
  for (const auto& [algorithm, row] : coverageByAlgorithm(log.coverage)) {
    const TortureCount& count = row.count;
    table.push_back({algorithm, fmt::format("{}", count.worlds), fmt::format("{}", count.frames),
                     fmt::format("{} of {}", row.worlds.size(), tortureWorlds().size()),
                     share(row.events, count.frames), share(count.changing, count.frames),
                     share(count.filtered, count.frames), share(count.filter_changes, count.frames),
                     fmt::format("{}", fmt::join(row.threads, ", ")),
                     fmt::format("{}", fmt::join(row.isas, ", "))});
  }
  return alignColumns(table, {false, true, true, true, true, true, true, true, false, false});
}

/// What was tried without a fault; more is not known.
std::string nothingWrong(const TortureLog& log) {
  TortureCount sum;
  for (const auto& [key, count] : log.coverage) sum += count;
  return fmt::format("no fault found in {} of {}, each of at most {}\n",
                     counted(sum.frames, "frame"), counted(sum.worlds, "world"),
                     extentText(sum.max_bodies, sum.max_frames));
}

}  // namespace

std::uint64_t TortureLog::frames() const {
  std::uint64_t sum = 0;
  for (const auto& [key, count] : coverage) sum += count.frames;
  return sum;
}

Json toJson(const TortureCoverage& coverage) {
  Json json = Json::array();
  for (const auto& [key, count] : coverage) json.push_back(toJson(key, count));
  return json;
}

TortureCoverage coverageFrom(const JsonFields& fields) {
  TortureCoverage coverage;
  fields.eachObject("coverage", [&](const JsonFields& count) { addCount(coverage, count); });
  return coverage;
}

TortureLog parseTortureLog(std::string_view text, const std::string& name) {
  const Json json = parseJson(text, name);
  const JsonFields fields(json, name);
  if (fields.text("schema") != kSchema) {
    throw InputError(fmt::format("{}: not a torture log (\"{}\")", name, kSchema));
  }
  TortureLog log;
  log.seed = fields.integer<std::uint64_t>("seed");
  log.next = fields.integer<std::uint64_t>("next");
  log.seconds = fields.number("seconds");
  log.subjects = fields.texts("subjects");
  log.builds = fields.texts("builds");
  for (const Json& round : fields.array("left")) {
    log.unfinished.push_back(JsonFields::integerOf<std::uint64_t>(round, fields.path("left")));
  }
  fields.eachObject("found",
                    [&](const JsonFields& found) { log.found.push_back(foundFrom(found)); });
  fields.eachObject("times", [&](const JsonFields& times) {
    log.times[{times.text("algorithm"), kindIn(times)}] += times.integer<std::uint64_t>("times");
  });
  log.coverage = coverageFrom(fields);
  return log;
}

std::string tortureLogText(const TortureLog& log) {
  Json json = {{"schema", kSchema},        {"seed", log.seed},
               {"subjects", log.subjects}, {"builds", log.builds},
               {"next", log.next},         {"left", log.unfinished},
               {"seconds", log.seconds},   {"found", Json::array()},
               {"times", Json::array()},   {"coverage", toJson(log.coverage)}};
  for (const FoundFault& fault : log.found) json["found"].push_back(toJson(fault));
  for (const auto& [fault, times] : log.times) {
    json["times"].push_back({{"algorithm", fault.first}, {"kind", fault.second}, {"times", times}});
  }
  return formatJson(json);
}

std::string formatFoundFault(const FoundFault& fault) {
  return fmt::format(
      "{}: {}: {} ({}{}){}{}", fault.test_case, fault.kind, fault.text,
      extentText(fault.bodies, fault.frames), fault.minimal ? "" : ", perhaps not the smallest",
      fault.boxes.empty() ? "" : "\n", fault.boxes.substr(0, fault.boxes.rfind('\n')));
}

std::string formatTortureLog(const TortureLog& log) {
  std::string text = coverageTable(log);
  const std::uint64_t frames = log.frames();
  text +=
      fmt::format("seed {}: {} of {} in {}: {:.0f} frames/s\n", log.seed, counted(frames, "frame"),
                  counted(log.next - log.unfinished.size(), "round"), waitingTime(log.seconds),
                  static_cast<double>(frames) / std::max(log.seconds, 1e-9));
  if (log.times.empty()) return text + nothingWrong(log);
  for (const auto& [fault, times] : log.times) {
    text += fmt::format("{}: {}: {}\n", fault.first, fault.second, counted(times, "time"));
  }
  for (const FoundFault& fault : log.found) {
    text += fmt::format("{}\n  {}\n", formatFoundFault(fault), fault.command);
  }
  return text;
}

}  // namespace broadmark
