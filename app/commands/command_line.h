// Parsing of the complete command line.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "command_line/session_options.h"

namespace broadmark {

/// Parses a complete command line, without the program's name. Returns a function that runs it (or
/// prints the requested help) and returns the exit status, and that may throw InputError. Throws
/// InputError for bad usage.
std::function<int()> parseCommandLine(const std::vector<std::string>& arguments);

/// Parses the options of a command line of the main command. Throws InputError for bad usage.
SessionOptions parseSession(const std::vector<std::string>& arguments);

}  // namespace broadmark
