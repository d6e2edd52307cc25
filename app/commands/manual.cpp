// broadmark manual: prints the manual page, generated from the options.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>

#include "broadmark/harness/environment.h"
#include "command_line/usage.h"
#include "commands/command.h"
#include "support/exit_status.h"
#include "support/words.h"

namespace broadmark::commands::manual {
namespace {

/// Escapes a text for roff: no escapes, no requests, no hyphens for dashes.
std::string plain(const std::string& text) {
  const bool is_request = text.starts_with('.') || text.starts_with('\'');
  return (is_request ? "\\&" : "") + escaped(text, {{'\\', "\\e"}, {'-', "\\-"}});
}

std::string optionEntry(const CLI::Option& option) {
  const std::string names = plain(fmt::format("{}", fmt::join(namesOf(option), ", ")));
  const bool has_name = !option.get_positional();
  std::string head = fmt::format("\\f{}{}\\fR", has_name ? 'B' : 'I', names);
  if (has_name && !option.get_type_name().empty()) {
    head += fmt::format(" \\fI{}\\fR", plain(option.get_type_name()));
  }
  return fmt::format(".TP\n{}\n{}\n", head, plain(descriptionOf(option)));
}

/// The options of a command below their headings, then its examples.
std::string commandEntries(const CLI::App& command) {
  std::string text;
  for (const OptionGroup& group : optionGroups(command)) {
    text += fmt::format(".PP\n\\fB{}\\fR\n", plain(group.heading));
    for (const CLI::Option* option : group.options) text += optionEntry(*option);
  }
  text += ".PP\n\\fBExamples\\fR\n.PP\n.nf\n";
  for (const std::string& example : splitAt('\n', command.get_footer())) {
    text += plain(example) + '\n';
  }
  return text + ".fi\n";
}

std::string exitStatusEntries() {
  std::string text;
  for (const auto& [status, meaning] : kExitStatuses.entries) {
    text += fmt::format(".TP\n{}\n{}\n", static_cast<int>(status), plain(std::string(meaning)));
  }
  return text;
}

/// Formats the manual page with the macros of man(7).
std::string manualPage(const CLI::App& main, const std::string& version) {
  std::string text = fmt::format(
      ".TH BROADMARK 1 \"\" \"Broadmark {}\" \"User Commands\"\n"
      ".SH NAME\nbroadmark \\- {}\n"
      ".SH SYNOPSIS\n"
      ".B broadmark\n[\\fIOPTION\\fR]... [\\fISOURCE\\fR]...\n.br\n"
      ".B broadmark\n\\fICOMMAND\\fR [\\fIOPTION\\fR]...\n"
      ".SH DESCRIPTION\n{}\nIts README is the guide; this page lists every option.\n"
      ".SH OPTIONS\n{}.SH COMMANDS\n",
      plain(version), "tests, compares and validates broad\\-phase collision detection",
      plain(main.get_description()), commandEntries(main));
  for (const CLI::App* command : commandsOf(main)) {
    text += fmt::format(".SS broadmark {}\n{}\n{}", plain(command->get_name()),
                        plain(command->get_description()), commandEntries(*command));
  }
  return text + ".SH EXIT STATUS\n" + exitStatusEntries();
}

std::function<int()> add(CLI::App& app) {
  return [&app] {
    fmt::print("{}", manualPage(*app.get_parent(), thisEnvironment().version));
    return exit_status::success;
  };
}

}  // namespace

Command command() {
  return {.name = "manual",
          .summary = "Prints the manual page (roff, for man).",
          .examples = {"manual | man -l -", "manual > broadmark.1"},
          .add = add};
}

}  // namespace broadmark::commands::manual
