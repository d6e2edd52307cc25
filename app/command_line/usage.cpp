// CLI11's options as plain values.

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

std::vector<CommandUsage> usageOf(const CLI::App& main) {
  const auto shown = [](const CLI::Option* option) { return isShown(*option); };
  std::vector<CommandUsage> all = {{"", main.get_description(), main.get_options(shown)}};
  for (const CLI::App* command : main.get_subcommands([](const CLI::App*) { return true; })) {
    all.push_back({command->get_name(), command->get_description(), command->get_options(shown)});
  }
  return all;
}

}  // namespace broadmark
