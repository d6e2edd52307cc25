// The simplest collision filter with which something still fails.
#pragma once

#include <cstddef>
#include <functional>

#include "broadmark/collision_filter.h"

namespace broadmark {

/// Leaves out what `still_fails` does not need of a filter of so many bodies: all of it; else each
/// layer (its bodies join another one), each exception of the matrix (the two layers then collide),
/// each world (its bodies join the first that is left), and each tag. Each call of `still_fails`
/// that returns true is a step from there on. Whether there was any.
bool simplifyFilter(CollisionFilter filter, std::size_t bodies,
                    const std::function<bool(const CollisionFilter&)>& still_fails);

}  // namespace broadmark
