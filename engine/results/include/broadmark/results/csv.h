// Fields of CSV (RFC 4180).
#pragma once

#include <string>
#include <string_view>

namespace broadmark {

/// A field, quoted if necessary.
std::string csvField(std::string_view text);

}  // namespace broadmark
