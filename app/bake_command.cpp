// broadmark bake: every combination of scenes, object types and object counts into recordings.

#include <fmt/format.h>

#include "app/cases.h"
#include "app/interrupt.h"
#include "app/options.h"
#include "app/recordings.h"
#include "broadmark/error.h"
#include "broadmark/names.h"

namespace broadmark {

int runBake(const BakeOptions& options) {
  std::vector<std::string> scenes = options.scenes;
  if (scenes.empty()) {
    for (const SceneListing& scene : builtinScenes()) scenes.push_back(scene.id);
  }
  const auto simulations = makeSimulations(scenes, options.scene, options.parameters);
  for (const auto& [name, value] : options.parameters) {
    std::vector<std::string> known;
    for (const auto& simulation : simulations) {
      std::ranges::move(parameterNames(*simulation), std::back_inserter(known));
    }
    if (std::ranges::find(known, name) == known.end()) {
      throw InputError("--param: " + unknownName("parameter", name, known));
    }
  }
  makeDirectory(options.output);
  const InterruptGuard guard;
  for (const auto& simulation : simulations) {
    const auto paths = bakeInto(*simulation, options.output, options.scene.recorders, options.force,
                                options.quiet);
    if (paths.empty()) throw InputError("interrupted: finished recordings are kept");
    for (const auto& path : paths) fmt::print("{}\n", path.string());
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace broadmark
