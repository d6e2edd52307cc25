// broadmark completion: prints scripts for shell completion.

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

// In each shell, the options of the main command are completed unless another command is named.

/// Names of the options, with dashes.
std::vector<std::string> optionNames(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : shownOptions(command)) {
    if (!option->get_positional()) std::ranges::move(namesOf(*option), std::back_inserter(names));
  }
  return names;
}

/// What the positional arguments of a command may be.
struct Arguments {
  std::string values;  ///< suggested ones
  bool files = false;
};

Arguments argumentsOf(const CLI::App& command) {
  Arguments arguments;
  for (const CLI::Option* option : shownOptions(command)) {
    if (!option->get_positional()) continue;
    const std::string values = suggestedValues(*option);
    arguments.values += (arguments.values.empty() || values.empty() ? "" : " ") + values;
    const std::string type = option->get_type_name();
    arguments.files |= values.empty() || type == "SOURCE" || type == "FILE";
  }
  return arguments;
}

std::vector<std::string> commandNames(const CLI::App& main) {
  std::vector<std::string> names;
  for (const CLI::App* command : commandsOf(main)) names.push_back(command->get_name());
  return names;
}

/// Branches of a `case` statement over the commands; the main one is last, as the pattern *.
template <class Branch>
std::string caseBranches(const CLI::App& main, Branch&& branch) {
  std::string text;
  for (const CLI::App* command : commandsOf(main)) {
    text += fmt::format("    {})\n{} ;;\n", command->get_name(), branch(*command));
  }
  return text + fmt::format("    *)\n{} ;;\n", branch(main));
}

/// A branch for each option with a value, in a `case` statement over the word before.
std::string bashValues(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : shownOptions(command)) {
    if (option->get_positional() || !takesValue(*option)) continue;
    text += fmt::format("        {}) kind={} values='{}' ;;\n", fmt::join(namesOf(*option), "|"),
                        takesList(*option) ? "list" : "value", suggestedValues(*option));
  }
  return text;
}

