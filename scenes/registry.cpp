// Collects what is listed in CMakeLists.txt.

#include "scenes/registry.h"

#include "scenes/scene.h"

namespace broadmark::scenes {

#define SCENE(name)   \
  namespace name {    \
  SceneEntry entry(); \
  }
#include "scene_list.inc"
#undef SCENE

#define ENGINE(name)   \
  namespace name {     \
  EngineEntry entry(); \
  }
#include "engine_list.inc"
#undef ENGINE

#define OBJECT_TYPE(name) \
  namespace name {        \
  ObjectType entry();     \
  }
#include "object_type_list.inc"
#undef OBJECT_TYPE

std::vector<SceneEntry> sceneEntries() {
  return {
#define SCENE(name) name::entry(),
#include "scene_list.inc"
#undef SCENE
  };
}

std::vector<EngineEntry> engineEntries() {
  return {
#define ENGINE(name) name::entry(),
#include "engine_list.inc"
#undef ENGINE
  };
}

std::vector<ObjectType> objectTypes() {
  return {
#define OBJECT_TYPE(name) name::entry(),
#include "object_type_list.inc"
#undef OBJECT_TYPE
  };
}

}  // namespace broadmark::scenes

namespace broadmark {

std::vector<SceneListing> builtinScenes() {
  std::vector<SceneListing> listings;
  for (scenes::SceneEntry& entry : scenes::sceneEntries()) {
    listings.push_back(std::move(entry.listing));
  }
  return listings;
}

std::vector<EngineListing> builtinEngines() {
  std::vector<EngineListing> listings;
  for (scenes::EngineEntry& entry : scenes::engineEntries()) {
    listings.push_back(std::move(entry.listing));
  }
  return listings;
}

}  // namespace broadmark
