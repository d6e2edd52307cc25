#include "engines/chosen_engine.h"

#include "broadmark/scenes/registry.h"
#include "entries.h"

namespace broadmark::scenes {
namespace {

std::unique_ptr<PhysicsEngine> engineOf(const std::string& id, const PhysicsSettings& settings) {
  return entryOf(engineEntries(), id, "physics engine").create(settings);
}

}  // namespace

Parametrised& ChosenEngine::parameters(const std::string& id, const PhysicsSettings& settings) {
  if (!engine_ || id_ != id) {
    engine_ = engineOf(id, settings);
    id_ = id;
  }
  return *engine_;
}

std::unique_ptr<PhysicsEngine> ChosenEngine::create(const std::string& id,
                                                    const PhysicsSettings& settings) {
  auto engine = engineOf(id, settings);
  setParameters(*engine, parameterValues(parameters(id, settings)));
  return engine;
}

}  // namespace broadmark::scenes
