// Warnings about other load and other disturbances of a case's times.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "broadmark/cores.h"
#include "broadmark/harness/case.h"
#include "broadmark/harness/environment.h"

namespace broadmark {

/// The machine's state while this process waits: all load is from other processes.
struct MachineState {
  std::vector<int> usable_cores;  ///< by this process
  BusyShares busy;
  CoreSiblings siblings;
  bool turbo = false;  ///< clock speed varies with temperature
};

/// Samples the machine for `duration`, during which the calling thread sleeps.
MachineState sampleMachine(std::chrono::milliseconds duration, const SystemFolders& = {});

/// Possible disturbances of a case's times, a sentence each; unreported conditions give none.
std::vector<std::string> noiseWarnings(const Environment&, const MachineState&, const Case&);

}  // namespace broadmark
