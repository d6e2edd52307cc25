// The built-in scenes and physics engines, in the order of the lists in CMakeLists.txt; engines of
// plug-ins; and object types.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "broadmark/scenes/physics_engine.h"
#include "broadmark/scenes/random.h"
#include "broadmark/scenes/simulation.h"

namespace broadmark::scenes {

class Scene;

struct SceneEntry {
  SceneListing listing;
  std::unique_ptr<Scene> (*create)();
};

struct EngineEntry {
  EngineListing listing;
  std::unique_ptr<PhysicsEngine> (*create)(const PhysicsSettings&);
};

/// The shapes of a scene's bodies.
struct ObjectType {
  struct {
    std::string id;    ///< "cubes"
    std::string name;  ///< as in recordings: "Cubes"
  } listing;
  /// The shape of body `index`. Its size is proportional to `scale`.
  Shape (*shape)(std::size_t index, double scale, Random&);
};

std::vector<SceneEntry> sceneEntries();
/// The built-in engines, then the added ones.
std::vector<EngineEntry> engineEntries();
std::vector<ObjectType> objectTypes();

/// Adds an engine for the rest of the process. Its id must be new. Not thread-safe with the
/// creation of simulations, which may select the engine from then on.
void addEngine(EngineEntry);

}  // namespace broadmark::scenes
