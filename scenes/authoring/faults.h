// What the sources of authored scenes share: refusing what is wrong.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "broadmark/collision_filter.h"
#include "broadmark/scenes/authored_scene.h"

namespace broadmark::scenes {

/// Throws InputError when the body with this id is wrong.
void requireValid(const AuthoredBody&, std::size_t id);
/// Throws InputError when any part of the scene but its parameters is wrong.
void requireValid(const AuthoredScene&);

/// What is wrong with a number that is no layer, and what would be right.
std::string faultOfLayer(std::string_view key);

/// The scene's layers collide as the filter says. Throws InputError when the filter knows worlds or
/// tags, which an authored scene cannot state.
void takeCollisions(AuthoredScene& scene, const CollisionFilter& filter);

}  // namespace broadmark::scenes
