#include "json_case.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "broadmark/harness/case.h"
#include "broadmark/results/case_columns.h"

namespace broadmark {
namespace {

Json jsonOf(const ColumnValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* integer = std::get_if<std::uint64_t>(&value)) return *integer;
  if (const auto* number = std::get_if<double>(&value)) return *number;
  return nullptr;
}

/// The columns of a case.
Json columnsToJson(const CaseResult& result, const Summary& summary) {
  Json json = Json::object();
  for (const CaseColumn& column : caseColumns()) {
    if (!column.read && !column.json.derived) continue;
    json[Json::json_pointer('/' + column.json.path)] = jsonOf(column.value(result, summary));
  }
  return json;
}

void readColumn(const CaseColumn& column, const std::string& path, const JsonFields& json,
                CaseResult& result) {
  const std::size_t slash = path.find('/');
  if (slash != path.npos) {
    readColumn(column, path.substr(slash + 1), json.object(path.substr(0, slash).c_str()), result);
  } else if (!column.json.optional || json.has(path.c_str())) {
    column.read(json, path.c_str(), result);
  }
}

Json toJson(const Conditions& c) {
  return {{"check", kCheckModes.nameOf(c.check)},
          {"warmup", c.warmup},
          {"repetitions", c.repetitions},
          {"frame_limit_seconds", orNull(c.frame_limit_seconds)},
          {"initialize_limit_seconds", orNull(c.initialize_limit_seconds)},
          {"call_limit_seconds", orNull(c.call_limit_seconds)},
          {"counted_by", c.counted_by ? Json(kCounterSources.nameOf(*c.counted_by)) : Json()},
          {"in_process", c.in_process},
          {"pinned", c.pinned},
          {"load_average", c.load_average},
          {"plugin", {{"hash", c.plugin.hash}, {"flags", c.plugin.flags}}},
          {"warnings", c.warnings}};
}

Conditions conditionsFrom(const JsonFields& json) {
  Conditions c;
  c.check = json.named("check", kCheckModes);
  json.read("warmup", c.warmup);
  json.read("repetitions", c.repetitions);
  json.read("frame_limit_seconds", c.frame_limit_seconds);
  json.read("initialize_limit_seconds", c.initialize_limit_seconds);
  json.read("call_limit_seconds", c.call_limit_seconds);
  if (json.has("counted_by") && !json.at("counted_by").is_null()) {
    c.counted_by = json.named("counted_by", kCounterSources);
  }
  json.read("in_process", c.in_process);
  if (json.has("pinned")) json.read("pinned", c.pinned);
  json.read("load_average", c.load_average);
  const JsonFields plugin = json.object("plugin");
  c.plugin = {plugin.text("hash"), plugin.text("flags")};
  json.read("warnings", c.warnings);
  return c;
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

void addRecording(Json& json, const RecordingReference& recording) {
  const Aabb& world = recording.scene.world;
  json["world"] = {{"min", toJson(world.min)}, {"max", toJson(world.max)}};
  if (!recording.swept.empty()) json["swept"] = recording.swept;
  if (!recording.reading.empty()) json["reading"] = recording.reading;
  json["source"] = recording.path.empty() ? Json(recording.scene_parameters) : Json(recording.path);
}

void readRecording(const JsonFields& json, RecordingReference& recording) {
  const JsonFields world = json.object("world");
  recording.scene.world.min = cornerFrom(world.array("min"), world.path("min"));
  recording.scene.world.max = cornerFrom(world.array("max"), world.path("max"));
  if (json.has("swept")) json.read("swept", recording.swept);
  if (json.has("reading")) json.read("reading", recording.reading);
  if (json.at("source").is_string()) {
    recording.path = json.text("source");
  } else {
    json.read("source", recording.scene_parameters);
  }
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

/// Early files do not distinguish false and allowed extra pairs: "extra" holds both, and
/// "forbidden_count" the number of false ones.
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

}  // namespace

Json caseToJson(const CaseResult& result) {
  const Summary summary = result.summary();
  Json json = columnsToJson(result, summary);
  addRecording(json["recording"], result.recording);
  json["vectorised"] = result.vectorised;
  json["plugin"] = result.plugin;
  json["params"] = result.parameters;
  json["environment"] = result.environment;
  json["conditions"] = toJson(result.conditions);
  if (result.bodies) {
    json["bodies"] = {{"mean", result.bodies->mean}, {"max", result.bodies->max}};
  }
  json["checked"] = result.checked;
  json["differences"] = Json::array();
  for (const FrameDifference& difference : result.differences) {
    json["differences"].push_back(toJson(difference));
  }
  json["counters"] = result.counters;
  if (result.ageing)
    json["ageing"] = {{"early", result.ageing->early}, {"late", result.ageing->late}};
  json["setup"] = result.setup;
  json["summary"]["ci95"] =
      summary.ci95 ? Json{summary.ci95->low, summary.ci95->high} : Json(nullptr);
  addFrames(json, result);
  return json;
}

CaseResult caseFrom(const JsonFields& json) {
  CaseResult result;
  for (const CaseColumn& column : caseColumns()) {
    if (column.read) readColumn(column, column.json.path, json, result);
  }
  result.id = currentCaseId(result.id);
  readRecording(json.object("recording"), result.recording);
  result.threads = json.integer<int>("threads", 1);
  result.vectorised = json.boolean("vectorised");
  if (json.has("plugin")) result.plugin = json.text("plugin");  // missing in earlier files
  ParameterValues parameters;
  json.read("params", parameters);
  for (auto& [name, value] : parameters) {
    result.parameters.emplace(currentParameterName(name), std::move(value));
  }
  if (json.has("bodies")) {
    const JsonFields bodies = json.object("bodies");
    result.bodies = {bodies.number("mean"), bodies.integer<std::uint64_t>("max")};
  }
  result.checked = json.boolean("checked");
  json.eachObject("differences", [&](const JsonFields& difference) {
    result.differences.push_back(differenceFrom(difference));
  });
  if (json.has("extra")) {  // an earlier file: see differenceFrom()
    for (const FrameDifference& d : result.differences) result.false_count += d.false_count;
    const auto extra = json.integer<std::uint64_t>("extra");
    result.allowed_extra_count = extra - std::min(extra, result.false_count);
  } else {
    result.false_count = json.integer<std::uint64_t>("false");
    result.allowed_extra_count = json.integer<std::uint64_t>("allowed_extra");
  }
  if (json.has("counters")) json.read("counters", result.counters);
  if (json.has("ageing")) {
    const JsonFields ageing = json.object("ageing");
    ageing.read("early", result.ageing.emplace().early);
    ageing.read("late", result.ageing->late);
  }
  if (json.has("setup")) json.read("setup", result.setup);
  readFrames(json, result);
  if (json.has("conditions")) {  // since results/2
    result.environment = json.integer<std::size_t>("environment");
    result.conditions = conditionsFrom(json.object("conditions"));
  } else {
    result.conditions.repetitions = static_cast<int>(result.repetitions.size());
  }
  return result;
}

}  // namespace broadmark
