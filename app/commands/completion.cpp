// broadmark completion: what makes a shell complete the program's options.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>
#include <memory>

#include "broadmark/names.h"
#include "command_line/option_types.h"
#include "command_line/usage.h"
#include "commands/command.h"
#include "support/exit_status.h"
#include "support/words.h"

namespace broadmark::commands::completion {
namespace {

// Each shell has the words of the main command where no other is named.
using Usages = std::vector<CommandUsage>;

/// A text with `escape` before each of these characters.
std::string escaped(const std::string& text, std::string_view characters,
                    std::string_view escape = "\\") {
  std::string result;
  for (const char c : text) {
    if (characters.find(c) != std::string_view::npos) result += escape;
    result += c;
  }
  return result;
}

/// What begins with dashes.
std::vector<std::string> optionNames(const CommandUsage& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.options) {
    if (!option->get_positional()) std::ranges::move(namesOf(*option), std::back_inserter(names));
  }
  return names;
}

std::vector<std::string> commandNames(const Usages& commands) {
  std::vector<std::string> names;
  for (const CommandUsage& command : commands) {
    if (!command.name.empty()) names.push_back(command.name);
  }
  return names;
}

/// The branches of a `case` over the commands, the main one last, as the pattern *.
template <class Branch>
std::string caseBranches(const Usages& commands, Branch&& branch) {
  std::string text;
  for (std::size_t i = 1; i <= commands.size(); ++i) {
    const CommandUsage& command = commands[i % commands.size()];
    text +=
        fmt::format("    {})\n{} ;;\n", command.name.empty() ? "*" : command.name, branch(command));
  }
  return text;
}

std::string bashScript(const Usages& commands) {
  const std::string options = caseBranches(commands, [](const CommandUsage& command) {
    return fmt::format("      options='{}'", fmt::join(optionNames(command), " "));
  });
  return fmt::format(R"(_broadmark() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} options
  case ${{COMP_WORDS[1]}} in
{}  esac
  COMPREPLY=()
  if [[ $current == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$current"))
  elif [[ $COMP_CWORD == 1 ]]; then
    COMPREPLY=($(compgen -W '{}' -- "$current"))
  fi
}}
complete -o default -F _broadmark broadmark
)",
                     options, fmt::join(commandNames(commands), " "));
}

std::string zshArguments(const CommandUsage& command) {
  std::string text = "      _arguments";
  for (const CLI::Option* option : command.options) {
    if (option->get_positional()) continue;
    const bool has_value = takesValue(*option);
    const std::string value =
        has_value ? fmt::format(":{}:_files", escaped(option->get_type_name(), ":\\")) : "";
    for (const std::string& name : namesOf(*option)) {
      const std::string spec = fmt::format("{}{}[{}]{}", has_value ? "*" : "", name,
                                           escaped(option->get_description(), "[]:\\"), value);
      text += fmt::format(" \\\n        {}", shellQuoted(spec));
    }
  }
  return text + " \\\n        '*:file:_files'";
}

std::string zshScript(const Usages& commands) {
  std::string names;
  for (const CommandUsage& command : commands) {
    if (command.name.empty()) continue;
    const std::string spec = fmt::format("{}:{}", command.name, escaped(command.summary, ":\\"));
    names += fmt::format("    {}\n", shellQuoted(spec));
  }
  return fmt::format(R"(#compdef broadmark
_broadmark() {{
  local -a commands
  commands=(
{}  )
  if (( CURRENT == 2 )) && [[ $PREFIX != -* ]]; then
    _describe command commands
    _files
    return
  fi
  case $words[2] in
{}  esac
}}
_broadmark "$@"
)",
                     names, caseBranches(commands, zshArguments));
}

std::string fishQuoted(const std::string& text) {
  return fmt::format("'{}'", escaped(text, "'\\"));
}

std::string fishScript(const Usages& commands) {
  const auto names = commandNames(commands);
  std::string text;
  const auto add = [&](const std::string& condition, const std::string& what,
                       const std::string& doc) {
    text +=
        fmt::format("complete -c broadmark -n '{}' {} -d {}\n", condition, what, fishQuoted(doc));
  };
  for (const CommandUsage& command : commands) {
    const bool is_main = command.name.empty();
    const std::string inside =
        is_main ? fmt::format("not __fish_seen_subcommand_from {}", fmt::join(names, " "))
                : fmt::format("__fish_seen_subcommand_from {}", command.name);
    if (!is_main) add("__fish_use_subcommand", fmt::format("-a {}", command.name), command.summary);
    for (const CLI::Option* option : command.options) {
      if (option->get_positional()) continue;
      for (const std::string& name : namesOf(*option)) {
        const bool is_long = name.starts_with("--");
        add(inside,
            fmt::format("-{} {}{}", is_long ? "l" : "s", name.substr(is_long ? 2 : 1),
                        takesValue(*option) ? " -r" : ""),
            option->get_description());
      }
    }
  }
  return text;
}

using Script = std::string (*)(const Usages&);
constexpr NameTable kShells{
    {NamedValue<Script>{bashScript, "bash"}, {zshScript, "zsh"}, {fishScript, "fish"}}};

std::function<int()> add(CLI::App& app) {
  const auto script = std::make_shared<Script>();
  addValue(
      app, "shell", "SHELL",
      [script](const std::string& name) { *script = parseNamed(name, "completion", kShells); }, {},
      fmt::format("{}", fmt::join(kShells.names(), ", ")))
      ->required();
  return [script, &app] {
    fmt::print("{}", (*script)(usageOf(*app.get_parent())));
    return exit_status::fine;
  };
}

}  // namespace

Command command() {
  return {.name = "completion",
          .summary = "Prints a script that makes a shell complete commands and options.",
          .add = add};
}

}  // namespace broadmark::commands::completion
