// What a frame costs by how many bodies move: a curve, `tide` beside others, all with events.
// Bodies are unit cubes, a tenth of the space; in each frame others move by up to half a unit on
// each axis. The contestants take turns frame by frame.
//
//   tide_ratios [BODIES [ROUNDS [ALGORITHM...]]]

#include <fmt/format.h>

#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "benchmarks/changing_worlds.h"

namespace {

using namespace broadmark;
using namespace broadmark::benchmarks;

struct Curve {
  std::string id;
  std::vector<double> us;  ///< by share of movers
};

void measure(std::uint32_t bodies, std::uint32_t movers, int rounds, std::vector<Curve>& curves) {
  SomeMove world(bodies, movers);
  WorldContest contest;
  for (const Curve& curve : curves) {
    contest.add(curve.id, caseOf(curve.id, AnswerKind::events), world);
  }
  contest.run(3, rounds);
  fmt::print("{:>9} of {:>9}", movers, bodies);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    curves[i].us.push_back(quantile(contest.entrants()[i].us, 0.5));
    fmt::print("  {:>12.1f}", curves[i].us.back());
  }
  fmt::print("\n");
}

int run(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const auto bodies = static_cast<std::uint32_t>(argc > 1 ? std::atoi(argv[1]) : 1'000'000);
  const int rounds = argc > 2 ? std::max(1, std::atoi(argv[2])) : 9;
  std::vector<Curve> curves = {{"tide", {}}, {"columns", {}}};
  for (int i = 3; i < argc; ++i) curves.push_back({argv[i], {}});
  fmt::print("median us of a frame   ");
  for (const Curve& curve : curves) fmt::print("  {:>12}", curve.id);
  fmt::print("\n");

  std::vector<std::uint32_t> movers = {0, 1, 10, 100};
  for (const double share : {0.001, 0.005, 0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.24, 0.3, 0.5, 1.0}) {
    movers.push_back(static_cast<std::uint32_t>(share * bodies));
  }
  for (const std::uint32_t count : movers) measure(bodies, count, rounds, curves);
  return EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
  return broadmark::benchmarks::runMain("tide_ratios", run, argc, argv);
}
