// What callers ask for is checked before the query tree gets it.
#pragma once

#include <span>

#include "broadmark/broadphase.hpp"

namespace broadmark::broadphase {

/// Throws std::invalid_argument if a query is not as BroadPhase requires.
void checkQueries(std::span<const BoxQuery> queries);
void checkQueries(std::span<const Cast> casts);
void checkQueries(std::span<const NearestQuery> queries);

}  // namespace broadmark::broadphase
