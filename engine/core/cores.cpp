// Linux's view of the cores: sched_getaffinity, /proc/stat, /sys/devices/system/cpu.

#include "broadmark/cores.h"

#include <sched.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <numeric>
#include <sstream>
#include <string>
#include <thread>
#include <tuple>

namespace broadmark {
namespace {

/// The cores of a list such as "0-2,8".
std::vector<int> coresOfList(std::istream& list) {
  std::vector<int> cores;
  for (int first = 0; list >> first;) {
    int last = first;
    if (list.peek() == '-') list.ignore() >> last;
    for (int core = first; core <= last; ++core) cores.push_back(core);
    if (list.peek() == ',') list.ignore();
  }
  return cores;
}

/// Sort key of a core, worst criterion first: an SMT sibling is used; other work on the core.
std::tuple<bool, double> disadvantage(int core, const std::vector<int>& taken,
                                      const BusyShares& busy, const CoreSiblings& siblings) {
  bool is_beside_taken = false;
  double work = busyShare(busy, core);
  const auto beside = siblings.find(core);
  if (beside != siblings.end()) {
    for (const int sibling : beside->second) {
      is_beside_taken |= std::ranges::find(taken, sibling) != taken.end();
      work += busyShare(busy, sibling) / 2;  // a busy sibling shares units, not time
    }
  }
  return {is_beside_taken, work};
}

}  // namespace

double busyShare(const BusyShares& busy, int core) {
  const auto found = busy.find(core);
  return found == busy.end() ? 0 : found->second;
}

std::vector<int> usableCores() {
  std::vector<int> cores;
  cpu_set_t set;
  CPU_ZERO(&set);
  if (::sched_getaffinity(0, sizeof set, &set) != 0) return {0};
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (CPU_ISSET(core, &set)) cores.push_back(core);
  }
  return cores;
}

std::map<int, CoreTicks> coreTicks(const SystemFolders& folders) {
  std::map<int, CoreTicks> ticks;
  std::ifstream file(folders.proc / "stat");
  for (std::string line; std::getline(file, line) && line.starts_with("cpu");) {
    if (line.starts_with("cpu ")) continue;  // the sum over all cores
    std::istringstream words(line.substr(3));
    int core = 0;
    words >> core;
    // user, nice, system, idle, iowait, irq, softirq, steal; later fields are included in these.
    std::array<std::uint64_t, 8> kinds{};
    for (std::uint64_t& kind : kinds) words >> kind;
    const std::uint64_t idle = kinds[3] + kinds[4];
    ticks[core] = {std::accumulate(kinds.begin(), kinds.end(), std::uint64_t{0}) - idle, idle};
  }
  return ticks;
}

BusyShares busySharesBetween(const std::map<int, CoreTicks>& before,
                             const std::map<int, CoreTicks>& after) {
  BusyShares shares;
  for (const auto& [core, now] : after) {
    const auto then = before.find(core);
    if (then == before.end()) continue;
    const auto busy = static_cast<double>(now.busy) - static_cast<double>(then->second.busy);
    const auto idle = static_cast<double>(now.idle) - static_cast<double>(then->second.idle);
    // Linux may decrease the waiting ticks.
    if (busy + idle > 0) shares[core] = std::clamp(busy / (busy + idle), 0.0, 1.0);
  }
  return shares;
}

BusyShares watchCores(std::chrono::milliseconds moment, const SystemFolders& folders) {
  const auto before = coreTicks(folders);
  if (before.empty()) return {};
  std::this_thread::sleep_for(moment);
  return busySharesBetween(before, coreTicks(folders));
}

CoreSiblings coreSiblings(const SystemFolders& folders) {
  CoreSiblings siblings;
  for (const auto& [core, ticks] : coreTicks(folders)) {
    std::ifstream list(folders.sys / ("devices/system/cpu/cpu" + std::to_string(core)) /
                       "topology/thread_siblings_list");
    std::vector<int> others = coresOfList(list);
    std::erase(others, core);
    if (!others.empty()) siblings[core] = std::move(others);
  }
  return siblings;
}

std::vector<int> quietestCores(int count, const std::vector<int>& usable, const BusyShares& busy,
                               const CoreSiblings& siblings) {
  std::vector<int> taken;
  if (count > static_cast<int>(usable.size())) return taken;
  std::vector<int> left = usable;
  while (static_cast<int>(taken.size()) < count) {
    const auto best = std::ranges::min_element(
        left, {}, [&](int core) { return disadvantage(core, taken, busy, siblings); });
    taken.push_back(*best);
    left.erase(best);
  }
  return taken;
}

}  // namespace broadmark
