#include "run/warnings.h"

#include <fmt/format.h>

#include <iostream>

namespace broadmark {

namespace {

/// Ten of the system's ticks: long enough to tell a busy core from an idle one.
constexpr std::chrono::milliseconds kWatchTime{100};

}  // namespace

RunWarnings::RunWarnings(const Environment& environment)
    : environment_(environment), machine_(watchMachine(kWatchTime)) {}

std::vector<std::string> RunWarnings::of(const Case& test_case) {
  std::vector<std::string> warnings = noiseWarnings(environment_, machine_, test_case);
  for (const std::string& warning : warnings) {
    if (said_.insert(warning).second) std::cerr << fmt::format("broadmark: warning: {}\n", warning);
  }
  return warnings;
}

}  // namespace broadmark
