// Shows how little a worker process changes times: the same case in this process and in a worker
// process, turn by turn on the same frames: boxes of many sizes that drift about, one in twenty
// jumps. Prints the median of the paired ratios (worker / this process) and its 95 % confidence
// interval, from the order statistics of the rounds: same within 3 % of 1, different beyond, else
// undecided. Exit status 1 where any differs.
//
//   host_ratios [ALGORITHM...] [--objects N,...] [--rounds R] [--seconds S]

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "benchmarks/contest.h"
#include "broadmark/worker_process.h"
#include "support/inputs.h"

namespace {

using namespace broadmark;
using broadmark::benchmarks::Contest;
using broadmark::benchmarks::findAlgorithm;

constexpr double kSame = 0.03;

struct Options {
  std::vector<std::string> algorithms = {"bf", "sap-simd", "grid-sap", "kd", "tracy", "gpu-grid"};
  std::vector<std::size_t> objects = {1000, 32'000, 512'000};
  int rounds = 200;
  double seconds = 60;
};

std::unique_ptr<CaseHost> makeWorker(const Case& run, CancelQuery) {
  return std::make_unique<WorkerProcess>(run, WorkerOptions{.command = {"/proc/self/exe", "worker"},
                                                            .hard_limit = std::chrono::hours(1)});
}

/// The ranks between which the median of `count` values lies with 95 % confidence.
std::pair<double, double> medianInterval(std::vector<double> values) {
  std::ranges::sort(values);
  const auto count = static_cast<double>(values.size());
  const double half = 0.98 * std::sqrt(count);
  const auto rank = [&](double wanted) {
    return values[static_cast<std::size_t>(std::clamp(wanted, 0.0, count - 1))];
  };
  return {rank(std::floor(count / 2 - half)), rank(std::ceil(count / 2 + half))};
}

/// Prints one line; false where the times differ.
bool measure(const std::string& id, std::span<const std::vector<Aabb>> frames,
             const Options& options) {
  const std::optional<Algorithm> algorithm = findAlgorithm(id);
  if (!algorithm) throw std::invalid_argument("no algorithm '" + id + "'");
  const Case run = makeCase(*algorithm, bestIsa(), 1, "", {});
  Contest contest("Drifting", frames);
  try {
    contest.add("here", run);
  } catch (const UnsupportedError& error) {
    fmt::print("{:>8}  {:10} skipped: {}\n", frames[0].size(), id, error.what());
    return true;
  }
  contest.add("there", run, makeWorker);
  const auto end =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(options.seconds);
  int rounds = 0;
  while (rounds < options.rounds && (rounds < 5 || std::chrono::steady_clock::now() < end)) {
    const int more = std::min(5, options.rounds - rounds);
    contest.run(more);
    rounds += more;
  }
  const auto [low, high] = medianInterval(contest.ratios("there", "here"));
  const bool differs = low > 1 + kSame || high < 1 - kSame;
  const bool same = low > 1 - kSame && high < 1 + kSame;
  fmt::print(
      "{:>8}  {:10} {:4} rounds  here {:10.4f} ms  there {:10.4f} ms  {:.3f} [{:.3f}, {:.3f}]  "
      "{}\n",
      frames[0].size(), id, rounds, contest.find("here").median(), contest.find("there").median(),
      contest.ratio("there", "here"), low, high,
      differs ? "DIFFERENT"
      : same  ? "same"
              : "undecided");
  std::fflush(stdout);
  return !differs;
}

int run(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "worker") {
    serveCase([](const std::string& id, const std::string&) { return findAlgorithm(id).value(); });
    return EXIT_SUCCESS;
  }
  Options options;
  CLI::App app("Times in a worker process against times in this one");
  app.add_option("algorithms", options.algorithms)->capture_default_str();
  app.add_option("--objects", options.objects)->delimiter(',')->capture_default_str();
  app.add_option("--rounds", options.rounds, "at most")->capture_default_str();
  app.add_option("--seconds", options.seconds, "for each line, at least 5 rounds")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  bool none_differs = true;
  for (const std::size_t objects : options.objects) {
    std::vector<std::vector<Aabb>> frames;
    for (std::uint32_t frame = 0; frame < 4; ++frame) {
      frames.push_back(inputs::drifting(objects, frame, 1));
    }
    for (const std::string& id : options.algorithms) none_differs &= measure(id, frames, options);
  }
  return none_differs ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) {
  return broadmark::benchmarks::runMain("host_ratios", run, argc, argv);
}
