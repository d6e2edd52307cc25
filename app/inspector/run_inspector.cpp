#include "inspector/run_inspector.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "broadmark/error.h"
#include "command_line/session_options.h"
#include "inspector/inspect.h"
#include "inspector/session/session.h"
#include "request/hosts.h"
#include "run/plan.h"

namespace broadmark {

int runInspector(Plan plan, const SessionOptions& options) {
  std::vector<Algorithm> algorithms = plan.algorithms;
  // std::function wants to be copied, and a plan cannot be.
  const auto shared = std::make_shared<Plan>(std::move(plan));
  const InspectOptions inspect{.algorithms = std::move(algorithms),
                               .make_host = hostMaker(options.hosts),
                               .begin =
                                   [shared, frame = options.frame](Session& session) {
                                     session.opener.open(std::move(*shared));
                                     if (frame) session.playback.goTo(*frame);
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

}  // namespace broadmark
