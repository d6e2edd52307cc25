// The font of the user interface, built into the program.
#pragma once

#include <string_view>

namespace broadmark {

/// Inter Regular as an OpenType file.
std::string_view interfaceFont();

}  // namespace broadmark
