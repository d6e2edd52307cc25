// Linux's view of the cores: /proc/stat, /sys/devices/system/cpu.

#include "broadmark/cores.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
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

/// The CPU quota of a control group in cores; infinite without one.
double quotaOf(const std::filesystem::path& group) {
  std::ifstream file(group / "cpu.max");
  double quota = 0;  // microseconds in each period, or "max"
  double period = 0;
  return file >> quota >> period && period > 0 ? quota / period
                                               : std::numeric_limits<double>::infinity();
}

/// Sort key of a core: first whether an SMT sibling is chosen, then other load on the core.
std::tuple<bool, double> disadvantage(int core, const std::vector<int>& chosen,
                                      const BusyShares& busy, const CoreSiblings& siblings) {
  bool has_chosen_sibling = false;
  double load = busyShare(busy, core);
  const auto own = siblings.find(core);
  if (own != siblings.end()) {
    for (const int sibling : own->second) {
      has_chosen_sibling |= std::ranges::find(chosen, sibling) != chosen.end();
      load += busyShare(busy, sibling) / 2;  // a busy sibling shares units, not time
    }
  }
  return {has_chosen_sibling, load};
}

}  // namespace

double busyShare(const BusyShares& busy, int core) {
  const auto found = busy.find(core);
  return found == busy.end() ? 0 : found->second;
}

int availableCores(const SystemFolders& folders, std::size_t usable) {
  auto cores = static_cast<double>(usable);
  std::ifstream groups(folders.proc / "self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    if (!line.starts_with("0::/")) continue;  // another version
    std::filesystem::path group = line.substr(4);
    for (; !group.empty(); group = group.parent_path()) {
      cores = std::min(cores, quotaOf(folders.sys / "fs/cgroup" / group));
    }
    cores = std::min(cores, quotaOf(folders.sys / "fs/cgroup"));
  }
  return std::max(1, static_cast<int>(std::ceil(cores)));
}

std::map<int, CoreTicks> coreTicks(const SystemFolders& folders) {
  std::map<int, CoreTicks> ticks;
  std::ifstream file(folders.proc / "stat");
  for (std::string line; std::getline(file, line) && line.starts_with("cpu");) {
    if (line.starts_with("cpu ")) continue;  // the sum over all cores
    std::istringstream stream(line.substr(3));
    int core = 0;
    stream >> core;
    // user, nice, system, idle, iowait, irq, softirq, steal; later fields are included in these.
    std::array<std::uint64_t, 8> fields{};
    for (std::uint64_t& field : fields) stream >> field;
    const std::uint64_t idle = fields[3] + fields[4];
    ticks[core] = {std::accumulate(fields.begin(), fields.end(), std::uint64_t{0}) - idle, idle};
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
    // Linux may decrease the iowait ticks.
    if (busy + idle > 0) shares[core] = std::clamp(busy / (busy + idle), 0.0, 1.0);
  }
  return shares;
}

BusyShares measureBusyShares(std::chrono::milliseconds duration, const SystemFolders& folders) {
  const auto before = coreTicks(folders);
  if (before.empty()) return {};
  std::this_thread::sleep_for(duration);
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
  std::vector<int> chosen;
  if (count > static_cast<int>(usable.size())) return chosen;
  std::vector<int> remaining = usable;
  while (static_cast<int>(chosen.size()) < count) {
    const auto best = std::ranges::min_element(
        remaining, {}, [&](int core) { return disadvantage(core, chosen, busy, siblings); });
    chosen.push_back(*best);
    remaining.erase(best);
  }
  return chosen;
}

}  // namespace broadmark
