// broadmark completion: what makes a shell complete the program's options.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "command_line/option_types.h"
#include "command_line/usage.h"
#include "commands/command.h"
#include "support/exit_status.h"

namespace broadmark::commands::completion {
namespace {

std::function<int()> add(CLI::App& app) {
  const auto shell = std::make_shared<Shell>();
  addValue(
      app, "shell", "SHELL",
      [shell](const std::string& name) { *shell = parseNamed(name, "completion", kShells); }, {},
      fmt::format("{}", fmt::join(kShells.names(), ", ")))
      ->required();
  return [shell, &app] {
    fmt::print("{}", completionScript(*shell, usageOf(*app.get_parent())));
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
