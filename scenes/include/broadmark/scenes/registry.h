// The built-in scenes and physics engines, in the order of the lists in CMakeLists.txt; engines of
// plug-ins; and object types.
//
// Example:
//
//   scenes::Random random(7);
//   const scenes::ObjectType cubes = scenes::objectTypes().front();
//   for (const scenes::EngineEntry& entry : scenes::engineEntries()) {
//     const std::unique_ptr<scenes::PhysicsEngine> engine = entry.create({.time_step = 0.01});
//     engine->addBody({.shape = cubes.shape(0, 1.0, random), .mass = 2});
//   }
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

/// A built-in scene.
struct SceneEntry {
  SceneListing listing;
  /// A new scene with default parameters; scene.h defines the class.
  std::unique_ptr<Scene> (*create)();
};

/// A physics engine that simulates bodies; engines that replay recordings have no entry.
struct EngineEntry {
  EngineListing listing;
  /// A new engine without bodies and walls, with its own parameters at their defaults. It copies
  /// the settings.
  std::unique_ptr<PhysicsEngine> (*create)(const PhysicsSettings&);
};

/// The shapes of a scene's bodies.
struct ObjectType {
  struct {
    std::string id;    ///< "cubes"
    std::string name;  ///< as in recordings: "Cubes"
  } listing;
  /// The shape of body `index`. Its size is proportional to `scale`, in world units: the edge of a
  /// cube, the diameter of a sphere, a factor on the edges of an assorted box. May draw numbers.
  Shape (*shape)(std::size_t index, double scale, Random&);
};

// These make new lists.

std::vector<SceneEntry> sceneEntries();
/// The built-in engines, then the added ones.
std::vector<EngineEntry> engineEntries();
std::vector<ObjectType> objectTypes();

/// Adds an engine for the rest of the process. Its id must be new, which is not checked: the first
/// entry of an id counts. Not thread-safe with engineEntries() and the creation of simulations,
/// which may select the engine from then on.
void addEngine(EngineEntry);

}  // namespace broadmark::scenes
