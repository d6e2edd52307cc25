// Each warning has a separate function, which appends to the list.

#include "broadmark/harness/noise_warnings.h"

#include <fmt/format.h>

#include <fstream>
#include <optional>
#include <utility>

namespace broadmark {
namespace {

using Texts = std::vector<std::string>;

/// Load of a core below this is ignored. A single tick in a short moment is insignificant.
constexpr double kIgnoredLoad = 0.25;

/// The first value in a file; nullopt if there is none.
std::optional<int> numberIn(const std::filesystem::path& path) {
  std::ifstream file(path);
  int number = 0;
  return file >> number ? std::optional(number) : std::nullopt;
}

bool hasTurbo(const SystemFolders& folders) {
  const auto cpu = folders.sys / "devices/system/cpu";
  // Intel's driver reports "off", the others "on".
  if (const auto off = numberIn(cpu / "intel_pstate/no_turbo")) return *off == 0;
  return numberIn(cpu / "cpufreq/boost").value_or(0) != 0;
}

void warnOfLoad(Texts& warnings, const MachineState& machine) {
  double busy = 0;
  for (const int core : machine.usable_cores) busy += busyShare(machine.busy, core);
  if (busy < kIgnoredLoad) return;
  warnings.push_back(
      fmt::format("other programs keep {:.1f} of {} cores busy: times are longer and vary more",
                  busy, machine.usable_cores.size()));
}

/// A busy core slows its SMT sibling, even if the case does not run on it.
void warnOfSiblings(Texts& warnings, const MachineState& machine, int threads) {
  if (std::cmp_greater_equal(threads, machine.usable_cores.size())) return;  // all cores are used
  for (const int core : machine.usable_cores) {
    const auto own = machine.siblings.find(core);
    if (own == machine.siblings.end()) continue;
    for (const int sibling : own->second) {
      if (busyShare(machine.busy, sibling) < kIgnoredLoad) continue;
      warnings.push_back(
          fmt::format("core {} (SMT sibling of core {}) is busy; timings on core {} will be slower",
                      sibling, core, core));
    }
  }
}

void warnOfFrequency(Texts& warnings, const Environment& environment, const MachineState& machine) {
  if (!environment.governor.empty() && environment.governor != "performance") {
    warnings.push_back(fmt::format(
        "the frequency governor is '{}': with 'performance' the cores run at a constant frequency",
        environment.governor));
  }
  if (machine.turbo) {
    warnings.push_back("CPU turbo is enabled: clock speed varies with temperature");
  }
}

void warnOfThreads(Texts& warnings, const MachineState& machine, int threads) {
  if (std::cmp_less_equal(threads, machine.usable_cores.size())) return;
  warnings.push_back(
      fmt::format("{} threads share {} cores", threads, machine.usable_cores.size()));
}

void warnOfSelfTiming(Texts& warnings, const Algorithm& algorithm) {
  if (!algorithm.traits.self_timed) return;
  warnings.push_back(fmt::format("{}: times are reported by the program itself", algorithm.id));
}

void warnOfBuilds(Texts& warnings, const Environment& environment, const Algorithm& algorithm) {
  if (environment.build_type == "Debug") {
    warnings.push_back("this is a Debug build of Broadmark: its algorithms are slow");
  }
  if (algorithm.plugin_build.unoptimised) {
    warnings.push_back(
        fmt::format("{} was built without optimisation: build it with -DCMAKE_BUILD_TYPE=Release",
                    algorithm.plugin));
  }
}

}  // namespace

MachineState sampleMachine(std::chrono::milliseconds duration, const SystemFolders& folders) {
  return {.usable_cores = usableCores(),
          .busy = measureBusyShares(duration, folders),
          .siblings = coreSiblings(folders),
          .turbo = hasTurbo(folders)};
}

std::vector<std::string> noiseWarnings(const Environment& environment, const MachineState& machine,
                                       const Case& test_case) {
  Texts warnings;
  warnOfLoad(warnings, machine);
  warnOfSiblings(warnings, machine, test_case.threads);
  warnOfFrequency(warnings, environment, machine);
  warnOfThreads(warnings, machine, test_case.threads);
  warnOfSelfTiming(warnings, test_case.algorithm);
  warnOfBuilds(warnings, environment, test_case.algorithm);
  return warnings;
}

}  // namespace broadmark
