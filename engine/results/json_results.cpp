// Results as JSON ("schema": "broadmark-results/2") and back: as one document, or as lines of which
// each is whole by itself. Earlier files ("broadmark-results/1") are read, too.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "broadmark/json_fields.h"
#include "result_writers.h"

namespace broadmark {
namespace {

Json toJson(const Environment& e) {
  return {{"host", e.host},
          {"cpu", e.cpu},
          {"logical_cores", e.logical_cores},
          {"physical_cores", e.physical_cores},
          {"caches", e.caches},
          {"isa", e.isa},
          {"memory_bytes", e.memory_bytes},
          {"governor", e.governor},
          {"load_average", e.load_average},
          {"os", e.os},
          {"compiler", e.compiler},
          {"compiler_flags", e.compiler_flags},
          {"build_type", e.build_type},
          {"version", e.version},
          {"started", e.started},
          {"compute_devices", e.compute_devices}};
}

/// The value that the text at `key` names.
template <class Table>
auto named(const JsonFields& json, const char* key, const Table& table) {
  const std::string text = json.text(key);
  const auto value = table.find(text);
  if (!value) throw InputError(fmt::format("{}: unknown value '{}'", json.path(key), text));
  return *value;
}

Environment environmentFrom(const JsonFields& json) {
  Environment environment = {.cpu = json.text("cpu"),
                             .logical_cores = json.integer<int>("logical_cores", 0),
                             .physical_cores = json.integer<int>("physical_cores", 0),
                             .caches = json.texts("caches"),
                             .isa = json.text("isa"),
                             .memory_bytes = json.integer<std::uint64_t>("memory_bytes"),
                             .governor = json.text("governor"),
                             .load_average = json.number("load_average"),
                             .os = json.text("os"),
                             .compiler = json.text("compiler"),
                             .compiler_flags = json.text("compiler_flags"),
                             .build_type = json.text("build_type"),
                             .version = json.text("version"),
                             .started = json.text("started")};
  if (json.has("host")) environment.host = json.text("host");
  if (json.has("compute_devices")) {
    environment.compute_devices = json.texts("compute_devices");
  }
  return environment;
}

Json toJson(const Conditions& c) {
  return {{"check", kCheckModes.nameOf(c.check)},
          {"warmup", c.warmup},
          {"repetitions", c.repetitions},
          {"frame_limit_seconds", orNull(c.frame_limit_seconds)},
          {"initialize_limit_seconds", orNull(c.initialize_limit_seconds)},
          {"call_limit_seconds", orNull(c.call_limit_seconds)},
          {"in_process", c.in_process},
          {"pinned", c.pinned},
          {"load_average", c.load_average},
          {"plugin", {{"hash", c.plugin.hash}, {"flags", c.plugin.flags}}},
          {"warnings", c.warnings}};
}

Conditions conditionsFrom(const JsonFields& json) {
  const auto limit = [&](const char* key) {
    return json.has(key) ? std::optional(json.number(key)) : std::nullopt;
  };
  const JsonFields plugin = json.object("plugin");
  return {.check = named(json, "check", kCheckModes),
          .warmup = json.integer<int>("warmup", 0),
          .repetitions = json.integer<int>("repetitions", 0),
          .frame_limit_seconds = limit("frame_limit_seconds"),
          .initialize_limit_seconds = limit("initialize_limit_seconds"),
          .call_limit_seconds = limit("call_limit_seconds"),
          .in_process = json.boolean("in_process"),
          .pinned = json.has("pinned") && json.boolean("pinned"),
          .load_average = json.number("load_average"),
          .plugin = {plugin.text("hash"), plugin.text("flags")},
          .warnings = json.texts("warnings")};
}

Json toJson(const ParameterValues& values) {
  Json json = Json::object();
  for (const auto& [name, value] : values) json[name] = value;
  return json;
}

ParameterValues parametersFrom(const Json& json, const std::string& name) {
  if (!json.is_object()) throw InputError(name + ": an object of texts is expected");
  ParameterValues values;
  for (const auto& [key, value] : json.items()) {
    if (!value.is_string()) throw InputError(fmt::format("{}: {}: a text is expected", name, key));
    values.emplace(key, value.get<std::string>());
  }
  return values;
}

Json toJson(const std::array<float, 4>& corner) { return {corner[0], corner[1], corner[2]}; }

std::array<float, 4> cornerFrom(const Json& json, const std::string& name) {
  std::array<float, 4> corner{};
  const auto fits = [](const Json& v) {
    return v.is_number() && std::abs(v.get<double>()) <= std::numeric_limits<float>::max();
  };
  if (json.size() != 3 || !std::ranges::all_of(json, fits)) {
    throw InputError(name + ": three 32-bit floats are expected");
  }
  for (std::size_t axis = 0; axis < 3; ++axis) corner[axis] = json[axis].get<float>();
  return corner;
}

Json toJson(const RecordingReference& recording) {
  const SceneInfo& scene = recording.scene;
  Json json = {{"name", scene.name},
               {"object_type", scene.object_type},
               {"objects", scene.objects},
               {"frames", scene.frames},
               {"world", {{"min", toJson(scene.world.min)}, {"max", toJson(scene.world.max)}}},
               {"seed", orNull(recording.seed)},
               {"hash", recording.hash}};
  if (!recording.swept.empty()) json["swept"] = toJson(recording.swept);
  if (!recording.reading.empty()) json["reading"] = toJson(recording.reading);
  if (recording.path.empty()) {
    json["source"] = toJson(recording.scene_parameters);
  } else {
    json["source"] = recording.path;
  }
  return json;
}

RecordingReference recordingFrom(const JsonFields& json) {
  RecordingReference recording;
  SceneInfo& scene = recording.scene;
  scene.name = json.text("name");
  scene.object_type = json.text("object_type");
  scene.objects = json.integer<std::uint32_t>("objects");
  scene.frames = json.integer<std::uint32_t>("frames");
  const JsonFields world = json.object("world");
  scene.world.min = cornerFrom(world.array("min"), world.path("min"));
  scene.world.max = cornerFrom(world.array("max"), world.path("max"));
  if (json.has("seed")) recording.seed = json.integer<std::uint64_t>("seed");
  if (json.has("swept")) recording.swept = parametersFrom(json.at("swept"), json.path("swept"));
  if (json.has("reading")) {
    recording.reading = parametersFrom(json.at("reading"), json.path("reading"));
  }
  recording.hash = json.text("hash");
  if (json.at("source").is_string()) {
    recording.path = json.text("source");
  } else {
    recording.scene_parameters = parametersFrom(json.at("source"), json.path("source"));
  }
  return recording;
}

Json toJson(const std::vector<Pair>& pairs) {
  Json json = Json::array();
  for (const Pair pair : pairs) json.push_back({pair.a, pair.b});
  return json;
}

std::vector<Pair> pairsFrom(const Json& json, const std::string& name) {
  std::vector<Pair> pairs;
  for (const Json& element : json) {
    if (!element.is_array() || element.size() != 2) {
      throw InputError(name + ": pairs of body numbers are expected");
    }
    pairs.push_back({JsonFields::integerOf<std::uint32_t>(element[0], name),
                     JsonFields::integerOf<std::uint32_t>(element[1], name)});
  }
  return pairs;
}

Json toJson(const FrameDifference& d) {
  return {{"repetition", d.repetition},
          {"frame", d.frame},
          {"missed_count", d.missed_count},
          {"false_count", d.false_count},
          {"allowed_extra_count", d.allowed_extra_count},
          {"invalid_count", d.invalid_count},
          {"missed", toJson(d.missed_pairs)},
          {"false", toJson(d.false_pairs)},
          {"allowed_extra", toJson(d.allowed_extra_pairs)},
          {"invalid", toJson(d.invalid_pairs)}};
}

/// Files written before false and allowed extra pairs were told apart have "extra" for both, with
/// the count of the false ones as "forbidden_count".
FrameDifference differenceFrom(const JsonFields& json) {
  const auto count = [&](const char* key) { return json.integer<std::uint64_t>(key); };
  const auto pairs = [&](const char* key) { return pairsFrom(json.array(key), json.path(key)); };
  FrameDifference difference{.repetition = json.integer<int>("repetition", 0),
                             .frame = json.integer<std::uint32_t>("frame"),
                             .missed_count = count("missed_count"),
                             .invalid_count = count("invalid_count"),
                             .missed_pairs = pairs("missed"),
                             .invalid_pairs = pairs("invalid")};
  if (json.has("extra")) {
    difference.false_count = count("forbidden_count");
    difference.allowed_extra_count =
        count("extra_count") - std::min(count("extra_count"), difference.false_count);
    (difference.false_count > 0 ? difference.false_pairs : difference.allowed_extra_pairs) =
        pairs("extra");
  } else {
    difference.false_count = count("false_count");
    difference.allowed_extra_count = count("allowed_extra_count");
    difference.false_pairs = pairs("false");
    difference.allowed_extra_pairs = pairs("allowed_extra");
  }
  return difference;
}

Json toJson(const Summary& summary) {
  Json json = {{"seconds_per_frame", summary.seconds_per_frame},
               {"median", summary.median},
               {"p95", summary.p95},
               {"p99", summary.p99},
               {"min", summary.min},
               {"stddev", summary.stddev},
               {"outliers", summary.outliers},
               {"ci95", nullptr}};
  if (summary.ci95) json["ci95"] = {summary.ci95->low, summary.ci95->high};
  return json;
}

/// Whether any frame spent time in a phase.
bool isUsed(Phase phase, const std::vector<Repetition>& repetitions) {
  return std::ranges::any_of(repetitions, [&](const Repetition& repetition) {
    return std::ranges::any_of(repetition.frames,
                               [&](const FrameTimes& frame) { return frame[phase] != 0; });
  });
}

/// Phases of compute devices only, left out where there is none.
bool isOptional(Phase phase) { return phase == Phase::upload || phase == Phase::download; }

/// One array of nanoseconds per phase and repetition.
Json framesToJson(const std::vector<Repetition>& repetitions) {
  Json json = Json::object();
  for (const auto& [phase, name] : kPhases.entries) {
    if (isOptional(phase) && !isUsed(phase, repetitions)) continue;
    Json& arrays = json[std::string(name)] = Json::array();
    for (const Repetition& repetition : repetitions) {
      Json& times = arrays.emplace_back(Json::array());
      for (const FrameTimes& frame : repetition.frames) times.push_back(frame[phase]);
    }
  }
  return json;
}

std::vector<Repetition> framesFrom(const JsonFields& json, const Json& initialize_ns,
                                   const std::string& initialize_name) {
  std::vector<Repetition> repetitions;
  for (const Json& ns : initialize_ns) {
    repetitions.push_back({JsonFields::integerOf<std::int64_t>(ns, initialize_name, 0), {}});
  }
  for (const auto& [phase, phase_name] : kPhases.entries) {
    const std::string key(phase_name);
    if (isOptional(phase) && !json.has(key.c_str())) continue;
    const Json& arrays = json.array(key.c_str());
    const std::string name = json.path(key.c_str());
    if (arrays.size() != repetitions.size()) {
      throw InputError(fmt::format("{}: {} repetitions instead of the {} initialisations", name,
                                   arrays.size(), repetitions.size()));
    }
    for (std::size_t r = 0; r < arrays.size(); ++r) {
      if (!arrays[r].is_array()) throw InputError(name + ": arrays of nanoseconds are expected");
      auto& frames = repetitions[r].frames;
      if (phase == kPhases.entries.front().value) frames.resize(arrays[r].size());
      if (frames.size() != arrays[r].size()) {
        throw InputError(name + ": all phases must have the same number of frames");
      }
      for (std::size_t f = 0; f < frames.size(); ++f) {
        frames[f][phase] = JsonFields::integerOf<std::int64_t>(arrays[r][f], name, 0);
      }
    }
  }
  return repetitions;
}

/// Calls visit(place, element, name) for each element of the array at `key`, of which there must be
/// `count`, or `complaint` says what is wrong.
template <class Visit>
void eachOf(const JsonFields& json, const std::string& key, std::size_t count,
            std::string_view complaint, Visit&& visit) {
  const Json& elements = json.array(key.c_str());
  const std::string name = json.path(key.c_str());
  if (elements.size() != count) throw InputError(fmt::format("{}: {}", name, complaint));
  for (std::size_t place = 0; place < count; ++place) visit(place, elements[place], name);
}

/// Of each yardstick one time per repetition; null before a repetition without.
Json yardsticksToJson(const std::vector<Repetition>& repetitions) {
  Json json = Json::object();
  for (const auto& [which, name] : kYardsticks.entries) {
    Json& times = json[fmt::format("{}_ns", name)] = Json::array();
    for (const Repetition& repetition : repetitions) {
      times.push_back(repetition.yardsticks ? Json((*repetition.yardsticks)[which])
                                            : Json(nullptr));
    }
  }
  return json;
}

void readYardsticks(const JsonFields& json, std::vector<Repetition>& repetitions) {
  for (const auto& [which, yardstick] : kYardsticks.entries) {
    const auto take = [&, which = which](std::size_t r, const Json& time, const std::string& name) {
      if (time.is_null()) return;
      std::optional<YardstickTimes>& taken = repetitions[r].yardsticks;
      if (!taken) taken.emplace();
      (*taken)[which] = JsonFields::integerOf<std::int64_t>(time, name, 1);
    };
    eachOf(json, fmt::format("{}_ns", yardstick), repetitions.size(),
           "one time per repetition is expected", take);
  }
}

/// Of each counter one sum per repetition; null where it is not known.
Json processorToJson(const std::vector<Repetition>& repetitions) {
  Json json = Json::object();
  for (const auto& [which, name] : kProcessorCounters.entries) {
    Json& counts = json[std::string(name)] = Json::array();
    for (const Repetition& repetition : repetitions) {
      counts.push_back(orNull(repetition.processor[which]));
    }
  }
  return json;
}

void readProcessor(const JsonFields& json, std::vector<Repetition>& repetitions) {
  for (const auto& [which, counter] : kProcessorCounters.entries) {
    const std::string key(counter);
    if (!json.has(key.c_str())) continue;
    const auto take = [&, which = which](std::size_t r, const Json& sum, const std::string& name) {
      if (sum.is_null()) return;
      repetitions[r].processor[which] = JsonFields::integerOf<std::uint64_t>(sum, name);
    };
    eachOf(json, key, repetitions.size(), "one count per repetition is expected", take);
  }
}

/// One array per kind, those of wrong pairs only where there are any.
Json frameCountsToJson(const std::vector<FrameCounts>& frames) {
  Json json = Json::object();
  for (const auto& [which, name] : kFrameCounts.entries) {
    const bool always = which == FrameCount::pairs || which == FrameCount::changed_bodies;
    const auto counted = [which = which](const FrameCounts& frame) { return frame[which] != 0; };
    if (!always && std::ranges::none_of(frames, counted)) continue;
    Json& counts = json[std::string(name)] = Json::array();
    for (const FrameCounts& frame : frames) counts.push_back(frame[which]);
  }
  return json;
}

std::vector<FrameCounts> frameCountsFrom(const JsonFields& json) {
  std::vector<FrameCounts> frames(json.array("pairs").size());
  for (const auto& [which, kind] : kFrameCounts.entries) {
    const std::string key(kind);
    if (!json.has(key.c_str())) continue;
    const auto take = [&, which = which](std::size_t f, const Json& count,
                                         const std::string& name) {
      frames[f][which] = JsonFields::integerOf<std::uint64_t>(count, name);
    };
    eachOf(json, key, frames.size(), "all counts must have the same number of frames", take);
  }
  return frames;
}

Json toJson(const CaseResult& result) {
  Json json = {{"id", result.id},
               {"recording", toJson(result.recording)},
               {"algorithm", result.algorithm},
               {"family", result.family},
               {"isa", isaName(result.isa)},
               {"vectorised", result.vectorised},
               {"threads", result.threads},
               {"device", result.device},
               {"plugin", result.plugin},
               {"params", toJson(result.parameters)},
               {"answer", kAnswerKinds.nameOf(result.answer)},
               {"environment", result.environment},
               {"conditions", toJson(result.conditions)},
               {"status", statusName(result.status)},
               {"reason", result.reason},
               {"pairs", {{"mean", result.pairs_mean}, {"max", result.pairs_max}}},
               {"checked", result.checked},
               {"missed", result.missed_count},
               {"false", result.false_count},
               {"allowed_extra", result.allowed_extra_count},
               {"invalid", result.invalid_count},
               {"differences", Json::array()},
               {"peak_bytes", orNull(result.peak_bytes)},
               {"counters", result.counters},
               {"setup", result.setup},
               {"summary", toJson(result.summary())},
               {"initialize_ns", Json::array()},
               {"yardsticks", yardsticksToJson(result.repetitions)},
               {"processor", processorToJson(result.repetitions)},
               {"frame_counts", frameCountsToJson(result.frames)},
               {"frames", framesToJson(result.repetitions)}};
  if (result.bodies) {
    json["bodies"] = {{"mean", result.bodies->mean}, {"max", result.bodies->max}};
  }
  for (const FrameDifference& difference : result.differences) {
    json["differences"].push_back(toJson(difference));
  }
  for (const Repetition& repetition : result.repetitions) {
    json["initialize_ns"].push_back(repetition.initialize_ns);
  }
  return json;
}

CaseResult caseFrom(const JsonFields& json) {
  CaseResult result;
  result.id = json.text("id");
  result.recording = recordingFrom(json.object("recording"));
  result.algorithm = json.text("algorithm");
  result.family = json.text("family");
  result.isa = named(json, "isa", kIsas);
  result.vectorised = json.boolean("vectorised");
  result.threads = json.integer<int>("threads", 1);
  // Not in files of earlier versions.
  if (json.has("device")) result.device = json.text("device");
  if (json.has("plugin")) result.plugin = json.text("plugin");
  result.parameters = parametersFrom(json.at("params"), json.path("params"));
  if (json.has("answer")) result.answer = named(json, "answer", kAnswerKinds);
  result.status = named(json, "status", kStatuses);
  result.reason = json.text("reason");
  result.pairs_mean = json.object("pairs").number("mean");
  result.pairs_max = json.object("pairs").integer<std::uint64_t>("max");
  if (json.has("bodies")) {
    const JsonFields bodies = json.object("bodies");
    result.bodies = {bodies.number("mean"), bodies.integer<std::uint64_t>("max")};
  }
  result.checked = json.boolean("checked");
  json.eachObject("differences", [&](const JsonFields& difference) {
    result.differences.push_back(differenceFrom(difference));
  });
  result.missed_count = json.integer<std::uint64_t>("missed");
  result.invalid_count = json.integer<std::uint64_t>("invalid");
  if (json.has("extra")) {  // an earlier file: see differenceFrom()
    for (const FrameDifference& d : result.differences) result.false_count += d.false_count;
    const auto extra = json.integer<std::uint64_t>("extra");
    result.allowed_extra_count = extra - std::min(extra, result.false_count);
  } else {
    result.false_count = json.integer<std::uint64_t>("false");
    result.allowed_extra_count = json.integer<std::uint64_t>("allowed_extra");
  }
  if (json.has("counters")) {
    const JsonFields counters = json.object("counters");
    for (const auto& [name, count] : json.at("counters").items()) {
      result.counters[name] = counters.number(name.c_str());
    }
  }
  if (json.has("setup")) {
    const JsonFields setup = json.object("setup");
    for (const auto& [name, count] : json.at("setup").items()) {
      result.setup[name] = setup.integer<std::uint64_t>(name.c_str());
    }
  }
  if (json.has("peak_bytes")) result.peak_bytes = json.integer<std::uint64_t>("peak_bytes");
  result.repetitions =
      framesFrom(json.object("frames"), json.array("initialize_ns"), json.path("initialize_ns"));
  if (json.has("processor")) readProcessor(json.object("processor"), result.repetitions);
  if (json.has("conditions")) {  // since results/2
    result.environment = json.integer<std::size_t>("environment");
    result.conditions = conditionsFrom(json.object("conditions"));
    result.frames = frameCountsFrom(json.object("frame_counts"));
    readYardsticks(json.object("yardsticks"), result.repetitions);
  } else {
    result.conditions.repetitions = static_cast<int>(result.repetitions.size());
  }
  return result;
}

constexpr std::string_view kResults1 = "broadmark-results/1";

void requireResults(const JsonFields& file, std::string_view name) {
  if (file.has("schema") && isResultsSchema(file.text("schema"))) return;
  throw InputError(
      fmt::format("{}: not a results file: \"schema\" is not \"{}\"", name, kResultsSchema));
}

/// Every case belongs to an environment that is there.
void requireEnvironments(const Results& results, std::string_view name) {
  for (const CaseResult& result : results.cases) {
    if (result.environment < results.environments.size()) continue;
    throw InputError(fmt::format("{}: case '{}': there is no environment {}", name, result.id,
                                 result.environment));
  }
}

Results documentFrom(const JsonFields& file) {
  Results results;
  if (file.text("schema") == kResults1) {
    results.environments = {environmentFrom(file.object("environment"))};
    results.complete = true;  // it did not say
  } else {
    file.eachObject("environments", [&](const JsonFields& one) {
      results.environments.push_back(environmentFrom(one));
    });
    results.complete = file.boolean("complete");
  }
  results.options = file.texts("options");
  file.eachObject("cases", [&](const JsonFields& one) { results.cases.push_back(caseFrom(one)); });
  return results;
}

/// Takes over one line but the first.
void takeLine(Results& results, const JsonFields& line) {
  if (results.complete) throw InputError(line.name() + ": after the line that ends the results");
  if (line.has("environment")) {
    results.environments.push_back(environmentFrom(line.object("environment")));
  } else if (line.has("case")) {
    results.cases.push_back(caseFrom(line.object("case")));
  } else if (line.has("end")) {
    results.complete = line.object("end").boolean("complete");
  } else {
    throw InputError(line.name() + ": neither an environment, a case nor the end");
  }
}

/// The first line of a text; the text goes on after it.
std::string_view takeFirstLine(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

Results linesFrom(const JsonFields& first, std::string_view rest, std::string_view name) {
  Results results;
  results.options = first.texts("options");
  for (int number = 2; !rest.empty(); ++number) {
    const bool whole = rest.find('\n') != std::string_view::npos;
    const std::string_view line = takeFirstLine(rest);
    if (!whole && jsonOrNull(line).is_null()) break;  // the run ended while it was written
    const std::string place = fmt::format("{}: line {}", name, number);
    const Json json = parseJson(line, place);
    takeLine(results, JsonFields(json, place));
  }
  return results;
}

/// The first line of JSON Lines, or null for what is no such file.
Json headOfLines(std::string_view text) {
  Json head = jsonOrNull(takeFirstLine(text));
  const auto has = [&](const char* key) { return head.contains(key); };
  // A document on one line, even a damaged one, has some of these.
  const bool is_document = has("cases") || has("environments") || has("environment");
  return head.is_object() && has("schema") && !is_document ? head : nullptr;
}

std::string lineOf(const Json& json) { return formatJson(json, -1); }

std::string linesBefore(const Results& results) {
  std::string text = lineOf({{"schema", kResultsSchema}, {"options", results.options}});
  for (const Environment& environment : results.environments) {
    text += lineOf({{"environment", toJson(environment)}});
  }
  return text;
}

std::string lineOfCase(const CaseResult& result) { return lineOf({{"case", toJson(result)}}); }

std::string linesAfter(const Results& results) {
  return lineOf({{"end", {{"complete", results.complete}, {"cases", results.cases.size()}}}});
}

}  // namespace

std::string formatJsonResults(const Results& results) {
  Json json = {{"schema", kResultsSchema},
               {"options", results.options},
               {"environments", Json::array()},
               {"complete", results.complete},
               {"cases", Json::array()}};
  for (const Environment& one : results.environments) json["environments"].push_back(toJson(one));
  for (const CaseResult& result : results.cases) json["cases"].push_back(toJson(result));
  return formatJson(json);
}

const ResultWriter::Lines& jsonLines() {
  static constexpr ResultWriter::Lines kLines{
      .before = linesBefore, .one = lineOfCase, .after = linesAfter};
  return kLines;
}

std::string formatJsonLines(const Results& results) {
  std::string text = linesBefore(results);
  for (const CaseResult& result : results.cases) text += lineOfCase(result);
  return text + linesAfter(results);
}

bool isResultsSchema(std::string_view schema) {
  return schema == kResultsSchema || schema == kResults1;
}

Results parseResults(std::string_view text, std::string_view name) {
  const Json head = headOfLines(text);
  const Json json = head.is_null() ? parseJson(text, name) : head;
  const JsonFields file(json, std::string(name));
  requireResults(file, name);
  takeFirstLine(text);
  Results results = head.is_null() ? documentFrom(file) : linesFrom(file, text, name);
  requireEnvironments(results, name);
  return results;
}

}  // namespace broadmark
