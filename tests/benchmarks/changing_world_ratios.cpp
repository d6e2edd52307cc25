// Frame times in changing worlds. Contestants alternate frame by frame, so that their ratios are
// meaningful. Exit status 1 if a target is missed.
//
//   changing_world_ratios [PART [ROUNDS]]
//
// PART: level    a level of 1,000,000 static and 100 moving bodies: two families take at most
//                100 µs
//       still    the same level without moving bodies: one family takes at most 1 µs
//       traffic  1 % of 128,000 bodies removed and as many added: at most the time of moving 2 %
//       culling  a level with layers beside the same boxes without layers
//       worlds   256 worlds at the same position in one case beside a case each: at most 1.1 times
//                as long, every algorithm of one thread

#include <fmt/format.h>

#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "benchmarks/changing_worlds.h"

namespace {

using namespace broadmark;
using namespace broadmark::benchmarks;

/// Prints the times and the ratio of two entrants; false if it exceeds `target` (0: none).
bool compare(const std::string& what, const WorldContest::Entrant& a,
             const WorldContest::Entrant& b, double target = 0) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < a.us.size(); ++i) ratios.push_back(a.us[i] / b.us[i]);
  const double ratio = quantile(ratios, 0.5);
  const bool met = target == 0 || ratio <= target;
  fmt::print("{:20} {:12} {:10.1f} us  {:12} {:10.1f} us  ratio {:6.3f} [{:.3f}, {:.3f}]  {}\n",
             what, a.name, quantile(a.us, 0.5), b.name, quantile(b.us, 0.5), ratio,
             quantile(ratios, 0.25), quantile(ratios, 0.75),
             target == 0 ? ""
             : met       ? "ok"
                         : "MISSED");
  return met;
}

/// Whether at least `families` families answer with events within a mean of `max_us` in a level
/// with `movers` moving bodies.
bool level(std::string_view part, std::uint32_t movers, double max_us, int families, int rounds) {
  StaticLevel world(1'000'000, movers);
  int met = 0;
  for (const std::string id : {"tide", "kd", "dbvt-d", "dbvt-f", "tracy"}) {
    for (const auto& [answer, name] : kAnswerKinds.entries) {
      WorldContest contest;  // of a single entrant: others would evict its caches
      if (!contest.add(id, caseOf(id, answer), world)) continue;
      contest.run(5, rounds);
      WorldContest::Entrant& entrant = contest.entrants()[0];
      const double us = std::accumulate(entrant.us.begin(), entrant.us.end(), 0.0) /
                        static_cast<double>(entrant.us.size());
      fmt::print("{} {:8} {:7} start {:7.2f} s  mean {:9.2f} us  median {:9.2f}  p99 {:9.2f}\n",
                 part, id, name, static_cast<double>(entrant.start_ns) * 1e-9, us,
                 quantile(entrant.us, 0.5), quantile(entrant.us, 0.99));
      met += us <= max_us && answer == AnswerKind::events ? 1 : 0;
    }
  }
  return met >= families;
}

bool traffic(int rounds) {
  constexpr std::uint32_t kBodies = 128'000;
  bool met = true;
  SomeMove moving(inputs::uniform(kBodies, 0, 1), kBodies / 50);
  ComeAndGo changing(kBodies, kBodies / 100);
  for (const std::string id : {"tide", "kd", "tracy", "dbvt-f", "dbvt-d"}) {
    WorldContest contest;
    contest.add("remove, add", caseOf(id), changing);
    contest.add("move", caseOf(id), moving);
    contest.run(5, rounds);
    met &= compare("traffic " + id, contest.entrants()[0], contest.entrants()[1], 1);
  }
  return met;
}

void culling(int rounds) {
  StaticLevel layered(100'000, 100, true);
  StaticLevel plain(100'000, 100, false);
  for (const std::string id : {"grid-bf", "grid-sap", "grid2d-sap", "sap-simd", "kd"}) {
    WorldContest contest;
    contest.add("layers", caseOf(id), layered);
    contest.add("none", caseOf(id), plain);
    contest.run(3, rounds);
    compare("culling " + id, contest.entrants()[0], contest.entrants()[1]);
  }
}

bool worlds(int rounds) {
  constexpr double kMaxRatio = 1.1;
  bool met = true;
  ManyWorlds all(256, 100);
  for (const Algorithm& algorithm : builtinAlgorithms()) {
    const AlgorithmTraits& traits = algorithm.traits;
    if (!traits.finds_pairs || traits.parallel || traits.on_device) continue;
    const std::string& id = algorithm.id;
    WorldContest contest;
    contest.add("together", caseOf(id), all);
    WorldContest::Entrant apart = {.name = "apart"};
    std::vector<std::unique_ptr<CaseExecutor>> hosts;
    for (std::uint32_t world = 0; world < all.worlds(); ++world) {
      hosts.push_back(makeInProcessExecutor(caseOf(id), {}));
      hosts.back()->start(all.worldScene(), all.worldFrame(world));
    }
    for (int round = -3; round < rounds; ++round) {
      contest.run(round < 0 ? 1 : 0, round < 0 ? 0 : 1);
      double us = 0;
      for (std::uint32_t world = 0; world < all.worlds(); ++world) {
        const StepResult result = hosts[world]->step(all.worldFrame(world));
        us += static_cast<double>(result.times[Phase::total]) * 1e-3;
      }
      if (round >= 0) apart.us.push_back(us);
    }
    met &= compare("worlds " + id, contest.entrants()[0], apart, kMaxRatio);
  }
  return met;
}

int run(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const std::string_view part = argc > 1 ? argv[1] : "all";
  const int rounds = argc > 2 ? std::max(1, std::atoi(argv[2])) : 100;
  const auto selected = [&](std::string_view name) { return part == "all" || part == name; };
  bool met = true;
  if (selected("level")) met &= level("level", 100, 100, 2, rounds);
  if (selected("still")) met &= level("still", 0, 1, 1, rounds);
  if (selected("traffic")) met &= traffic(rounds);
  if (selected("culling")) culling(rounds);
  if (selected("worlds")) met &= worlds(rounds);
  return met ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) {
  return broadmark::benchmarks::runMain("changing_world_ratios", run, argc, argv);
}
