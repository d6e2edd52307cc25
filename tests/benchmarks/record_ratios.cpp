// Compares `columns` with the best of the project's other algorithms on one thread, for each kind
// of boxes with several numbers of bodies, at new positions in every frame. The contestants
// alternate frame by frame, so that background load affects all of them. Prints each ratio beside
// its target; exit status 1 if a target is missed.
//
//   record_ratios [KIND [ROUNDS [BODIES]]]
//
// KIND: a kind in kinds_of_boxes.h, or all. BODIES: a single number of bodies for all kinds.

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "benchmarks/contest.h"
#include "benchmarks/kinds_of_boxes.h"
#include "benchmarks/thread_gain.h"

namespace {

using namespace broadmark;
using namespace broadmark::benchmarks;

/// The numbers of bodies and the target of a kind.
struct Trial {
  std::string_view kind;
  std::vector<std::size_t> counts;
  double target = 1 / 1.2;  ///< minimum speed-up over the best other algorithm
};

std::vector<Trial> trials() {
  const std::vector<std::size_t> all = {8'000, 64'000, 1'000'000};
  const std::vector<std::size_t> some = {64'000, 1'000'000};
  return {{"uniform", all, 5}, {"clustered", all},  {"clusters", some},
          {"assorted", some},  {"power law", some}, {"giants", {8'000, 64'000}},
          {"plane", some},     {"line", some},      {"spot", {1'000, 4'000}}};
}

constexpr std::array kOthers = {"grid2d-sap", "grid-sap", "sap-simd", "kd"};

bool measure(const Trial& trial, std::size_t count, int rounds) {
  const inputs::Generator boxes = kindOf(trial.kind).boxes;
  const std::vector<std::vector<Aabb>> frames = {boxes(count, 0, 1), boxes(count, 1, 1)};
  Contest contest(std::string(trial.kind), frames);
  for (const char* const id : kOthers) contest.add(id, caseOf(id));
  contest.add("columns", caseOf("columns"));
  contest.run(rounds);

  const auto best = std::ranges::min_element(
      kOthers, {}, [&](const char* id) { return contest.ratio(id, "columns"); });
  const double ratio = contest.ratio(*best, "columns");
  bool met = ratio >= trial.target;
  fmt::print("{:10} {:>8}  columns {:8.3f} ms {:6.1f} ns a body  {:10} {:8.3f} ms {:6.2f}x {}",
             trial.kind, count, contest.find("columns").median(),
             contest.find("columns").median() * 1e6 / static_cast<double>(count), *best,
             contest.find(*best).median(), ratio,
             met ? "ok" : fmt::format("MISSED {:.2f}", trial.target));
  if (std::thread::hardware_concurrency() >= 2) {
    const ThreadGain two = gainOfThreads("columns-mt", 2, frames, rounds);
    fmt::print("  two threads {:5.2f}x in {} of {} rounds with whole cores", two.median, two.rounds,
               two.all_rounds);
  }
  fmt::print("\n");
  return met;
}

int run(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const std::string_view wanted = argc > 1 ? argv[1] : "all";
  const int rounds = argc > 2 ? std::max(1, std::atoi(argv[2])) : 9;
  if (wanted != "all") kindOf(wanted);
  bool met = true;
  for (const Trial& trial : trials()) {
    if (wanted != "all" && wanted != trial.kind) continue;
    std::vector<std::size_t> counts = trial.counts;
    if (argc > 3) counts = {static_cast<std::size_t>(std::max(1, std::atoi(argv[3])))};
    for (const std::size_t count : counts) met &= measure(trial, count, rounds);
  }
  return met ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) {
  return broadmark::benchmarks::runMain("record_ratios", run, argc, argv);
}
