// What a settings file of the original Broadmark asks to be run.
#pragma once

#include <vector>

#include "broadmark/harness/case.h"
#include "original/settings.h"

namespace broadmark::sources::original_settings {

/// Its case, the algorithm being one of `known`. Throws InputError.
Case originalCase(const OriginalSettings&, const std::vector<Algorithm>& known);

}  // namespace broadmark::sources::original_settings
