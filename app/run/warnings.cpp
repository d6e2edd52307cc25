#include "run/warnings.h"

#include <fmt/format.h>

#include <iostream>

namespace broadmark {

namespace {

/// Ten system ticks: long enough to distinguish a busy core from an idle one.
constexpr std::chrono::milliseconds kSampleTime{100};

}  // namespace

RunWarnings::RunWarnings(const Environment& environment)
    : environment_(environment), machine_(sampleMachine(kSampleTime)) {}

std::vector<std::string> RunWarnings::warningsFor(const Case& test_case) {
  std::vector<std::string> warnings = noiseWarnings(environment_, machine_, test_case);
  for (const std::string& warning : warnings) {
    if (shown_.insert(warning).second) print(warning);
  }
  return warnings;
}

void RunWarnings::print(const std::string& warning) {
  std::cerr << fmt::format("broadmark: warning: {}\n", warning);
}

}  // namespace broadmark
