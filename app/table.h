// Results as a table that a person can read at once.
#pragma once

#include <span>
#include <string>

#include "broadmark/results.h"

namespace broadmark {

/// One table for the cases of one recording: sorted by time, the fastest right one marked.
std::string formatTable(std::span<const CaseResult>);

/// Columns aligned by their widest entry; numbers to the right where `right_aligned` says so.
std::string alignColumns(const std::vector<std::vector<std::string>>& rows,
                         const std::vector<bool>& right_aligned);

}  // namespace broadmark
