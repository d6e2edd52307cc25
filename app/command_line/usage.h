// What help, shell completion and the manual show of CLI11's commands and options.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace broadmark {

/// A heading in help for the options that are added during its lifetime.
class HelpGroup {
 public:
  HelpGroup(CLI::App& app, const std::string& heading);
  ~HelpGroup();
  HelpGroup(const HelpGroup&) = delete;
  HelpGroup& operator=(const HelpGroup&) = delete;

 private:
  CLI::App& app_;
  std::string outer_;
};

/// Sets the values that shells suggest for an option. Others may be valid, too.
CLI::Option* suggestValues(CLI::Option* option, const std::vector<std::string>& values);
/// The suggested values, separated by blanks; "": none.
std::string suggestedValues(const CLI::Option&);

/// Whether help shows an option. CLI11's own way to hide an option removes its name, which error
/// messages need.
bool isShown(const CLI::Option&);

/// Names of an option with dashes; of a positional argument its type.
std::vector<std::string> namesOf(const CLI::Option&);
/// Name of an option in messages: --NAME; of a positional argument its type.
std::string shownName(const CLI::Option&);
bool takesValue(const CLI::Option&);
/// Whether the option is a flag that may have a value: "--periodic[=BOX]".
bool takesOptionalValue(const CLI::Option&);
/// Whether the value may be a list with commas.
bool takesList(const CLI::Option&);
/// The description with what the option needs and excludes, and its default.
std::string descriptionOf(const CLI::Option&);

/// Options of a command that help shows.
std::vector<const CLI::Option*> shownOptions(const CLI::App&);

/// The shown options below a heading of help.
struct OptionGroup {
  std::string heading;
  std::vector<const CLI::Option*> options;
};
/// All groups of a command in their order; positional arguments are in the first.
std::vector<OptionGroup> optionGroups(const CLI::App&);

/// All commands that help shows, except the main one.
std::vector<const CLI::App*> commandsOf(const CLI::App& main);

/// Formats the help of a command for lines of `width` columns. `name`: with those of its parents.
std::string helpText(const CLI::App& command, const std::string& name, std::size_t width);

}  // namespace broadmark
