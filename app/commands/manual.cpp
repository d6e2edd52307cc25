// broadmark manual: the manual page, made from the options.

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "broadmark/harness/environment.h"
#include "command_line/usage.h"
#include "commands/command.h"
#include "support/exit_status.h"

namespace broadmark::commands::manual {
namespace {

std::function<int()> add(CLI::App& app) {
  return [&app] {
    fmt::print("{}", manualPage(usageOf(*app.get_parent()), thisEnvironment().version));
    return exit_status::fine;
  };
}

}  // namespace

Command command() {
  return {.name = "manual", .summary = "Prints the manual page (roff, for man).", .add = add};
}

}  // namespace broadmark::commands::manual
