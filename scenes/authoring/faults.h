// Validation shared by the sources of authored scenes.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "broadmark/collision_filter.h"
#include "broadmark/scenes/authored_scene.h"

namespace broadmark::scenes {

/// Throws InputError if the body with this id is invalid.
void requireValid(const AuthoredBody&, std::size_t id);
/// Throws InputError if the scene, except for its parameters, is invalid.
void requireValid(const AuthoredScene&);

/// The message for an invalid layer number.
std::string faultOfLayer(std::string_view key);

/// Sets the scene's colliding layers from the filter. Throws InputError if the filter has worlds or
/// tags, which authored scenes do not support.
void copyCollisions(AuthoredScene& scene, const CollisionFilter& filter);

}  // namespace broadmark::scenes
