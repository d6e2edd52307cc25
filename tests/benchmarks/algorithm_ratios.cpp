// Measures what brute force and sweep and prune gain from vectors and threads, and prints each
// ratio beside its target. The contestants take turns frame by frame, so that anything else that
// slows the machine slows all of them. Exit status 1 if a target is missed.
//
//   algorithm_ratios [ROUNDS]

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "benchmarks/contest.h"
#include "torture/inputs.h"

namespace {

using namespace broadmark;
using broadmark::benchmarks::Contest;
using broadmark::benchmarks::findAlgorithm;

std::string nameOf(const std::string& id, Isa isa, int threads) {
  return fmt::format("{}/{}/t{}", id, isaName(isa), threads);
}

void add(Contest& contest, const std::string& id, Isa isa, int threads) {
  contest.add(nameOf(id, isa, threads), makeCase(findAlgorithm(id).value(), isa, threads, "", {}));
}

/// How many times faster `fast` is than `slow`.
bool compare(const Contest& contest, const std::string& slow, const std::string& fast,
             double target) {
  const double ratio = contest.ratio(slow, fast);
  fmt::print("{:>7}  {:22} {:9.2f} ms  {:22} {:9.2f} ms  {:6.2f}x  target {:.2f}x  {}\n",
             contest.scene().objects, slow, contest.find(slow).median(), fast,
             contest.find(fast).median(), ratio, target, ratio >= target ? "ok" : "MISSED");
  return ratio >= target;
}

struct Targets {
  double vectors;  ///< the vectorised variant over the plain one
  double threads;  ///< two threads over one
};

/// All variants of a family ("bf", "sap"), on unit cubes with centres uniform in a cube of volume
/// 10 n, elsewhere in every frame.
bool measure(const std::string& family, std::size_t objects, int rounds, const Targets& targets) {
  std::vector<std::vector<Aabb>> frames;
  for (std::uint32_t frame = 0; frame < 3; ++frame) {
    frames.push_back(inputs::uniform(objects, frame, 1));
  }
  Contest contest("Uniform", frames);
  const std::string simd = family + "-simd";
  const bool two_threads = std::thread::hardware_concurrency() >= 2;

  add(contest, family, Isa::scalar, 1);
  for (const auto& [isa, name] : kIsas.entries) {
    if (isaSupported(isa)) add(contest, simd, isa, 1);
  }
  if (two_threads) {
    add(contest, family + "-mt", Isa::scalar, 2);
    add(contest, simd + "-mt", bestIsa(), 2);
  }
  contest.run(rounds);

  bool met =
      compare(contest, nameOf(family, Isa::scalar, 1), nameOf(simd, bestIsa(), 1), targets.vectors);
  // Each wider set is worth having; for AVX-512, whose clock may be lower, a draw is enough.
  for (const auto& [narrow, wide, target] :
       {std::tuple{Isa::scalar, Isa::sse2, 1.0}, std::tuple{Isa::sse2, Isa::avx2, 1.05},
        std::tuple{Isa::avx2, Isa::avx512, 1.0}}) {
    if (!isaSupported(wide)) continue;
    met &= compare(contest, nameOf(simd, narrow, 1), nameOf(simd, wide, 1), target);
  }
  if (two_threads) {
    met &= compare(contest, nameOf(family, Isa::scalar, 1), nameOf(family + "-mt", Isa::scalar, 2),
                   targets.threads);
    met &= compare(contest, nameOf(simd, bestIsa(), 1), nameOf(simd + "-mt", bestIsa(), 2),
                   targets.threads);
  }
  return met;
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 9;
  bool met = measure("bf", 32'768, rounds, {.vectors = 5, .threads = 1.7});
  met &= measure("sap", 131'072, rounds, {.vectors = 3, .threads = 1.5});
  return met ? EXIT_SUCCESS : EXIT_FAILURE;
}
