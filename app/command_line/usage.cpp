#include "command_line/usage.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

namespace broadmark {

bool isShown(const CLI::Option& option) { return !option.get_description().empty(); }

std::vector<std::string> namesOf(const CLI::Option& option) {
  if (option.get_positional()) return {option.get_type_name()};
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back(fmt::format("-{}", name));
  for (const std::string& name : option.get_lnames()) names.push_back(fmt::format("--{}", name));
  return names;
}

bool takesValue(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

std::vector<const CLI::Option*> shownOptions(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return isShown(*option); });
}

std::vector<const CLI::App*> commandsOf(const CLI::App& main) {
  return main.get_subcommands([](const CLI::App*) { return true; });
}

}  // namespace broadmark
