// broadmark without --headless, and --headless --ui: the inspector on the session that the options
// describe.

#include <fmt/format.h>

#include "app/case_reference.h"
#include "app/cases.h"
#include "app/inspector/inspect.h"
#include "app/inspector/session.h"
#include "app/options.h"
#include "app/plugins.h"
#include "app/recordings.h"
#include "broadmark/error.h"
#include "scenes/authored_simulation.h"

namespace broadmark {
namespace {

/// Adds a lane that runs this case.
void addCase(Session& session, const Case& run) {
  LaneEdit& lane = session.addLane(run.algorithm.id);
  lane.isa = run.algorithm.vectorised ? run.isa : lane.isa;
  lane.threads = run.algorithm.parallel ? run.threads : lane.threads;
  lane.device = run.device;
  setParameters(*lane.parameters, run.parameters);
  session.lanesChanged();
}

void openSource(Session& session, Source source) {
  if (auto* authored = dynamic_cast<scenes::SceneDocument*>(source.simulation.get())) {
    session.author(authored->document(), source.simulation->input());
    session.simulateAuthored();
  } else if (source.simulation) {
    session.draft = std::move(source.simulation);
    session.simulate();
  } else {
    session.open(source.reference.path);
  }
}

/// What the session begins with.
struct Beginning {
  std::vector<Source> sources;  ///< one at most
  std::vector<Case> cases;
  std::optional<std::uint32_t> frame;  ///< to go to
};

/// Understands everything before a window is opened: a mistake on the command line is told there.
Beginning beginningOf(const HeadlessOptions& options, const std::vector<Algorithm>& known) {
  Beginning beginning;
  if (options.sources.size() > 1) {
    throw InputError(
        fmt::format("'{}': the inspector looks at one source at a time", options.sources[1]));
  }
  if (!options.case_id.empty()) {
    CaseReference one = openCase(options.sources.front(), options.case_id, known);
    beginning.sources.push_back(std::move(one.source));
    beginning.cases = {one.run};
    if (one.difference) beginning.frame = one.difference->frame;
    return beginning;
  }
  if (!options.sources.empty()) beginning.sources = resolveSources(options);
  if (!beginning.sources.empty() && beginning.sources.front().settings) {
    beginning.cases = {originalCase(*beginning.sources.front().settings, known)};
  } else if (!options.algorithms.empty()) {
    beginning.cases = selectCases(options, known);
  }
  for (Case& run : beginning.cases) run.device = options.device;
  return beginning;
}

}  // namespace

int runInspector(const HeadlessOptions& options) {
  const std::vector<Algorithm> known = availableAlgorithms(options.plugins);
  const auto beginning = std::make_shared<Beginning>(beginningOf(options, known));
  const auto begin = [beginning](Session& session) {
    for (const Case& run : beginning->cases) addCase(session, run);
    for (Source& source : beginning->sources) openSource(session, std::move(source));
    if (beginning->frame) session.wish.frame = *beginning->frame;
  };
  const InspectOptions inspect{.algorithms = known,
                               .begin = begin,
                               .script = options.script,
                               .screenshot = options.screenshot,
                               .width = options.screenshot_width,
                               .height = options.screenshot_height,
                               .gl = options.gl};
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
