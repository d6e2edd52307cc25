// The cores of the machine: which of them this process may use, which are SMT siblings, and how
// busy they are. Results are empty where the system does not report them, as in many containers.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <vector>

namespace broadmark {

/// The system's report folders. Tests substitute their own.
struct SystemFolders {
  std::filesystem::path proc = "/proc";
  std::filesystem::path sys = "/sys";
};

/// The system's numbers of the cores that the calling thread may use, ascending.
std::vector<int> usableCores();

/// How many cores this process can keep busy: those `usable`, at most as many as the CPU quota of
/// its control groups (cgroup v2, as for containers), rounded up.
int availableCores(const SystemFolders& = {}, std::size_t usable = usableCores().size());

/// A core's busy and total time since the system started, in ticks.
struct CoreTicks {
  std::uint64_t busy = 0;
  std::uint64_t idle = 0;
};
/// The ticks of all cores, by number.
std::map<int, CoreTicks> coreTicks(const SystemFolders& = {});

/// The busy fraction of each core in a time span, by number.
using BusyShares = std::map<int, double>;
/// The busy fraction of a core; 0 if unknown.
double busyShare(const BusyShares& busy, int core);
BusyShares busySharesBetween(const std::map<int, CoreTicks>& before,
                             const std::map<int, CoreTicks>& after);
/// Measures the busy fractions over `duration`, during which the calling thread sleeps. The system
/// counts in ticks of 10 ms.
BusyShares measureBusyShares(std::chrono::milliseconds duration, const SystemFolders& = {});

/// The SMT siblings (hyper-threads) of each core.
using CoreSiblings = std::map<int, std::vector<int>>;
CoreSiblings coreSiblings(const SystemFolders& = {});

/// Chooses the `count` usable cores with the least other load on them and their siblings, if
/// possible no two siblings. Empty if fewer cores are usable.
std::vector<int> quietestCores(int count, const std::vector<int>& usable, const BusyShares& busy,
                               const CoreSiblings& siblings);

}  // namespace broadmark
