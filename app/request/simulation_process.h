// Simulations in processes of their own, which can be ended at any time: an engine may crash, take
// minutes for a frame, or never return.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "broadmark/harness/case_executor.h"
#include "broadmark/scenes/simulation.h"

namespace broadmark {

/// Decides where a simulation runs: returns one with the same parameters and frames. Its calls
/// throw Cancelled soon after `cancelled` returns true.
using SimulationHost =
    std::function<std::unique_ptr<Simulation>(std::unique_ptr<Simulation>, CancelQuery cancelled)>;

/// In this process, where calls cannot be cancelled.
std::unique_ptr<Simulation> simulateInProcess(std::unique_ptr<Simulation>, CancelQuery);

/// In processes, which are instances of `program`. A crash is an InputError.
SimulationHost simulateInProcesses(std::string program = "/proc/self/exe");

/// The process's side: serves its parent until that hangs up.
void serveSimulation();

}  // namespace broadmark
