// broadmark simulate: runs a simulation for the process that started it.

#include "commands/command.h"
#include "request/simulation_process.h"

namespace broadmark::commands::simulate {

Command command() {
  return {.name = "simulate",
          .summary = "Runs a simulation for the broadmark process that starts it.",
          .examples = {},
          .add = [](CLI::App&) -> std::function<int()> {
            return [] {
              serveSimulation();
              return 0;
            };
          },
          .internal = true};
}

}  // namespace broadmark::commands::simulate
