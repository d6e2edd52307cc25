// What the command line takes, read from the options themselves: for shells and for the manual.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace broadmark {

/// Whether help shows an option: CLI11's own way to hide one takes its name away, which complaints
/// need.
bool isShown(const CLI::Option&);

/// With dashes; of an argument without a name: what it is.
std::vector<std::string> namesOf(const CLI::Option&);
bool takesValue(const CLI::Option&);

/// Of a command, those that help shows.
std::vector<const CLI::Option*> shownOptions(const CLI::App&);

/// The commands besides the main one.
std::vector<const CLI::App*> commandsOf(const CLI::App& main);

}  // namespace broadmark
