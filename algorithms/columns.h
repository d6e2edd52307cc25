// The `columns` broad phase, for algorithms that use it for full searches.
#pragma once

#include <memory>

#include "broadmark/broad_phase.h"

namespace broadmark::columns {

std::unique_ptr<BroadPhase> create();

}  // namespace broadmark::columns
