// Results as tables for people.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "broadmark/results.h"

namespace broadmark {

/// The cases of one recording, sorted by time, the fastest right one marked.
std::string formatTable(std::span<const CaseResult>);

/// Rows with aligned columns, to the right where `right_aligned` says so.
std::string alignColumns(const std::vector<std::vector<std::string>>& rows,
                         const std::vector<bool>& right_aligned);

}  // namespace broadmark
