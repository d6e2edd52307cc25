// From options to a plan.

#include "run/plan.h"

#include <fmt/format.h>

#include <iterator>
#include <regex>

#include "broadmark/error.h"
#include "broadmark/harness/runner.h"
#include "command_line/session_options.h"
#include "request/plugins.h"
#include "request/sweep.h"
#include "run/screenshot.h"
#include "sources/results.h"

namespace broadmark {
namespace {

/// Opens one source; its entries still have only cases of their own.
void addSource(Plan& plan, const std::string& name, const SessionOptions& options) {
  OpenedSource opened = openSource(name, {.scene = options.scene,
                                          .parameters = options.parameters,
                                          .reading = options.reading,
                                          .case_id = options.case_id,
                                          .algorithms = plan.algorithms});
  if (opened.results) {
    if (!options.inspector()) throw missingCase(*opened.results, name);
    plan.unchosen_case = {.file = name, .results = std::move(*opened.results)};
  }
  for (PlanEntry& entry : opened.entries) {
    if (!options.case_id.empty() && !entry.known) {
      throw InputError(fmt::format("--case: {}: not a results file", name));
    }
    plan.entries.push_back(std::move(entry));
  }
}

/// The cases that the options select. The inspector begins without any, if none are named.
std::vector<Case> selectedCases(const Plan& plan, const SessionOptions& options) {
  if (options.inspector() && options.cases.algorithms.empty()) return {};
  return selectCases(options.cases, options.parameters, plan.algorithms);
}

void addCases(PlanEntry& entry, const std::vector<Case>& selected, const SessionOptions& options) {
  if (entry.cases.empty()) {
    entry.cases = selected;
    return;
  }
  if (!options.cases.algorithms.empty()) {
    throw InputError("--algorithm: the source names its own algorithm");
  }
  // The case of a results file states its device and its answer, too.
  if (entry.known) return;
  for (Case& run : entry.cases) {
    run.device = options.cases.device;
    run.answer = options.cases.answer;
  }
}

/// Throws InputError for a --param that no scene and no algorithm has.
void requireParametersUsed(const Plan& plan, const SessionOptions& options) {
  if (options.parameters.empty()) return;
  std::vector<std::string> names;
  std::vector<Case> cases = plan.cases;
  for (const PlanEntry& entry : plan.entries) {
    cases.insert(cases.end(), entry.cases.begin(), entry.cases.end());
    if (!entry.source.simulation) continue;
    std::ranges::move(parameterNames(*entry.source.simulation), std::back_inserter(names));
  }
  requireUsedParameters(options.parameters, cases, std::move(names), plan.algorithms);
}

std::regex compiledFilter(const std::string& filter) {
  try {
    return std::regex(filter);
  } catch (const std::regex_error&) {
    throw InputError(fmt::format("--filter: '{}' is not a regular expression", filter));
  }
}

/// Keeps the cases that pass the filter and are part of the shard.
void divide(Plan& plan, const SessionOptions& options) {
  const std::regex filter = compiledFilter(options.filter);
  int number = 0;
  for (PlanEntry& entry : plan.entries) {
    std::erase_if(entry.cases, [&](const Case& run) {
      if (!std::regex_search(caseId(entry.source.reference, run), filter)) return true;
      return number++ % options.shard.count != options.shard.index;
    });
  }
}

/// Throws InputError for a parameter out of range.
void requireSound(const Plan& plan) {
  for (const Case& run : plan.cases) static_cast<void>(makeInstance(run));
  for (const PlanEntry& entry : plan.entries) {
    for (const Case& run : entry.cases) static_cast<void>(makeInstance(run));
  }
}

/// Throws InputError unless the frame that is to be shown is in every recording.
void requireFrame(const Plan& plan, const SessionOptions& options) {
  if (!options.frame) return;
  if (options.inspector() && plan.entries.empty()) {
    throw InputError("--frame: nothing is opened that has frames");
  }
  for (const PlanEntry& entry : plan.entries) {
    const SceneInfo& scene = entry.source.reference.scene;
    if (*options.frame <= scene.frames) continue;
    throw InputError(fmt::format("--frame: there is no frame {}: the last one of {} is {}",
                                 *options.frame, scene.name, scene.frames));
  }
}

void nameScreenshots(Plan& plan, const SessionOptions& options) {
  std::vector<std::string> names;
  for (const PlanEntry& entry : plan.entries) {
    const RecordingReference& reference = entry.source.reference;
    names.push_back(fmt::format("{} {} N{}{}", reference.scene.name, reference.scene.object_type,
                                reference.scene.objects, sweptText(reference.swept)));
  }
  const auto paths = screenshotPaths(options.screenshot, names);
  for (std::size_t i = 0; i < paths.size(); ++i) plan.entries[i].screenshot = paths[i];
}

}  // namespace

Plan makePlan(const SessionOptions& options) {
  return makePlan(options, availableAlgorithms(options.plugins));
}

Plan makePlan(const SessionOptions& options, std::vector<Algorithm> algorithms) {
  Plan plan{.algorithms = std::move(algorithms)};
  for (const std::string& source : options.sources) addSource(plan, source, options);
  const std::vector<Case> selected = selectedCases(plan, options);
  for (PlanEntry& entry : plan.entries) addCases(entry, selected, options);
  if (options.sources.empty()) plan.cases = selected;
  requireParametersUsed(plan, options);
  requireReadingUsed(options.reading, plan.entries);
  requireSound(plan);
  if (!options.inspector()) {
    divide(plan, options);
    std::erase_if(plan.entries, [](const PlanEntry& entry) { return entry.cases.empty(); });
    if (!options.screenshot.empty()) nameScreenshots(plan, options);
  }
  requireFrame(plan, options);
  return plan;
}

std::vector<std::string> caseIds(const Plan& plan) {
  std::vector<std::string> ids;
  for (const PlanEntry& entry : plan.entries) {
    for (const Case& run : entry.cases) ids.push_back(caseId(entry.source.reference, run));
  }
  return ids;
}

}  // namespace broadmark
