// The terms in headings and legends, for tooltips.
#pragma once

#include <string_view>

namespace broadmark {

/// Explains a term; "" for an unknown one.
const char* termDoc(std::string_view term);

}  // namespace broadmark
