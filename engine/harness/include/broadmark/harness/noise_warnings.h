// How quiet the machine is, and what else may spoil the times of a case: told in words.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "broadmark/cores.h"
#include "broadmark/harness/case.h"
#include "broadmark/harness/environment.h"

namespace broadmark {

/// The machine as it is while this process waits: all that is busy then is the work of others.
struct MachineState {
  std::vector<int> usable_cores;  ///< that this process may use
  BusyShares busy;
  CoreSiblings siblings;
  bool turbo = false;  ///< cores may go faster than their nominal frequency, while they are cool
};

/// Watches the machine for a moment, in which the calling thread sleeps.
MachineState watchMachine(std::chrono::milliseconds moment, const SystemFolders& = {});

/// What may disturb the times of a case, a sentence each; nothing of what the system does not tell.
std::vector<std::string> noiseWarnings(const Environment&, const MachineState&, const Case&);

}  // namespace broadmark
