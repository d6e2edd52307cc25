// broadmark worker: runs a case for the process that started it.

#include "broadmark/harness/worker_process.h"

#include <fmt/format.h>

#include "broadmark/error.h"
#include "commands/command.h"
#include "request/cases.h"
#include "request/plugins.h"

namespace broadmark::commands::worker {
namespace {

Algorithm find(const std::string& id, const std::string& plugin) {
  const std::vector<Algorithm> known =
      availableAlgorithms(plugin.empty() ? std::vector<std::string>() : std::vector{plugin});
  const bool is_missing = !plugin.empty() && findAlgorithm(id, known) == nullptr;
  if (is_missing) throw InputError(fmt::format("--plugin: {}: has no algorithm '{}'", plugin, id));
  return requireAlgorithm(id, known);
}

}  // namespace

Command command() {
  return {.name = "worker",
          .summary = "Runs a case for the broadmark process that starts it.",
          .examples = {},
          .add = [](CLI::App&) -> std::function<int()> {
            return [] {
              serveCase(find);
              return 0;
            };
          },
          .internal = true};
}

}  // namespace broadmark::commands::worker
