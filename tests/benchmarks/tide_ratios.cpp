// Frame time as a function of the number of moving bodies: a curve of `tide` beside others. In each
// frame a new selection of bodies moves by up to half a unit on each axis: half the edge of a unit
// cube. The contestants alternate frame by frame.
//
//   tide_ratios [BODIES [ROUNDS [KIND [ANSWER [ALGORITHM...]]]]]
//
// KIND: a kind in kinds_of_boxes.h; default: uniform. ANSWER: events (default) or pairs.

#include <fmt/format.h>

#include <cstdlib>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "benchmarks/changing_worlds.h"
#include "benchmarks/kinds_of_boxes.h"
#include "broadmark/names.h"

namespace {

using namespace broadmark;
using namespace broadmark::benchmarks;

/// Measures a point of each curve.
void measure(std::span<const Aabb> boxes, std::uint32_t movers, int rounds,
             std::span<const Case> cases) {
  SomeMove world(boxes, movers);
  WorldContest contest;
  for (const Case& entered : cases) contest.add(entered.algorithm.id, entered, world);
  contest.run(3, rounds);
  fmt::print("{:>9} of {:>9}", movers, boxes.size());
  for (const WorldContest::Entrant& entrant : contest.entrants()) {
    fmt::print("  {:>12.1f}", quantile(entrant.us, 0.5));
  }
  fmt::print("\n");
}

AnswerKind answerOf(std::string_view name) {
  if (const auto answer = kAnswerKinds.find(name)) return *answer;
  throw std::invalid_argument(unknownName("answer", name, kAnswerKinds.names()));
}

int run(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const auto bodies = static_cast<std::uint32_t>(argc > 1 ? std::atoi(argv[1]) : 1'000'000);
  const int rounds = argc > 2 ? std::max(1, std::atoi(argv[2])) : 9;
  const std::vector<Aabb> boxes = kindOf(argc > 3 ? argv[3] : "uniform").boxes(bodies, 0, 1);
  const AnswerKind answer = answerOf(argc > 4 ? argv[4] : "events");
  std::vector<Case> cases = {caseOf("tide", answer), caseOf("columns", answer)};
  for (int i = 5; i < argc; ++i) cases.push_back(caseOf(argv[i], answer));
  fmt::print("median us of a frame   ");
  for (const Case& entered : cases) fmt::print("  {:>12}", entered.algorithm.id);
  fmt::print("\n");

  std::vector<std::uint32_t> movers = {0, 1, 10, 100};
  for (const double share : {0.001, 0.005, 0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.24, 0.3, 0.5, 1.0}) {
    movers.push_back(static_cast<std::uint32_t>(share * bodies));
  }
  for (const std::uint32_t count : movers) measure(boxes, count, rounds, cases);
  return EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
  return broadmark::benchmarks::runMain("tide_ratios", run, argc, argv);
}
