// The interface's font, part of the program.
#pragma once

#include <string_view>

namespace broadmark {

/// Inter Regular as an OpenType file.
std::string_view interfaceFont();

}  // namespace broadmark
