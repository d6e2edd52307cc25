// Collects what is listed in CMakeLists.txt.

#include "broadmark/scenes/registry.h"

#include <algorithm>
#include <iterator>

#include "recorders/recorder.h"
#include "engines/replay.h"
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

#define REPLAY(name)   \
  namespace name {     \
  ReplayEntry entry(); \
  }
#include "replay_list.inc"
#undef REPLAY

#define RECORDER(name)   \
  namespace name {       \
  RecorderEntry entry(); \
  }
#include "recorder_list.inc"
#undef RECORDER

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

std::vector<ReplayEntry> replayEntries() {
  return {
#define REPLAY(name) name::entry(),
#include "replay_list.inc"
#undef REPLAY
  };
}

std::vector<RecorderEntry> recorderEntries() {
  return {
#define RECORDER(name) name::entry(),
#include "recorder_list.inc"
#undef RECORDER
  };
}

}  // namespace broadmark::scenes

namespace broadmark {

namespace {

template <class Entry>
auto listingsOf(const std::vector<Entry>& entries) {
  std::vector<decltype(Entry::listing)> listings;
  for (const Entry& entry : entries) listings.push_back(entry.listing);
  return listings;
}

}  // namespace

std::vector<SceneListing> builtinScenes() { return listingsOf(scenes::sceneEntries()); }
std::vector<EngineListing> builtinEngines() {
  auto listings = listingsOf(scenes::engineEntries());
  std::ranges::move(listingsOf(scenes::replayEntries()), std::back_inserter(listings));
  return listings;
}
std::vector<RecorderListing> builtinRecorders() { return listingsOf(scenes::recorderEntries()); }

}  // namespace broadmark
