// Results files: one of their cases, on the recording it ran on.

#include "sources/results.h"

#include <fmt/format.h>

#include <algorithm>

#include "broadmark/names.h"
#include "broadmark/recordings/adapted_frames.h"
#include "request/cases.h"
#include "sources/make_source.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

bool hasMismatch(const CaseResult& result) { return !result.differences.empty(); }

/// A few ids that can be passed to --case.
std::string someIds(const Results& results) {
  constexpr std::size_t kMaxShown = 3;
  std::vector<std::string> wrong;
  for (const CaseResult& result : results.cases) {
    if (hasMismatch(result)) wrong.push_back(result.id);
  }
  if (results.cases.empty()) return "it has no cases";
  if (wrong.empty()) {
    return fmt::format("all answers are correct; e.g. '{}'", results.cases.front().id);
  }
  std::string text = "with wrong answers:";
  for (std::size_t i = 0; i < std::min(wrong.size(), kMaxShown); ++i) {
    text += fmt::format("{} '{}'", i > 0 ? "," : "", wrong[i]);
  }
  if (wrong.size() > kMaxShown) text += fmt::format(" and {} more", wrong.size() - kMaxShown);
  return text;
}

/// Returns the result with this id; if there are several, the first with a mismatch.
const CaseResult& resultOf(const Results& results, const std::string& id, const std::string& file) {
  const CaseResult* found = nullptr;
  const std::string current_id = currentCaseId(id);
  std::vector<std::string> ids;
  for (const CaseResult& result : results.cases) {
    ids.push_back(result.id);
    const bool better = found == nullptr || (!hasMismatch(*found) && hasMismatch(result));
    if (result.id == current_id && better) found = &result;
  }
  if (found != nullptr) return *found;
  const std::string nearest = nearestName(id, ids);
  throw InputError(
      fmt::format("{}: no case '{}'; {}", file, id,
                  nearest.empty() ? someIds(results) : fmt::format("did you mean '{}'?", nearest)));
}

const Algorithm& algorithmOf(const CaseResult& result, const std::vector<Algorithm>& known) {
  if (const Algorithm* found = findAlgorithm(result.algorithm, known)) return *found;
  // Not loaded automatically: a data file must not choose the code to run.
  if (!result.plugin.empty()) {
    throw InputError(
        fmt::format("algorithm '{}' is in a library that is not loaded: add --plugin {}",
                    result.algorithm, result.plugin));
  }
  return requireAlgorithm(result.algorithm, known);
}

/// Recreates the simulation that a case ran on.
Source recreatedSimulation(const RecordingReference& reference, const fs::path& results_file) {
  ParameterValues parameters = reference.scene_parameters;
  if (const auto file = parameters.extract(kSceneFile)) {
    NamedSource scene(resolvedPath(results_file, file.mapped()).string());
    auto simulation = parseSceneParameters(scene.text(), scene.name());
    setParameters(*simulation, parameters);
    return simulationSource(std::move(simulation));
  }
  const auto engine = parameters.find("engine");  // adds parameters
  const std::string name = unadaptedName(reference.scene.name, reference.reading);
  auto simulation = makeSimulation(name, engine == parameters.end() ? "" : engine->second);
  setParameters(*simulation, parameters);
  return simulationSource(std::move(simulation));
}

/// Source that a case ran on; opening it verifies the hash.
Source sourceOf(const RecordingReference& reference, const fs::path& results_file) {
  ReadingOptions reading;
  setParameters(reading, reference.reading);
  Source source;
  if (reference.path.empty()) {
    source = recreatedSimulation(reference, results_file);
    adaptBoxes(source, reading);
  } else {
    source = fileSource({resolvedPath(results_file, reference.path).string()}, reading);
  }
  source.reference.swept = reference.swept;
  source.expected_hash = reference.hash;
  return source;
}

}  // namespace

InputError missingCase(const Results& results, const fs::path& results_file) {
  return InputError(fmt::format("{}: a results file: choose a case with --case ID; {}",
                                results_file.string(), someIds(results)));
}

PlanEntry entryOf(const CaseResult& result, const fs::path& results_file,
                  const std::vector<Algorithm>& algorithms) {
  const Algorithm& algorithm = algorithmOf(result, algorithms);
  const Case test_case =
      makeCase(algorithm, result.isa, result.threads, result.device,
               changedValues(result.parameters, *algorithm.create()), result.answer);
  return {.source = sourceOf(result.recording, results_file),
          .cases = {test_case},
          .original = {},
          .known = result};
}

std::string obstacleTo(const CaseResult& result, const fs::path& results_file,
                       const std::vector<Algorithm>& algorithms) {
  try {
    algorithmOf(result, algorithms);
  } catch (const InputError& error) {
    return error.what();
  }
  const std::string& stated = result.recording.path;
  if (stated.empty()) return "";
  const std::string file = resolvedPath(results_file, stated).string();
  if (fs::exists(file) || importOf(file)) return "";
  return fmt::format("{}: the recording no longer exists", file);
}

namespace sources::results {
namespace {

OpenedSource open(NamedSource& source, const OpeningOptions& options) {
  Results results = parseResults(source.text(), source.name());
  if (!options.case_id.empty()) {
    return OpenedSource(entryOf(resultOf(results, options.case_id, source.name()), source.path(),
                                options.algorithms));
  }
  OpenedSource opened;
  opened.results = std::move(results);
  return opened;
}

}  // namespace

SourceKind kind() {
  return {
      .what = fmt::format("results with --case (.json, .jsonl, \"{}\")", kResultsSchema),
      .recognises =
          [](NamedSource& source) { return source.isJson() && isResultsSchema(source.schema()); },
      .open = open};
}

}  // namespace sources::results
}  // namespace broadmark
