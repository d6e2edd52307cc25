// CLI11's options as plain values.

#include "command_line/usage.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

namespace broadmark {
namespace {

std::vector<std::string> namesOf(const CLI::Option& option) {
  if (option.get_positional()) return {option.get_type_name()};
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back(fmt::format("-{}", name));
  for (const std::string& name : option.get_lnames()) names.push_back(fmt::format("--{}", name));
  return names;
}

OptionUsage usageOf(const CLI::Option& option) {
  const bool takes_value = option.get_items_expected_max() > 0;
  return {.names = namesOf(option),
          .positional = option.get_positional(),
          .takes_value = takes_value,
          .type = takes_value ? option.get_type_name() : "",
          .value = takes_value ? option.get_default_str() : "",
          .doc = option.get_description()};
}

CommandUsage commandUsage(const CLI::App& app, std::string name) {
  CommandUsage usage{.name = std::move(name), .summary = app.get_description(), .options = {}};
  for (const CLI::Option* option :
       app.get_options([](const CLI::Option* any) { return isShown(*any); })) {
    usage.options.push_back(usageOf(*option));
  }
  return usage;
}

}  // namespace

bool isShown(const CLI::Option& option) { return !option.get_description().empty(); }

std::vector<CommandUsage> usageOf(const CLI::App& main) {
  std::vector<CommandUsage> all = {commandUsage(main, "")};
  for (const CLI::App* command : main.get_subcommands([](const CLI::App*) { return true; })) {
    all.push_back(commandUsage(*command, command->get_name()));
  }
  return all;
}

}  // namespace broadmark
