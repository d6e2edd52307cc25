// The `tide` broad phase, for the library in broadphase/.
#pragma once

#include <memory>

#include "broadmark/broad_phase.h"

namespace broadmark::tide {

std::unique_ptr<BroadPhase> create();

}  // namespace broadmark::tide
