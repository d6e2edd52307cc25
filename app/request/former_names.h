// Options, parameters and script words by names that they once had: still accepted, with a line
// that tells the new one.
#pragma once

#include <string>
#include <vector>

namespace broadmark {

/// The arguments of a command line with the present names of options.
std::vector<std::string> withCurrentOptions(std::vector<std::string> arguments);

/// The present name of an option of the main command.
std::string currentOption(const std::string& option);

/// The present form of a word of a script, or of a value's name with its first part ("lane.sap").
std::string currentScriptWord(const std::string& word);

/// The key of --param, [ALGORITHM:]NAME, with the present name of the parameter.
std::string currentParameterKey(const std::string& key);

}  // namespace broadmark