// With -o default, bash completes files where this finds nothing.
std::string bashScript(const CLI::App& main) {
  const std::string options = caseBranches(main, [](const CLI::App& command) {
    const Arguments arguments = argumentsOf(command);
    return fmt::format(
        "      options='{}'\n      values='{}'{}\n      case $before in\n{}      esac",
        fmt::join(optionNames(command), " "), arguments.values, arguments.files ? " files=yes" : "",
        bashValues(command));
  });
  return fmt::format(R"(_broadmark() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}}
  local kind=argument options values files= head=
  # "=" is a word, too.
  [[ $before == = ]] && before=${{COMP_WORDS[COMP_CWORD - 2]}}
  [[ $word == = ]] && word=
  case ${{COMP_WORDS[1]}} in
{}  esac
  COMPREPLY=()
  if [[ $kind == argument && $word == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$word"))
  elif [[ $kind == argument ]]; then
    [[ $COMP_CWORD == 1 ]] && values+=' {}'
    COMPREPLY=($(compgen -W "$values" -- "$word"))
    if [[ $files && $values ]]; then
      mapfile -t -O ${{#COMPREPLY[@]}} COMPREPLY < <(compgen -f -- "$word")
      compopt -o filenames 2> /dev/null
    fi
  else
    [[ $kind == list && $word == *,* ]] && head=${{word%,*}},
    COMPREPLY=($(compgen -P "$head" -W "$values" -- "${{word#"$head"}}"))
  fi
}}
complete -o default -F _broadmark broadmark
)",
                     options, fmt::join(commandNames(main), " "));
}

std::string zshArguments(const CLI::App& command) {
  std::string text = "      _arguments";
  for (const CLI::Option* option : shownOptions(command)) {
    if (option->get_positional()) continue;
    const bool has_value = takesValue(*option);
    const std::string values = suggestedValues(*option);
    const std::string action = values.empty()       ? "_files"
                               : takesList(*option) ? "_sequence compadd - " + values
                                                    : fmt::format("({})", values);
    const std::string value =
        has_value
            ? fmt::format(":{}:{}",
                          escaped(option->get_type_name(), {{':', "\\:"}, {'\\', "\\\\"}}), action)
            : "";
    for (const std::string& name : namesOf(*option)) {
      const std::string spec =
          fmt::format("{}{}[{}]{}", has_value ? "*" : "", name,
                      escaped(option->get_description(),
                              {{'[', "\\["}, {']', "\\]"}, {':', "\\:"}, {'\\', "\\\\"}}),
                      value);
      text += fmt::format(" \\\n        {}", shellQuoted(spec));
    }
  }
  const Arguments arguments = argumentsOf(command);
  if (arguments.values.empty()) return text + " \\\n        '*:file:_files'";
  return text + fmt::format(" \\\n        '*:argument:{{compadd - {}{}}}'", arguments.values,
                            arguments.files ? "; _files" : "");
}

std::string zshScript(const CLI::App& main) {
  std::string names;
  for (const CLI::App* command : commandsOf(main)) {
    const std::string spec =
        fmt::format("{}:{}", command->get_name(),
                    escaped(command->get_description(), {{':', "\\:"}, {'\\', "\\\\"}}));
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
                     names, caseBranches(main, zshArguments));
}

std::string fishQuoted(const std::string& text) {
  return fmt::format("'{}'", escaped(text, {{'\'', "\\'"}, {'\\', "\\\\"}}));
}

/// Flags for the value of an option; "": it has none.
std::string fishValue(const CLI::Option& option) {
  if (!takesValue(option)) return "";
  const std::string values = suggestedValues(option);
  if (values.empty()) return " -r";
  return fmt::format(" -x -a '{}'",
                     takesList(option) ? fmt::format("(__fish_append , {})", values) : values);
}

std::string fishScript(const CLI::App& main) {
  std::string text;
  const auto add = [&](const std::string& condition, const std::string& what,
                       const std::string& doc) {
    text +=
        fmt::format("complete -c broadmark -n '{}' {} -d {}\n", condition, what, fishQuoted(doc));
  };
  const auto add_options = [&](const std::string& condition, const CLI::App& command) {
    const Arguments arguments = argumentsOf(command);
    if (!arguments.values.empty()) {
      add(condition, fmt::format("{}-a '{}'", arguments.files ? "" : "-f ", arguments.values), "");
    }
    for (const CLI::Option* option : shownOptions(command)) {
      if (option->get_positional()) continue;
      for (const std::string& name : namesOf(*option)) {
        const bool is_long = name.starts_with("--");
        add(condition,
            fmt::format("-{} {}{}", is_long ? "l" : "s", name.substr(is_long ? 2 : 1),
                        fishValue(*option)),
            option->get_description());
      }
    }
  };
  const std::string inside = "__fish_seen_subcommand_from ";
  add_options(fmt::format("not {}{}", inside, fmt::join(commandNames(main), " ")), main);
  for (const CLI::App* command : commandsOf(main)) {
    const std::string& name = command->get_name();
    add("__fish_use_subcommand", "-a " + name, command->get_description());
    add_options(inside + name, *command);
  }
  return text;
}

using Script = std::string (*)(const CLI::App&);
constexpr NameTable kShells{
    {NamedValue<Script>{bashScript, "bash"}, {zshScript, "zsh"}, {fishScript, "fish"}}};

std::function<int()> add(CLI::App& app) {
  const auto script = std::make_shared<Script>();
  CLI::Option* shell = addValue(
      app, "shell", "SHELL",
      [script](const std::string& name) { *script = parseNamed(name, "completion", kShells); }, {},
      fmt::format("{}", fmt::join(kShells.names(), ", ")));
  suggestValues(shell, kShells.names())->required();
  return [script, &app] {
    fmt::print("{}", (*script)(*app.get_parent()));
    return exit_status::success;
  };
}

}  // namespace

Command command() {
  return {.name = "completion",
          .summary = "Prints a script that makes a shell complete commands, options and names.",
          .examples = {"completion bash > ~/.local/share/bash-completion/completions/broadmark",
                       "completion fish > ~/.config/fish/completions/broadmark.fish"},
          .add = add};
}

}  // namespace broadmark::commands::completion
