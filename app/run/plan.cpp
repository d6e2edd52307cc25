// Resolves a request into a plan.

#include "run/plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iterator>
#include <regex>
#include <set>

#include "broadmark/error.h"
#include "broadmark/harness/runner.h"
#include "request/plugins.h"
#include "request/sweep.h"
#include "sources/results.h"

namespace broadmark {
namespace {

/// Opens a source and adds its entries, before the plan's cases are added to them.
void addSource(Plan& plan, const std::string& name, PlanUse use) {
  const RunRequest& request = plan.request;
  OpenedSource opened = openSource(name, {.scene = request.scene,
                                          .parameters = request.parameters,
                                          .reading = request.reading,
                                          .case_id = request.case_id,
                                          .algorithms = plan.algorithms});
  if (opened.results) {
    if (use == PlanUse::run) throw missingCase(*opened.results, name);
    plan.unchosen_case = {.file = name, .results = std::move(*opened.results)};
  }
  for (PlanEntry& entry : opened.entries) {
    if (!request.case_id.empty() && !entry.known) {
      throw InputError(fmt::format("--case: {}: not a results file", name));
    }
    plan.entries.push_back(std::move(entry));
  }
}

void addCases(PlanEntry& entry, const std::vector<Case>& selected, const CaseOptions& options) {
  if (entry.cases.empty()) {
    entry.cases = selected;
    return;
  }
  if (!options.algorithms.empty()) {
    throw InputError("--algorithm: the source already states its algorithm");
  }
  // A case of a results file already has its device and answer.
  if (entry.known) return;
  for (Case& test_case : entry.cases) {
    test_case.device = options.device;
    test_case.answer = options.answer;
  }
}

/// Throws InputError for a --param that no scene and no algorithm has.
void requireParametersUsed(const Plan& plan) {
  if (plan.request.parameters.empty()) return;
  std::vector<std::string> names;
  std::vector<Case> cases = plan.cases;
  for (const PlanEntry& entry : plan.entries) {
    cases.insert(cases.end(), entry.cases.begin(), entry.cases.end());
    if (!entry.source.simulation) continue;
    std::ranges::move(parameterNames(*entry.source.simulation), std::back_inserter(names));
  }
  requireUsedParameters(plan.request.parameters, cases, std::move(names), plan.algorithms);
}

std::regex compiledFilter(const std::string& filter) {
  try {
    return std::regex(filter);
  } catch (const std::regex_error&) {
    throw InputError(fmt::format("--filter: '{}' is not a regular expression", filter));
  }
}

/// Removes the cases that do not match the filter or belong to another shard.
void applyFilterAndShard(Plan& plan) {
  const std::regex filter = compiledFilter(plan.request.filter);
  const Shard& shard = plan.request.shard;
  int number = 0;
  for (PlanEntry& entry : plan.entries) {
    std::erase_if(entry.cases, [&](const Case& test_case) {
      if (!std::regex_search(caseId(entry.source.reference, test_case), filter)) return true;
      return number++ % shard.count != shard.index;
    });
  }
  std::erase_if(plan.entries, [](const PlanEntry& entry) { return entry.cases.empty(); });
}

/// Throws InputError for a parameter out of range.
void validateParameters(const Plan& plan) {
  for (const Case& test_case : plan.cases) static_cast<void>(makeInstance(test_case));
  for (const PlanEntry& entry : plan.entries) {
    for (const Case& test_case : entry.cases) static_cast<void>(makeInstance(test_case));
  }
}

/// Throws InputError unless every recording has the requested frame.
void requireFrame(const Plan& plan, PlanUse use) {
  const std::optional<std::uint32_t> frame = plan.request.frame;
  if (!frame) return;
  if (use == PlanUse::open && plan.entries.empty()) {
    throw InputError("--frame: no recording to open");
  }
  for (const PlanEntry& entry : plan.entries) {
    const SceneInfo& scene = entry.source.reference.scene;
    if (*frame <= scene.frames) continue;
    throw InputError(fmt::format("--frame: there is no frame {}: the last frame of {} is {}",
                                 *frame, scene.name, scene.frames));
  }
}

/// Throws InputError for a recording without a frame to run, unless its initial pose is drawn.
void requireFrames(const Plan& plan) {
  for (const PlanEntry& entry : plan.entries) {
    const RecordingReference& reference = entry.source.reference;
    if (reference.scene.frames > 0 || !plan.request.screenshot.empty()) continue;
    throw InputError(fmt::format(
        "{}: there is nothing to run: it holds one frame, the initial pose, which is not timed; a "
        "sequence of files, an animation or a trajectory is expected",
        reference.path.empty() ? reference.scene.name : reference.path));
  }
}

/// Names the screenshot of each entry: the requested name, followed by that of the recording if
/// there are several.
void nameScreenshots(Plan& plan) {
  const std::filesystem::path& requested = plan.request.screenshot;
  if (requested.empty()) return;
  std::set<std::filesystem::path> used;
  for (PlanEntry& entry : plan.entries) {
    const SceneInfo& scene = entry.source.reference.scene;
    const std::string name =
        fmt::format("{} {} {} N{}{}", requested.stem().string(), scene.name, scene.object_type,
                    scene.objects, sweptText(entry.source.reference.swept));
    entry.screenshot = requested;
    if (plan.entries.size() == 1) return;
    entry.screenshot.replace_filename(name + requested.extension().string());
    // Two recordings may differ only in their boxes.
    for (int k = 2; !used.insert(entry.screenshot).second; ++k) {
      entry.screenshot.replace_filename(
          fmt::format("{} ({}){}", name, k, requested.extension().string()));
    }
  }
}

}  // namespace

Plan makePlan(const RunRequest& request, PlanUse use) {
  return makePlan(request, use, availableAlgorithms(request.plugins));
}

Plan makePlan(const RunRequest& request, PlanUse use, std::vector<Algorithm> algorithms) {
  Plan plan{.request = request, .algorithms = std::move(algorithms)};
  if (use == PlanUse::run) prepareCount(plan.request);
  for (const std::string& source : request.sources) addSource(plan, source, use);
  const CaseOptions& cases = plan.request.cases;
  std::vector<Case> selected;
  if (use == PlanUse::run || !cases.algorithms.empty()) {
    selected = selectCases(cases, request.parameters, plan.algorithms);
  }
  for (PlanEntry& entry : plan.entries) addCases(entry, selected, cases);
  if (request.sources.empty()) plan.cases = selected;
  requireParametersUsed(plan);
  requireReadingUsed(request.reading, plan.entries);
  validateParameters(plan);
  if (use == PlanUse::run) {
    applyFilterAndShard(plan);
    for (const PlanEntry& entry : plan.entries) {
      if (request.count.instructions) requireOneThread(entry.cases);
    }
    requireFrames(plan);
    nameScreenshots(plan);
  }
  requireFrame(plan, use);
  return plan;
}

void requireSupportedIsa(const Plan& plan) {
  for (const PlanEntry& entry : plan.entries) {
    for (const Case& test_case : entry.cases) {
      if (!test_case.algorithm.traits.vectorised || isaSupported(test_case.isa)) return;
    }
  }
  std::vector<std::string_view> supported;
  for (const Isa isa : supportedIsas()) supported.push_back(isaName(isa));
  throw InputError(
      fmt::format("--isa: {}: not supported by this processor, and all cases need it; "
                  "choose auto or one of: {}",
                  isaName(plan.entries.front().cases.front().isa), fmt::join(supported, ", ")));
}

std::vector<std::string> caseIds(const Plan& plan) {
  std::vector<std::string> ids;
  for (const PlanEntry& entry : plan.entries) {
    for (const Case& test_case : entry.cases) {
      ids.push_back(caseId(entry.source.reference, test_case));
    }
  }
  return ids;
}

}  // namespace broadmark
