// Simplification of collision filters that cause a failure.
#pragma once

#include <cstddef>
#include <functional>

#include "broadmark/collision_filter.h"

namespace broadmark {

/// Simplifies a filter of that many bodies while `still_fails`: drops all of it; else each layer
/// (its bodies join another one), each exception of the matrix (the two layers then collide), each
/// world (its bodies join the first remaining world), and each tag. Continues from every
/// simplification for which `still_fails` returns true. Returns whether there was any.
bool simplifyFilter(CollisionFilter filter, std::size_t bodies,
                    const std::function<bool(const CollisionFilter&)>& still_fails);

}  // namespace broadmark
