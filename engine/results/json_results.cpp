// Results as JSON ("schema": "broadmark-results/2") and back: as one document, or as lines of
// JSON. Also reads earlier files ("broadmark-results/1").

#include <fmt/format.h>

#include "json_case.h"
#include "result_writers.h"

namespace broadmark {
namespace {

/// Calls visit(key, value) for each JSON field of an environment.
template <class EnvironmentType, class Visit>
void visitFields(EnvironmentType& e, Visit&& visit) {
  visit("host", e.host);
  visit("cpu", e.cpu);
  visit("logical_cores", e.logical_cores);
  visit("physical_cores", e.physical_cores);
  visit("caches", e.caches);
  visit("isa", e.isa);
  visit("memory_bytes", e.memory_bytes);
  visit("governor", e.governor);
  visit("load_average", e.load_average);
  visit("os", e.os);
  visit("compiler", e.compiler);
  visit("compiler_flags", e.compiler_flags);
  visit("build_type", e.build_type);
  visit("version", e.version);
  visit("commit", e.commit);
  visit("commit_date", e.commit_date);
  visit("dirty", e.dirty);
  visit("started", e.started);
  visit("compute_devices", e.compute_devices);
}

Json toJson(const Environment& environment) {
  Json json;
  visitFields(environment, [&](const char* key, const auto& value) { json[key] = value; });
  return json;
}

Environment environmentFrom(const JsonFields& json) {
  Environment environment;
  visitFields(environment, [&](const char* key, auto& value) {
    const std::string_view name = key;
    // Missing in earlier files.
    const bool is_newer = name == "host" || name == "compute_devices" || name == "commit" ||
                          name == "commit_date" || name == "dirty";
    if (!is_newer || json.has(key)) json.read(key, value);
  });
  return environment;
}

constexpr std::string_view kResults1 = "broadmark-results/1";

void requireResults(const JsonFields& file, std::string_view name) {
  if (file.has("schema") && isResultsSchema(file.text("schema"))) return;
  throw InputError(
      fmt::format("{}: not a results file: \"schema\" is not \"{}\"", name, kResultsSchema));
}

/// Every case must refer to an existing environment.
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
    results.complete = true;  // not recorded in results/1
  } else {
    file.eachObject("environments", [&](const JsonFields& environment) {
      results.environments.push_back(environmentFrom(environment));
    });
    results.complete = file.boolean("complete");
  }
  results.options = file.texts("options");
  file.eachObject(
      "cases", [&](const JsonFields& test_case) { results.cases.push_back(caseFrom(test_case)); });
  return results;
}

/// Parses a line after the first.
void readLine(Results& results, const JsonFields& line) {
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

/// Splits off the first line of a text.
std::string_view splitFirstLine(std::string_view& text) {
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
    const std::string_view line = splitFirstLine(rest);
    if (!whole && jsonOrNull(line).is_null()) break;  // the run ended during the write
    const std::string location = fmt::format("{}: line {}", name, number);
    const Json json = parseJson(line, location);
    readLine(results, JsonFields(json, location));
  }
  return results;
}

/// The first line of JSON Lines, or null for other files.
Json headOfLines(std::string_view text) {
  Json head = jsonOrNull(splitFirstLine(text));
  const auto has = [&](const char* key) { return head.contains(key); };
  // A document on one line, even a damaged one, has one of these keys.
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

std::string lineOfCase(const CaseResult& result) { return lineOf({{"case", caseToJson(result)}}); }

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
  for (const Environment& environment : results.environments) {
    json["environments"].push_back(toJson(environment));
  }
  for (const CaseResult& result : results.cases) json["cases"].push_back(caseToJson(result));
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
  splitFirstLine(text);
  Results results = head.is_null() ? documentFrom(file) : linesFrom(file, text, name);
  requireEnvironments(results, name);
  return results;
}

}  // namespace broadmark
