// Measures the SIMD speed-up of brute force and sweep and prune, and prints each ratio beside its
// target. The contestants alternate frame by frame, so that background load affects all of them.
// Exit status 1 if a target is missed.
//
//   algorithm_ratios [ROUNDS]

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "benchmarks/contest.h"
#include "torture/inputs.h"

namespace {

using namespace broadmark;
using broadmark::benchmarks::Contest;
using broadmark::benchmarks::findAlgorithm;

std::string nameOf(const std::string& id, Isa isa) {
  return fmt::format("{}/{}", id, isaName(isa));
}

void add(Contest& contest, const std::string& id, Isa isa) {
  contest.add(nameOf(id, isa), makeCase(findAlgorithm(id).value(), isa, 1, "", {}));
}

/// Prints the speed-up of `fast` over `slow`; false if it misses the target.
bool compare(const Contest& contest, const std::string& slow, const std::string& fast,
             double target) {
  const double ratio = contest.ratio(slow, fast);
  fmt::print("{:>7}  {:22} {:9.2f} ms  {:22} {:9.2f} ms  {:6.2f}x  target {:.2f}x  {}\n",
             contest.scene().objects, slow, contest.find(slow).median(), fast,
             contest.find(fast).median(), ratio, target, ratio >= target ? "ok" : "MISSED");
  return ratio >= target;
}

/// The variants of a family ("bf", "sap") on one thread, on unit cubes with centres uniform in a
/// cube of volume 10 n, at new positions in every frame. The target is the speed-up of the SIMD
/// variant over the scalar one.
bool measure(const std::string& family, std::size_t objects, int rounds, double target) {
  std::vector<std::vector<Aabb>> frames;
  for (std::uint32_t frame = 0; frame < 3; ++frame) {
    frames.push_back(inputs::uniform(objects, frame, 1));
  }
  Contest contest("Uniform", frames);
  const std::string simd = family + "-simd";

  add(contest, family, Isa::scalar);
  for (const auto& [isa, name] : kIsas.entries) {
    if (isaSupported(isa)) add(contest, simd, isa);
  }
  contest.run(rounds);

  bool met = compare(contest, nameOf(family, Isa::scalar), nameOf(simd, bestIsa()), target);
  // Each wider instruction set must be faster; AVX-512, with a lower clock, only as fast.
  for (const auto& [narrow, wide, gain] :
       {std::tuple{Isa::scalar, Isa::sse2, 1.0}, std::tuple{Isa::sse2, Isa::avx2, 1.05},
        std::tuple{Isa::avx2, Isa::avx512, 1.0}}) {
    if (!isaSupported(wide)) continue;
    met &= compare(contest, nameOf(simd, narrow), nameOf(simd, wide), gain);
  }
  return met;
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 9;
  bool met = measure("bf", 32'768, rounds, 5);
  met &= measure("sap", 131'072, rounds, 3);
  return met ? EXIT_SUCCESS : EXIT_FAILURE;
}
