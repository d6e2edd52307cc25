// What all ways to make an authored scene of a frame share.
#pragma once

#include <string>

#include "broadmark/collision_filter.h"
#include "broadmark/scenes/authored_scene.h"

namespace broadmark::scenes {

/// A body that fills this box; a sphere if the object type says so.
AuthoredBody bodyIn(const Aabb& box, const std::string& object_type);

/// The scene's layers collide as the filter says. Throws InputError when the filter knows worlds or
/// tags, which an authored scene cannot state.
void takeCollisions(AuthoredScene& scene, const CollisionFilter& filter);

}  // namespace broadmark::scenes
