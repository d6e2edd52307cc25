// Measures the overhead of a worker process: a duel of each case in this process with the same case
// in a worker process, on drifting boxes of many sizes; one in twenty jumps. Prints the median of
// the paired ratios (worker / this process) and its 95 % confidence interval: same within 3 % of 1.
// Exit status 1 where any differs.
//
// With --pin: a duel of the case in two worker processes, one of them with pinned threads. The
// spread is the interquartile range of a time, as a share of the median.
//
//   host_ratios [ALGORITHM...] [--objects N,...] [--threads T] [--seconds S] [--pin]

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/contest.h"
#include "broadmark/analysis/duel.h"
#include "broadmark/analysis/run_ratio.h"
#include "broadmark/harness/worker_process.h"
#include "torture/inputs.h"

namespace {

using namespace broadmark;
using broadmark::benchmarks::findAlgorithm;

constexpr double kSame = 0.03;

struct Options {
  std::vector<std::string> algorithms = {"bf", "sap-simd", "grid-sap", "kd", "tracy", "gpu-grid"};
  std::vector<std::size_t> objects = {1000, 32'000, 512'000};
  int threads = 1;
  double seconds = 60;
  bool pin = false;
};

ExecutorFactory workerMaker(bool pin) {
  return [pin](const Case& test_case, CancelQuery) {
    return makeWorkerProcess(test_case, WorkerOptions{.command = {"/proc/self/exe", "worker"},
                                                      .hard_limit = std::chrono::hours(1),
                                                      .pin = pin});
  };
}

std::vector<DuelSide> sidesOf(const Case& test_case, bool pin) {
  if (pin) {
    return {{"free", test_case, workerMaker(false)}, {"pinned", test_case, workerMaker(true)}};
  }
  return {{"here", test_case}, {"there", test_case, workerMaker(false)}};
}

/// A few frames, played forwards and backwards, so that all motion is smooth.
class Drifting final : public IndexedFrames {
 public:
  explicit Drifting(std::size_t objects) {
    for (std::uint32_t frame = 0; frame < 4; ++frame) {
      frames_.push_back(inputs::drifting(objects, frame, 1));
    }
    Aabb world = frames_[0][0];
    for (const Aabb& box : frames_[0]) world = merged(world, box);
    scene_ = {"Drifting", "Assorted", static_cast<std::uint32_t>(objects), 100, world};
  }

  [[nodiscard]] const SceneInfo& scene() const override { return scene_; }

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override {
    const std::size_t last = frames_.size() - 1;
    const std::size_t phase = index % (2 * last);
    return frames_[phase <= last ? phase : 2 * last - phase];
  }

  std::vector<std::vector<Aabb>> frames_;
  SceneInfo scene_;
};

/// Prints a line of results; false if the times differ.
bool measure(const std::string& id, Drifting& frames, const Options& options) {
  const std::optional<Algorithm> algorithm = findAlgorithm(id);
  if (!algorithm) throw std::invalid_argument("no algorithm '" + id + "'");
  const Case test_case = makeCase(*algorithm, bestIsa(), options.threads, "", {});
  const DuelResult duel =
      runDuel(sidesOf(test_case, options.pin), frames,
              {.precision = kSame, .max_seconds = options.seconds, .check = CheckMode::off});
  fmt::print("{:>8}  {:10} ", frames.scene().objects, id);
  if (!duel.ok()) {
    const auto failed = std::ranges::find_if(
        duel.sides, [](const auto& side) { return side.status != Status::ok; });
    fmt::print("{}: {}\n", statusName(failed->status), failed->reason);
    return failed->status == Status::unsupported;
  }
  const Estimate ratio = duel.ratio(1, 0);
  const Verdict verdict = verdictOn(ratio.ci95, kSame);
  fmt::print("{:4} rounds", duel.rounds());
  for (const DuelResult::Side& side : duel.sides) {
    const auto ms = [&](double q) { return 1e3 * quantile(side.seconds, q); };
    fmt::print("  {} {:10.4f} ms (spread {:2.0f} %)", side.name, ms(0.5),
               100 * (ms(0.75) - ms(0.25)) / ms(0.5));
  }
  fmt::print("  {:.3f} [{:.3f}, {:.3f}]  {}\n", ratio.value, ratio.ci95.low, ratio.ci95.high,
             kVerdicts.nameOf(verdict));
  std::fflush(stdout);
  return verdict == Verdict::same || verdict == Verdict::undecided;
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
  app.add_option("--threads", options.threads)->capture_default_str();
  app.add_flag("--pin", options.pin, "pinned threads against free ones");
  app.add_option("--seconds", options.seconds, "at most, for each line")->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  bool none_differs = true;
  for (const std::size_t objects : options.objects) {
    Drifting frames(objects);
    for (const std::string& id : options.algorithms) {
      none_differs &= measure(id, frames, options);
    }
  }
  return none_differs ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) {
  return broadmark::benchmarks::runMain("host_ratios", run, argc, argv);
}
