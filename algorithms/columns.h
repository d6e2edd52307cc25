// The `columns` broad phase, for algorithms that use it for full searches.
#pragma once

#include <cstddef>
#include <memory>

#include "broadmark/broad_phase.h"

namespace broadmark::columns {

/// Up to this many boxes all pairs are tested, by default.
inline constexpr std::size_t kMaxBruteForce = 224;

std::unique_ptr<BroadPhase> create();

}  // namespace broadmark::columns
