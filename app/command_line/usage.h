// Queries about CLI11's options, for shell completion and the manual.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace broadmark {

/// Whether help shows an option. CLI11's own way to hide an option removes its name, which error
/// messages need.
bool isShown(const CLI::Option&);

/// Names of an option with dashes; of a positional argument its type.
std::vector<std::string> namesOf(const CLI::Option&);
bool takesValue(const CLI::Option&);

/// Options of a command that help shows.
std::vector<const CLI::Option*> shownOptions(const CLI::App&);

/// All commands except the main one.
std::vector<const CLI::App*> commandsOf(const CLI::App& main);

}  // namespace broadmark
