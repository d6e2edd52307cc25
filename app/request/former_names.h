// Former names of options, parameters and script words: still accepted, with a note that states the
// current name.
#pragma once

#include <string>
#include <vector>

namespace broadmark {

/// Returns the arguments of a command line with the current names of options.
std::vector<std::string> withCurrentOptions(std::vector<std::string> arguments);

/// Returns the current name of an option of the main command.
std::string currentOption(const std::string& option);

/// Returns the current form of a word of a script, or of a value's name ("lane.sap").
std::string currentScriptWord(const std::string& word);

/// Returns a key of --param, [ALGORITHM:]NAME, with the current name of the parameter.
std::string currentParameterKey(const std::string& key);

}  // namespace broadmark
