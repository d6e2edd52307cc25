// Measures what brute force and sweep and prune gain from vectors and threads, and prints each
// ratio beside its target. The contestants take turns frame by frame, so that whatever else slows
// the machine slows all of them. Exit status 1 if a target is missed.
//
//   algorithm_ratios [ROUNDS]

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "broadmark/algorithms.h"
#include "broadmark/runner.h"
#include "broadmark/statistics.h"
#include "tests/support/inputs.h"

namespace {

using namespace broadmark;

/// An algorithm at work on one scene, with the times of its frames so far.
struct Contestant {
  std::string name;
  std::unique_ptr<Execution> execution;
  std::unique_ptr<BroadPhase> algorithm;
  std::vector<double> milliseconds;
};

std::string nameOf(const std::string& id, Isa isa, int threads) {
  return fmt::format("{}/{}/t{}", id, isaName(isa), threads);
}

/// Contestants on the same boxes: unit cubes, centres uniform in a cube of volume 10 n.
class Contest {
 public:
  explicit Contest(std::size_t objects) {
    for (std::uint32_t frame = 0; frame < 3; ++frame) {
      frames_.push_back(inputs::uniform(objects, frame, 1));
    }
    scene_ = {
        .name = "Uniform", .object_type = "Cubes", .objects = static_cast<std::uint32_t>(objects)};
    scene_.world = frames_[0][0];
    for (const Aabb& box : frames_[0]) scene_.world = merged(scene_.world, box);
  }

  void add(const std::string& id, Isa isa, int threads) {
    const std::vector<Algorithm> all = builtinAlgorithms();
    const auto algorithm = std::ranges::find(all, id, &Algorithm::id);
    contestants_.push_back({nameOf(id, isa, threads),
                            std::make_unique<Execution>(threads, isa),
                            algorithm->create(),
                            {}});
    Contestant& added = contestants_.back();
    added.algorithm->initialize(scene_, {0, frames_[0]}, *added.execution);
  }

  void run(int rounds) {
    for (int round = -1; round < rounds; ++round) {  // the first one warms up
      const auto index = static_cast<std::uint32_t>(round + 2);
      for (Contestant& contestant : contestants_) {
        const FrameTimes times =
            runFrame(*contestant.algorithm, {index, frames_[index % frames_.size()]});
        if (round < 0) continue;
        contestant.milliseconds.push_back(static_cast<double>(times[Phase::total]) * 1e-6);
      }
    }
  }

  /// How many times faster `fast` is than `slow`: the median of the rounds' ratios.
  bool compare(const std::string& slow, const std::string& fast, double target) const {
    const std::vector<double>& a = find(slow).milliseconds;
    const std::vector<double>& b = find(fast).milliseconds;
    std::vector<double> ratios;
    for (std::size_t i = 0; i < a.size(); ++i) ratios.push_back(a[i] / b[i]);
    const double ratio = quantile(ratios, 0.5);
    fmt::print("{:>7}  {:22} {:9.2f} ms  {:22} {:9.2f} ms  {:6.2f}x  target {:.2f}x  {}\n",
               scene_.objects, slow, quantile(a, 0.5), fast, quantile(b, 0.5), ratio, target,
               ratio >= target ? "ok" : "MISSED");
    return ratio >= target;
  }

 private:
  const Contestant& find(const std::string& name) const {
    return *std::ranges::find(contestants_, name, &Contestant::name);
  }

  SceneInfo scene_;
  std::vector<std::vector<Aabb>> frames_;
  std::vector<Contestant> contestants_;
};

struct Targets {
  double vectors;  ///< the vectorised variant over the plain one
  double threads;  ///< two threads over one
};

/// All variants of a family ("bf", "sap").
bool contest(const std::string& family, std::size_t objects, int rounds, const Targets& targets) {
  Contest contest(objects);
  const std::string simd = family + "-simd";
  const bool two_threads = std::thread::hardware_concurrency() >= 2;

  contest.add(family, Isa::scalar, 1);
  for (const Isa isa : kAllIsas) {
    if (isaSupported(isa)) contest.add(simd, isa, 1);
  }
  if (two_threads) {
    contest.add(family + "-mt", Isa::scalar, 2);
    contest.add(simd + "-mt", bestIsa(), 2);
  }
  contest.run(rounds);

  bool met =
      contest.compare(nameOf(family, Isa::scalar, 1), nameOf(simd, bestIsa(), 1), targets.vectors);
  // Each wider set is worth having; for AVX-512, whose clock may be lower, a draw is enough.
  for (const auto& [narrow, wide, target] :
       {std::tuple{Isa::scalar, Isa::sse2, 1.0}, std::tuple{Isa::sse2, Isa::avx2, 1.05},
        std::tuple{Isa::avx2, Isa::avx512, 1.0}}) {
    if (!isaSupported(wide)) continue;
    met &= contest.compare(nameOf(simd, narrow, 1), nameOf(simd, wide, 1), target);
  }
  if (two_threads) {
    met &= contest.compare(nameOf(family, Isa::scalar, 1), nameOf(family + "-mt", Isa::scalar, 2),
                           targets.threads);
    met &= contest.compare(nameOf(simd, bestIsa(), 1), nameOf(simd + "-mt", bestIsa(), 2),
                           targets.threads);
  }
  return met;
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 9;
  bool met = contest("bf", 32'768, rounds, {.vectors = 5, .threads = 1.7});
  met &= contest("sap", 131'072, rounds, {.vectors = 3, .threads = 1.5});
  return met ? EXIT_SUCCESS : EXIT_FAILURE;
}
