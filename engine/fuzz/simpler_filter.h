// Simplification of collision filters that cause a failure.
#pragma once

#include <cstddef>
#include <functional>

#include "broadmark/collision_filter.h"

namespace broadmark {

/// Simplifies a filter of `bodies` bodies while still_fails(filter): drops all of it; else each
/// layer (its bodies join another one), each exception of the matrix (the two layers then collide),
/// each world (its bodies join the first remaining world), and each tag. Continues from each
/// failing simplification. Returns whether there was any.
bool simplifyFilter(CollisionFilter filter, std::size_t bodies,
                    const std::function<bool(const CollisionFilter&)>& still_fails);

}  // namespace broadmark
