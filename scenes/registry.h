// The scenes, physics engines and object types that there are.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "scenes/physics_engine.h"
#include "scenes/random.h"
#include "scenes/simulation.h"

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

/// What the bodies of a scene look like.
struct ObjectType {
  struct {
    std::string id;    ///< "cubes"
    std::string name;  ///< as recordings call it: "Cubes"
  } listing;
  /// The shape of body `index` in a world of this scale.
  Shape (*shape)(std::size_t index, double scale, Random&);
};

/// All of them, in the order of the lists in CMakeLists.txt.
std::vector<SceneEntry> sceneEntries();
std::vector<EngineEntry> engineEntries();
std::vector<ObjectType> objectTypes();

}  // namespace broadmark::scenes
