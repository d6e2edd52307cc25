// broadmark SOURCE…: a plan, and what is done with it.

#include "commands/session.h"

#include <fmt/format.h>

#include "broadmark/error.h"
#include "export_case.h"
#include "headless.h"
#include "inspector/inspect.h"
#include "inspector/session.h"
#include "plan.h"

namespace broadmark {
namespace {

int listCases(const Plan& plan) {
  for (const std::string& id : caseIds(plan)) fmt::print("{}\n", id);
  return 0;
}

int runInspector(Plan plan, const SessionOptions& options) {
  std::vector<Algorithm> algorithms = plan.algorithms;
  // std::function wants to be copied, and a plan cannot be.
  const auto shared = std::make_shared<Plan>(std::move(plan));
  const InspectOptions inspect{
      .algorithms = std::move(algorithms),
      .begin =
          [shared, make_host = hostMaker(options.hosts)](Session& session) {
            session.make_host = make_host;
            session.open(std::move(*shared));
          },
      .script = options.script,
      .screenshot = options.screenshot,
      .width = options.picture.width,
      .height = options.picture.height,
      .gl = options.picture.gl};
  try {
    if (options.headless) {
      inspectOffscreen(inspect);
    } else {
      inspectInWindow(inspect);
    }
  } catch (const RenderError& error) {
    throw InputError(options.headless
                         ? error.what()
                         : fmt::format("{} (--headless runs without a window)", error.what()));
  }
  return 0;
}

}  // namespace

int runSession(const SessionOptions& options) {
  Plan plan = makePlan(options);
  if (options.list_only) return listCases(plan);
  if (options.inspector()) return runInspector(std::move(plan), options);
  if (!options.export_case.empty()) return runExportCase(std::move(plan), options);
  return runHeadless(std::move(plan), options);
}

}  // namespace broadmark
