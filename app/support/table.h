// Results as human-readable tables.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "broadmark/results/case_columns.h"
#include "support/words.h"

namespace broadmark {

/// Text of a column for a case; "–" if unknown.
std::string cellText(const CaseColumn&, const CaseResult&, const Summary&,
                     std::string (*seconds_text)(double) = durationText);

/// Formats the cases of one recording, sorted by median, with the fastest correct one marked.
std::string formatTable(std::span<const CaseResult>);

/// Maximum width of lines in lists, unless a single word is longer.
inline constexpr std::size_t kMaxLineWidth = 100;

/// Wraps a text between words: the first line starts in `start_column`, the others in `indent`.
std::string wrapped(const std::string& text, std::size_t start_column, std::size_t indent,
                    std::size_t line_width = kMaxLineWidth);

enum class LastColumn { whole, wrapped };

/// Formats rows with aligned columns, `right_aligned` or to the left. The last column may be
/// wrapped.
std::string alignColumns(const std::vector<std::vector<std::string>>& rows,
                         const std::vector<bool>& right_aligned,
                         LastColumn last = LastColumn::whole);

}  // namespace broadmark
