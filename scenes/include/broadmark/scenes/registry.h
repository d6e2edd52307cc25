// The scenes, physics engines and object types that there are.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "broadmark/error.h"
#include "broadmark/names.h"
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

/// A choice of all ids in a list, with the first as default.
template <class Entries>
Choice choiceOf(const Entries& entries) {
  Choice choice;
  for (const auto& entry : entries) choice.options.push_back(entry.listing.id);
  choice.value = choice.options.front();
  return choice;
}

/// The entry of a list that a choice names; `kind` says of what in messages. Throws InputError.
template <class Entry>
Entry entryOf(std::vector<Entry> entries, const Choice& choice, std::string_view kind) {
  const auto found =
      std::ranges::find(entries, choice.value, [](const Entry& entry) { return entry.listing.id; });
  if (found == entries.end()) throw InputError(unknownName(kind, choice.value, choice.options));
  return std::move(*found);
}

}  // namespace broadmark::scenes
