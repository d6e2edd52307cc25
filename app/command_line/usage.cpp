#include "command_line/usage.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <set>

#include "support/table.h"
#include "support/words.h"

namespace broadmark {
namespace {

/// Names of several options. CLI11 orders them by address.
std::string sortedNames(const std::set<CLI::Option*>& options) {
  std::set<std::string> names;
  for (const CLI::Option* option : options) names.insert(shownName(*option));
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string usageOf(const CLI::App& command, const std::string& name) {
  std::string text = fmt::format("Usage: {} [OPTION]...", name);
  for (const CLI::Option* option : shownOptions(command)) {
    if (!option->get_positional()) continue;
    const char* dots = option->get_items_expected_max() > 1 ? "..." : "";
    text += fmt::format(fmt::runtime(option->get_required() ? " {}{}" : " [{}]{}"),
                        option->get_type_name(), dots);
  }
  if (!commandsOf(command).empty()) text += fmt::format("\n       {} COMMAND [OPTION]...", name);
  return text + '\n';
}

/// A name and its description in a second column, or below if either has no room.
std::string entryText(const std::string& name, const std::string& description, std::size_t width) {
  const std::size_t column = width < 60 ? 6 : 26;
  std::string text = "  " + name;
  if (text.size() + 2 > column) {
    text += '\n' + std::string(column, ' ');
  } else {
    text.resize(column, ' ');
  }
  return text + wrapped(description, column, column, width) + '\n';
}

std::string entryText(const CLI::Option& option, std::size_t width) {
  std::string name = fmt::format("{}", fmt::join(namesOf(option), ", "));
  if (takesValue(option) && !option.get_positional()) name += ' ' + option.get_type_name();
  if (takesOptionalValue(option)) name += option.get_type_name();
  return entryText(name, descriptionOf(option), width);
}

}  // namespace

HelpGroup::HelpGroup(CLI::App& app, const std::string& heading)
    : app_(app), outer_(app.option_defaults()->get_group()) {
  app.option_defaults()->group(heading);
}

// NOLINTNEXTLINE(bugprone-exception-escape): CLI11 accepts a name that it had
HelpGroup::~HelpGroup() { app_.option_defaults()->group(outer_); }

// CLI11 has no place for suggestions: they are the name of a check that accepts everything.
CLI::Option* suggestValues(CLI::Option* option, const std::vector<std::string>& values) {
  return option->check(CLI::Validator().name(fmt::format("{}", fmt::join(values, " "))));
}

std::string suggestedValues(const CLI::Option& option) {
  try {
    return const_cast<CLI::Option&>(option).get_validator(0)->get_name();  // lacks a const form
  } catch (const CLI::OptionNotFound&) {
    return {};
  }
}

bool isShown(const CLI::Option& option) { return !option.get_description().empty(); }

std::vector<std::string> namesOf(const CLI::Option& option) {
  if (option.get_positional()) return {option.get_type_name()};
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back(fmt::format("-{}", name));
  for (const std::string& name : option.get_lnames()) names.push_back(fmt::format("--{}", name));
  return names;
}

std::string shownName(const CLI::Option& option) {
  return option.get_positional() ? option.get_type_name() : option.get_name();
}

bool takesValue(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

bool takesOptionalValue(const CLI::Option& option) {
  return !takesValue(option) && !option.get_type_name().empty();
}

bool takesList(const CLI::Option& option) {
  return option.get_type_name().find("[,") != std::string::npos;
}

std::string descriptionOf(const CLI::Option& option) {
  std::string text = option.get_description();
  if (option.get_required() && !option.get_positional()) text += "; required";
  if (!option.get_needs().empty()) text += "; needs " + sortedNames(option.get_needs());
  if (!option.get_excludes().empty()) text += "; not with " + sortedNames(option.get_excludes());
  if (takesValue(option) && !option.get_default_str().empty()) {
    text += fmt::format(" (default: {})", option.get_default_str());
  }
  return text;
}

std::vector<const CLI::Option*> shownOptions(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return isShown(*option); });
}

std::vector<OptionGroup> optionGroups(const CLI::App& command) {
  std::vector<OptionGroup> groups;
  for (const CLI::Option* option : shownOptions(command)) {
    auto group = std::ranges::find(groups, option->get_group(), &OptionGroup::heading);
    if (group == groups.end()) group = groups.insert(group, {option->get_group(), {}});
    group->options.push_back(option);
  }
  return groups;
}

std::vector<const CLI::App*> commandsOf(const CLI::App& main) {
  return main.get_subcommands(
      [](const CLI::App* command) { return !command->get_group().empty(); });
}

std::string helpText(const CLI::App& command, const std::string& name, std::size_t width) {
  std::string text = wrapped(command.get_description(), 0, 0, width) + '\n';
  text += usageOf(command, name);
  for (const OptionGroup& group : optionGroups(command)) {
    text += fmt::format("\n{}:\n", group.heading);
    for (const CLI::Option* option : group.options) text += entryText(*option, width);
  }
  const auto commands = commandsOf(command);
  if (!commands.empty()) text += "\nCommands:\n";
  for (const CLI::App* other : commands) {
    text += entryText(other->get_name(), other->get_description(), width);
  }
  text += "\nExamples:\n";
  for (const std::string& example : splitAt('\n', command.get_footer())) {
    text += fmt::format("  {}\n", example);
  }
  return text;
}

}  // namespace broadmark
