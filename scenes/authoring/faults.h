// What the writer, the editor and the simulation of authored scenes share: refusing what is wrong.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "broadmark/scenes/authored_scene.h"

namespace broadmark::scenes {

/// Throws InputError when the body with this id is wrong.
void requireSound(const AuthoredBody&, std::size_t id);
/// Throws InputError when any part of the scene but its parameters is wrong.
void requireSound(const AuthoredScene&);

/// What is wrong with a number that is no layer, and what would be right.
std::string faultOfLayer(std::string_view key);

}  // namespace broadmark::scenes
