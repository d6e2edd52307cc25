// Results files as sources.
#pragma once

#include <filesystem>

#include "broadmark/error.h"
#include "broadmark/results.h"

namespace broadmark {

/// The complaint about a results file without a chosen case; names some that can be chosen.
InputError missingCase(const Results&, const std::filesystem::path& results_file);

}  // namespace broadmark
