// The cores of the machine: which this process may use, which are two halves of one, and what keeps
// them busy. Where the system does not tell, as in many containers, there is nothing.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <vector>

namespace broadmark {

/// Where the system tells of itself. Tests have folders of their own.
struct SystemFolders {
  std::filesystem::path proc = "/proc";
  std::filesystem::path sys = "/sys";
};

/// Those that the calling thread may use, by the system's numbers, in ascending order.
std::vector<int> usableCores();

/// What a core has done since the system started, in ticks.
struct CoreTicks {
  std::uint64_t busy = 0;
  std::uint64_t idle = 0;
};
/// By the core's number.
std::map<int, CoreTicks> coreTicks(const SystemFolders& = {});

/// Which share of a time each core was busy, by its number.
using BusyShares = std::map<int, double>;
/// 0 for a core of which nothing is known.
double busyShare(const BusyShares& busy, int core);
BusyShares busySharesBetween(const std::map<int, CoreTicks>& before,
                             const std::map<int, CoreTicks>& after);
/// Those of the coming moment, which the calling thread sleeps through. The system counts in ticks
/// of 10 ms.
BusyShares watchCores(std::chrono::milliseconds moment, const SystemFolders& = {});

/// For each core the others that share its units (hyper-threads).
using CoreSiblings = std::map<int, std::vector<int>>;
CoreSiblings coreSiblings(const SystemFolders& = {});

/// `count` of the usable cores, those with the least other work on them and beside them, and if
/// possible no two that share units. Empty if there are not so many.
std::vector<int> quietestCores(int count, const std::vector<int>& usable, const BusyShares& busy,
                               const CoreSiblings& siblings);

}  // namespace broadmark
