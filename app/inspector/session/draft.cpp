#include "inspector/session/draft.h"

namespace broadmark {

void Draft::choose(const std::string& id, const std::string& engine) {
  ParameterValues values = parameterValues(*scene_);
  scene_ = makeSimulation(id, engine);
  // What the user has probably chosen.
  for (const char* shared : {"objects", "frames", "object_type", "seed", "engine"}) {
    const auto value = values.find(shared);
    const ParameterValues there = parameterValues(*scene_);
    if (value == values.end() || !there.contains(shared)) continue;
    if (std::string(shared) == "engine" && !engine.empty()) continue;
    setParameters(*scene_, {*value});
  }
}

bool Draft::isOpen() const {
  return playback_.footage() &&
         playback_.footage()->scene_parameters == formatSceneParameters(*scene_);
}

}  // namespace broadmark
