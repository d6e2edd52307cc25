#include "inspector/run_inspector.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "broadmark/error.h"
#include "inspector/inspect.h"
#include "inspector/session/session.h"
#include "request/hosts.h"
#include "run/plan.h"

namespace broadmark {

int runInspector(Plan plan, bool in_window, const std::filesystem::path& script) {
  const RunRequest request = plan.request;
  std::vector<Algorithm> algorithms = plan.algorithms;
  // std::function wants to be copied, and a plan cannot be.
  const auto shared = std::make_shared<Plan>(std::move(plan));
  const InspectOptions inspect{.algorithms = std::move(algorithms),
                               .make_host = hostMaker(request.hosts),
                               .begin =
                                   [shared, frame = request.frame](Session& session) {
                                     session.open(std::move(*shared));
                                     if (frame) session.playback.goTo(*frame);
                                   },
                               .script = script,
                               .screenshot = request.screenshot,
                               .width = request.picture.width,
                               .height = request.picture.height,
                               .gl = request.picture.gl};
  try {
    if (in_window) {
      inspectInWindow(inspect);
    } else {
      inspectOffscreen(inspect);
    }
  } catch (const RenderError& error) {
    throw InputError(in_window ? fmt::format("{} (--headless runs without a window)", error.what())
                               : error.what());
  }
  return 0;
}

}  // namespace broadmark
