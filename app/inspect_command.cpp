// broadmark without --headless, and --headless --ui: the inspector on the session that the options
// describe.

#include <fmt/format.h>

#include "case_reference.h"
#include "cases.h"
#include "inspector/inspect.h"
#include "inspector/session.h"
#include "options.h"
#include "plugins.h"
#include "recordings.h"
#include "broadmark/files.h"
#include "broadmark/error.h"
#include "broadmark/scenes/authored_simulation.h"

namespace broadmark {
namespace {

bool isResultsFile(const std::string& source) {
  return std::filesystem::path(source).extension() == ".json" &&
         jsonKind(readTextFile(source), source) == kResultsSchema;
}

/// What the session begins with.
struct Beginning {
  std::vector<Source> sources;  ///< one at most
  std::vector<Case> cases;
  std::optional<CaseReference> failed;  ///< instead of these
  std::filesystem::path results;        ///< or a file one of whose cases is to be chosen
};

/// Understands everything before a window is opened: a mistake on the command line is told there.
Beginning beginningOf(const HeadlessOptions& options, const std::vector<Algorithm>& known) {
  Beginning beginning;
  if (options.sources.size() > 1) {
    throw InputError(
        fmt::format("'{}': the inspector looks at one source at a time", options.sources[1]));
  }
  if (!options.case_id.empty()) {
    beginning.failed = openCase(options.sources.front(), options.case_id, known);
    return beginning;
  }
  if (!options.sources.empty() && isResultsFile(options.sources.front())) {
    beginning.results = options.sources.front();
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
    for (const Case& run : beginning->cases) session.addLane(run);
    for (Source& source : beginning->sources) session.open(std::move(source));
    if (beginning->failed) session.open(std::move(*beginning->failed));
    if (!beginning->results.empty()) session.open(beginning->results);
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
