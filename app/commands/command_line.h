// The command line as a whole.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "command_line/session_options.h"

namespace broadmark {

/// Parses a command line, without the program's name, completely. Returns what runs it (or prints
/// the help it asks for) and returns the exit status; that throws InputError. Throws InputError for
/// bad usage.
std::function<int()> parseCommandLine(const std::vector<std::string>& arguments);

/// The options on a command line of the main command. Throws InputError for bad usage.
SessionOptions parseSession(const std::vector<std::string>& arguments);

}  // namespace broadmark
