// broadmark SOURCE…: a plan, and what is done with it.

#include "commands/session.h"

#include <fmt/format.h>

#include "command_line/option_types.h"
#include "command_line/run_requests.h"
#include "inspector/run_inspector.h"
#include "request/plugins.h"
#include "run/export_case.h"
#include "run/headless.h"
#include "run/plan.h"
#include "support/exit_status.h"
#include "support/output.h"

namespace broadmark {
namespace {

int listCases(const Plan& plan) {
  for (const std::string& id : caseIds(plan)) fmt::print("{}\n", id);
  return exit_status::fine;
}

/// Throws InputError if the options need what has been left out of this build.
void requireParts(const SessionOptions& options) {
  if (!options.screenshot.empty()) requirePart(parts::kRenderer, "--screenshot");
  if (!options.cases.device.empty()) requirePart(parts::kOpenCl, "--device");
}

}  // namespace

int runSession(const SessionOptions& options) {
  addEnginesOf(options.plugins);
  Plan plan = makePlan(options, options.inspector() ? PlanUse::open : PlanUse::run);
  if (!options.written_request.empty()) {
    writeOutput(options.written_request, formatRunRequest(options));
    return exit_status::fine;
  }
  if (options.list_only) return listCases(plan);
  requireParts(options);
  if (options.inspector()) {
    return runInspector(std::move(plan), !options.headless, options.script);
  }
  if (!options.export_case.empty()) {
    return runExportCase(std::move(plan), options.export_case, options.quiet);
  }
  return runHeadless(std::move(plan), options.quiet);
}

}  // namespace broadmark
