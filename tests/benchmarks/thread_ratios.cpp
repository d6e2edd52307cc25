// Speed-up of algorithms by threads, on unit cubes at new positions in every frame. Prints each
// gain beside its target, which is for two threads; exit status 1 if a target is missed.
//
//   thread_ratios [THREADS [ROUNDS]]

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/thread_gain.h"
#include "torture/inputs.h"

namespace {

using namespace broadmark;
using namespace broadmark::benchmarks;

struct Trial {
  std::string id;
  std::size_t bodies;
  std::optional<double> target = {};
};

std::vector<Trial> trials() {
  return {
      {"bf-mt", 32'768, 1.7},        {"bf-simd-mt", 32'768, 1.7}, {"sap-mt", 131'072, 1.5},
      {"sap-simd-mt", 131'072, 1.5}, {"grid-bf-mt", 128'000},     {"grid-sap-mt", 128'000},
      {"grid2d-bf-mt", 128'000},     {"grid2d-sap-mt", 128'000},  {"kd-mt", 128'000},
      {"tracy-mt", 128'000},         {"columns-mt", 128'000},     {"columns-mt", 1'000'000, 1.85}};
}

bool measure(const Trial& trial, int threads, int rounds) {
  const std::vector<std::vector<Aabb>> frames = {inputs::uniform(trial.bodies, 0, 1),
                                                 inputs::uniform(trial.bodies, 1, 1)};
  const ThreadGain gain = gainOfThreads(trial.id, threads, frames, rounds);
  if (gain.rounds == 0) {
    fmt::print("{:14} {:>8}  no round of {} with whole cores\n", trial.id, trial.bodies,
               gain.all_rounds);
    return true;
  }
  fmt::print(
      "{:14} {:>8}  {:9.2f} ms  {} threads {:9.2f} ms  {:5.2f}x [{:.2f}, {:.2f}] in {:>2} of {:>3} "
      "rounds with whole cores",
      trial.id, trial.bodies, gain.one_ms, threads, gain.several_ms, gain.median, gain.min,
      gain.max, gain.rounds, gain.all_rounds);
  const bool met = threads != 2 || !trial.target || gain.median >= *trial.target;
  fmt::print("{}\n", met ? "" : fmt::format("  MISSED {:.2f}", *trial.target));
  return met;
}

}  // namespace

int main(int argc, char** argv) {
  const auto benchmark = [](int count, char** arguments) {
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    const int threads = count > 1 ? std::max(2, std::atoi(arguments[1])) : 2;
    const int rounds = count > 2 ? std::max(1, std::atoi(arguments[2])) : 9;
    bool met = true;
    for (const Trial& trial : trials()) met &= measure(trial, threads, rounds);
    return met ? EXIT_SUCCESS : EXIT_FAILURE;
  };
  return runMain("thread_ratios", benchmark, argc, argv);
}
