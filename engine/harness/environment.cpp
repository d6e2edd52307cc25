// Queries Linux and the compiler for the environment.

#include "broadmark/harness/environment.h"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <ctime>
#include <fstream>
#include <set>

#include "broadmark/compiler.h"
#include "broadmark/cores.h"
#include "broadmark/execution.h"
#include "broadmark/harness/memory_limit.h"
#include "commit.h"

namespace broadmark {
namespace {

/// First line of a system file; "" if there is none.
std::string firstLine(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

/// The value of "key : value" lines in /proc/cpuinfo style, for every line with that key.
std::vector<std::string> valuesOf(const std::string& path, std::string_view key, char separator) {
  std::vector<std::string> values;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const auto split = line.find(separator);
    if (!line.starts_with(key) || split == std::string::npos) continue;
    const auto start = line.find_first_not_of(" \t\"", split + 1);
    const auto end = line.find_last_not_of(" \t\"");
    if (start != std::string::npos) values.push_back(line.substr(start, end - start + 1));
  }
  return values;
}

std::string firstOr(const std::vector<std::string>& values, const std::string& otherwise) {
  return values.empty() ? otherwise : values.front();
}

int physicalCores() {
  const auto packages = valuesOf("/proc/cpuinfo", "physical id", ':');
  const auto cores = valuesOf("/proc/cpuinfo", "core id", ':');
  std::set<std::pair<std::string, std::string>> distinct;
  for (std::size_t i = 0; i < std::min(packages.size(), cores.size()); ++i) {
    distinct.emplace(packages[i], cores[i]);
  }
  return static_cast<int>(distinct.size());
}

std::vector<std::string> caches() {
  std::vector<std::string> found;
  for (int index = 0;; ++index) {
    const std::string folder = fmt::format("/sys/devices/system/cpu/cpu0/cache/index{}/", index);
    const std::string level = firstLine(folder + "level");
    if (level.empty()) return found;
    found.push_back(
        fmt::format("L{} {} {}", level, firstLine(folder + "type"), firstLine(folder + "size")));
  }
}

std::string operatingSystem(const utsname& system) {
  return fmt::format("{}, {} {}", firstOr(valuesOf("/etc/os-release", "PRETTY_NAME", '='), "?"),
                     system.sysname, system.release);
}

std::string utcNow() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  ::gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

}  // namespace

Environment thisEnvironment() {
  utsname system{};
  ::uname(&system);
  Environment environment{
      .host = system.nodename,
      .cpu = firstOr(valuesOf("/proc/cpuinfo", "model name", ':'), "unknown"),
      .logical_cores = static_cast<int>(usableCores().size()),
      .physical_cores = physicalCores(),
      .caches = caches(),
      .isa = std::string(isaName(bestIsa())),
      .memory_bytes = machineMemory(),
      .governor = firstLine("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor"),
      .os = operatingSystem(system),
      .compiler = BROADMARK_COMPILER,
      .compiler_flags = BROADMARK_FLAGS,
      .build_type = BROADMARK_BUILD_TYPE,
      .version = BROADMARK_VERSION,
      .commit = build::commit,
      .commit_date = build::commit_date,
      .dirty = build::dirty,
      .started = utcNow()};
  ::getloadavg(&environment.load_average, 1);
  return environment;
}

std::string commitName(const Environment& environment) {
  if (environment.commit.empty()) return "unknown";
  constexpr std::size_t kDigits = 10;
  return environment.commit.substr(0, kDigits) + (environment.dirty ? " with changes" : "");
}

std::string buildName(const Environment& environment) {
  return fmt::format("{} (commit {}, {}{})", environment.version, commitName(environment),
                     environment.compiler, environment.compiler_flags);
}

}  // namespace broadmark
