// What a frame costs in worlds that change: prints times, and the ratios that have a target. What
// is compared takes turns, frame by frame. Exit status 1 if a target is missed.
//
//   changing_world_ratios [PART [ROUNDS]]      PART: level, traffic, worlds; all by default

#include <fmt/format.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "benchmarks/changing_worlds.h"

namespace {

using namespace broadmark;
using namespace broadmark::benchmarks;

constexpr double kMost = 1e9;  ///< no target

Case caseOf(const std::string& id) {
  return makeCase(findAlgorithm(id).value(), bestIsa(), 1, "", {});
}

double mean(const std::vector<double>& numbers) {
  return std::accumulate(numbers.begin(), numbers.end(), 0.0) / static_cast<double>(numbers.size());
}

std::string counters(CaseHost& host) {
  std::string text;
  for (const auto& [name, count] : host.counters()) text += fmt::format(" {} {};", name, count);
  return text;
}

/// A million bodies that stand still and do not meet each other, and a hundred that move.
bool level(int rounds) {
  constexpr double kTarget_us = 100;
  bool met = true;
  StaticLevel world(1'000'000, 100);
  for (const auto& [id, target] :
       {std::pair{"kd", kTarget_us}, {"dbvt-d", kTarget_us}, {"dbvt-f", kMost}, {"tracy", kMost}}) {
    WorldContest contest;  // alone: a frame of the others would take the caches
    if (!contest.add(id, caseOf(id), world)) continue;
    contest.run(5, rounds);
    WorldContest::Entrant& entrant = contest.entrants()[0];
    const double us = mean(entrant.us);
    fmt::print(
        "level    {:10} start {:8.1f} ms  frame: mean {:8.1f} us, median {:8.1f}, p99 {:8.1f}, "
        "first {:.1f}{}\n",
        id, static_cast<double>(entrant.start_ns) * 1e-6, us, quantile(entrant.us, 0.5),
        quantile(entrant.us, 0.99), entrant.us[0],
        target == kMost ? ""
        : us <= target  ? "  ok"
                        : "  MISSED");
    fmt::print("        {}\n", counters(*entrant.host));
    met &= us <= target;
  }
  return met;
}

/// One in a hundred removed and as many added, beside two in a hundred moved.
bool traffic(int rounds) {
  constexpr std::uint32_t kBodies = 128'000;
  bool met = true;
  SomeMove moving(kBodies, kBodies / 50);
  ComeAndGo changing(kBodies, kBodies / 100);
  for (const std::string id : {"kd", "tracy", "dbvt-f", "dbvt-d"}) {
    WorldContest contest;
    contest.add("moving", caseOf(id), moving);
    contest.add("changing", caseOf(id), changing);
    contest.run(5, rounds);
    const std::vector<double>& move = contest.entrants()[0].us;
    const std::vector<double>& change = contest.entrants()[1].us;
    std::vector<double> ratios;
    for (std::size_t i = 0; i < move.size(); ++i) ratios.push_back(change[i] / move[i]);
    const double ratio = quantile(ratios, 0.5);
    fmt::print(
        "traffic  {:10} move 2 %: {:9.1f} us  remove and add 1 %: {:9.1f} us  ratio {:5.2f} "
        "[{:.2f}, {:.2f}]  {}\n",
        id, quantile(move, 0.5), quantile(change, 0.5), ratio, quantile(ratios, 0.25),
        quantile(ratios, 0.75), ratio <= 1 ? "ok" : "MISSED");
    met &= ratio <= 1;
  }
  return met;
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const std::string part = argc > 1 ? argv[1] : "all";
  const int rounds = argc > 2 ? std::max(1, std::atoi(argv[2])) : 200;
  bool met = true;
  if (part == "all" || part == "level") met &= level(rounds);
  if (part == "all" || part == "traffic") met &= traffic(rounds);
  return met ? EXIT_SUCCESS : EXIT_FAILURE;
}
