// Collects the lists of CMakeLists.txt.

#include "broadmark/scenes/registry.h"

#include <algorithm>
#include <iterator>

#include "broadmark/scenes/scene.h"
#include "engines/replay.h"

namespace broadmark::scenes {

#define ENTRY(name)   \
  namespace name {    \
  SceneEntry entry(); \
  }
#include "scene_list.inc"
#undef ENTRY

#define ENTRY(name)    \
  namespace name {     \
  EngineEntry entry(); \
  }
#include "engine_list.inc"
#undef ENTRY

#define ENTRY(name) name::entry(),

std::vector<SceneEntry> sceneEntries() {
  return {
#include "scene_list.inc"
  };
}

namespace {

std::vector<EngineEntry> builtinEngineEntries() {
  return {
#include "engine_list.inc"
  };
}

/// The engines that were added to the built-in ones.
std::vector<EngineEntry>& addedEngines() {
  static std::vector<EngineEntry> added;
  return added;
}

}  // namespace

std::vector<EngineEntry> engineEntries() {
  std::vector<EngineEntry> all = builtinEngineEntries();
  std::ranges::copy(addedEngines(), std::back_inserter(all));
  return all;
}

void addEngine(EngineEntry engine) { addedEngines().push_back(std::move(engine)); }

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

std::vector<EngineListing> availableEngines() {
  auto listings = listingsOf(scenes::engineEntries());
  std::ranges::move(listingsOf(scenes::replayEntries()), std::back_inserter(listings));
  return listings;
}

}  // namespace broadmark
