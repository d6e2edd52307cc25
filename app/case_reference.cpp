// Cases of results files, opened again.

#include "case_reference.h"

#include <fmt/format.h>

#include <algorithm>

#include "broadmark/files.h"
#include "broadmark/names.h"

namespace broadmark {
namespace {

namespace fs = std::filesystem;

bool hasFailed(const CaseResult& result) { return !result.differences.empty(); }

/// A few of the ids that can be given.
std::string someIds(const Results& results) {
  constexpr std::size_t kShown = 3;
  std::vector<std::string> failed;
  for (const CaseResult& result : results.cases) {
    if (hasFailed(result)) failed.push_back(result.id);
  }
  if (results.cases.empty()) return "it has no cases";
  if (failed.empty())
    return fmt::format("all its answers are right; e.g. '{}'", results.cases.front().id);
  std::string text = "with wrong answers:";
  for (std::size_t i = 0; i < std::min(failed.size(), kShown); ++i) {
    text += fmt::format("{} '{}'", i > 0 ? "," : "", failed[i]);
  }
  if (failed.size() > kShown) text += fmt::format(" and {} more", failed.size() - kShown);
  return text;
}

const CaseResult& caseOf(const Results& results, const std::string& id, const fs::path& file) {
  const CaseResult* found = nullptr;
  std::vector<std::string> ids;
  for (const CaseResult& result : results.cases) {
    ids.push_back(result.id);
    const bool better = found == nullptr || (!hasFailed(*found) && hasFailed(result));
    if (result.id == id && better) found = &result;
  }
  if (found != nullptr) return *found;
  const std::string nearest = nearestName(id, ids);
  throw InputError(
      fmt::format("--case: {}: no case '{}'; {}", file.string(), id,
                  nearest.empty() ? someIds(results) : fmt::format("did you mean '{}'?", nearest)));
}

const Algorithm& algorithmOf(const CaseResult& result, const std::vector<Algorithm>& known) {
  const auto found = std::ranges::find(known, result.algorithm, &Algorithm::id);
  if (found != known.end()) return *found;
  // Never loaded unasked: that would run whatever code a data file names.
  if (!result.plugin.empty()) {
    throw InputError(
        fmt::format("--case: algorithm '{}' is of the library {}: add --plugin with it",
                    result.algorithm, result.plugin));
  }
  std::vector<std::string> ids;
  for (const Algorithm& algorithm : known) ids.push_back(algorithm.id);
  throw InputError("--case: " + unknownName("algorithm", result.algorithm, ids));
}

/// Those of an algorithm's parameters that differ from the default.
ParameterValues changed(const Algorithm& algorithm, ParameterValues values) {
  const ParameterValues defaults = parameterValues(*algorithm.create());
  std::erase_if(values, [&](const auto& value) {
    const auto at_first = defaults.find(value.first);
    return at_first != defaults.end() && at_first->second == value.second;
  });
  return values;
}

std::optional<FrameDifference> firstDifference(const CaseResult& result) {
  const auto first = std::ranges::min_element(result.differences, {}, &FrameDifference::frame);
  if (first == result.differences.end()) return std::nullopt;
  return *first;
}

/// A word as the shell takes it.
std::string quoted(const std::string& word) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// A path that is not taken for an option.
std::string pathWord(const fs::path& path) {
  const std::string text = path.string();
  return quoted(text.starts_with('-') ? "./" + text : text);
}

}  // namespace

CaseReference openCase(const fs::path& results_file, const std::string& id,
                       const std::vector<Algorithm>& known) {
  const Results results = parseResults(readTextFile(results_file), results_file.string());
  CaseReference reference;
  reference.result = caseOf(results, id, results_file);
  const CaseResult& result = reference.result;
  const Algorithm& algorithm = algorithmOf(result, known);
  reference.run = {.algorithm = algorithm,
                   .isa = result.isa,
                   .threads = result.threads,
                   .device = result.device,
                   .parameters = changed(algorithm, result.parameters)};
  reference.source = referredSource(result.recording, results_file);
  reference.difference = firstDifference(result);
  return reference;
}

InputError missingCase(const Results& results, const fs::path& results_file) {
  return InputError(fmt::format("{}: a results file: which case? add --case ID; {}",
                                results_file.string(), someIds(results)));
}

void requireExportable(const fs::path& file, const fs::path& original) {
  if (file.extension() != kAabbsExtension) {
    throw InputError(fmt::format("exporting a case: {}: a name that ends in {} is expected",
                                 file.string(), kAabbsExtension));
  }
  if (!original.empty() && fs::weakly_canonical(file) == fs::weakly_canonical(original)) {
    throw InputError(fmt::format(
        "exporting a case: {}: the recording itself: another name is needed", file.string()));
  }
  AtomicFile probe(file);
}

std::string reproducingCommand(const Case& run, const fs::path& recording) {
  std::string command = "broadmark --headless " + pathWord(recording);
  const auto add = [&](std::string_view option, const std::string& word) {
    command += fmt::format(" {} {}", option, word);
  };
  if (!run.algorithm.plugin.empty()) add("--plugin", pathWord(run.algorithm.plugin));
  add("--algorithm", quoted(run.algorithm.id));
  if (run.algorithm.vectorised) add("--isa", std::string(isaName(run.isa)));
  if (run.algorithm.parallel) add("--threads", fmt::format("{}", run.threads));
  if (!run.device.empty()) add("--device", quoted(run.device));
  for (const auto& [key, value] : run.parameters) add("--param", quoted(key + "=" + value));
  add("--check", "full");
  return command;
}

}  // namespace broadmark
