// What the command line takes, read from the options themselves: for shells and for the manual.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace broadmark {

struct OptionUsage {
  std::vector<std::string> names;  ///< with dashes; of an argument without a name: what it is
  bool positional = false;
  bool takes_value = false;
  std::string type;   ///< "FILE"; "": none
  std::string value;  ///< the default that help shows; "": none
  std::string doc;
};

struct CommandUsage {
  std::string name;  ///< "": the main command
  std::string summary;
  std::vector<OptionUsage> options;
};

/// Whether help shows an option: CLI11's own way to hide one takes its name away, which complaints
/// need.
bool isShown(const CLI::Option&);

/// The main command, then the others. Only what help shows.
std::vector<CommandUsage> usageOf(const CLI::App& main);

}  // namespace broadmark
