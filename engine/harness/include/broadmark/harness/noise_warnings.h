// Warnings about other load and whatever else may disturb the times of a case.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "broadmark/cores.h"
#include "broadmark/harness/case.h"
#include "broadmark/harness/environment.h"

namespace broadmark {

/// The machine's state while this process waits: all load then is from others.
struct MachineState {
  std::vector<int> usable_cores;  ///< by this process
  BusyShares busy;
  CoreSiblings siblings;
  bool turbo = false;  ///< clock speed varies with temperature
};

/// Samples the machine for a moment; the calling thread sleeps through it.
MachineState watchMachine(std::chrono::milliseconds moment, const SystemFolders& = {});

/// Possible disturbances of a case's times, a sentence each; unreported conditions give none.
std::vector<std::string> noiseWarnings(const Environment&, const MachineState&, const Case&);

}  // namespace broadmark
