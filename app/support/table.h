// Results as tables for people.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "broadmark/results/case_columns.h"
#include "support/words.h"

namespace broadmark {

/// What a column says of a case; "–" where that is not known.
std::string cellText(const CaseColumn&, const CaseResult&, const Summary&,
                     std::string (*seconds_text)(double) = durationText);

/// The cases of one recording, sorted by their medians, the fastest right one marked.
std::string formatTable(std::span<const CaseResult>);

/// Maximum width of lines in lists, unless a single word is longer.
inline constexpr std::size_t kWidestLine = 100;

/// Wraps a text between words: the first line starts in column `begun`, the others in `indent`.
std::string wrapped(const std::string& text, std::size_t begun, std::size_t indent);

enum class LastColumn { whole, wrapped };

/// Rows with aligned columns, to the right where `right_aligned` says so. The last one may be
/// wrapped, below itself.
std::string alignColumns(const std::vector<std::vector<std::string>>& rows,
                         const std::vector<bool>& right_aligned,
                         LastColumn last = LastColumn::whole);

}  // namespace broadmark
