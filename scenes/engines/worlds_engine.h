// A physics engine for scenes of several worlds at the same place.
#pragma once

#include <functional>
#include <memory>

#include "broadmark/scenes/physics_engine.h"

namespace broadmark::scenes {

using EngineMaker = std::function<std::unique_ptr<PhysicsEngine>()>;

/// Bodies of different worlds never meet: each world is an engine of its own, made when its first
/// body is added.
std::unique_ptr<PhysicsEngine> makeWorlds(EngineMaker make_engine);

}  // namespace broadmark::scenes
