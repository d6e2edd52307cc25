// The cores of the machine: which of them this process may use, which are SMT siblings, and how
// busy they are. Results are empty where the system does not report them, as in many containers.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <vector>

namespace broadmark {

/// Where the system reports on itself. Tests substitute their own folders.
struct SystemFolders {
  std::filesystem::path proc = "/proc";
  std::filesystem::path sys = "/sys";
};

/// The cores that the calling thread may use, by the system's numbers, ascending.
std::vector<int> usableCores();

/// A core's busy and total time since the system started, in ticks.
struct CoreTicks {
  std::uint64_t busy = 0;
  std::uint64_t idle = 0;
};
/// By the core's number.
std::map<int, CoreTicks> coreTicks(const SystemFolders& = {});

/// The fraction of a time span in which each core was busy, by its number.
using BusyShares = std::map<int, double>;
/// 0 for an unknown core.
double busyShare(const BusyShares& busy, int core);
BusyShares busySharesBetween(const std::map<int, CoreTicks>& before,
                             const std::map<int, CoreTicks>& after);
/// The busy fractions over the coming moment; the calling thread sleeps through it. The system
/// counts in ticks of 10 ms.
BusyShares watchCores(std::chrono::milliseconds moment, const SystemFolders& = {});

/// For each core its SMT siblings (hyper-threads).
using CoreSiblings = std::map<int, std::vector<int>>;
CoreSiblings coreSiblings(const SystemFolders& = {});

/// `count` of the usable cores, with the least other work on them and their siblings, and if
/// possible no two siblings. Empty if fewer cores are usable.
std::vector<int> quietestCores(int count, const std::vector<int>& usable, const BusyShares& busy,
                               const CoreSiblings& siblings);

}  // namespace broadmark
