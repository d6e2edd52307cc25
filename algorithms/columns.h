// Columns, for algorithms that find everything anew now and then.
#pragma once

#include <memory>

#include "broadmark/broad_phase.h"

namespace broadmark::columns {

/// An instance of `columns`.
std::unique_ptr<BroadPhase> create();

}  // namespace broadmark::columns
