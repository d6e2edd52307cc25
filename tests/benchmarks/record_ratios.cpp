// Columns against the best of our other algorithms on one thread, each kind of boxes at several
// sizes, elsewhere in every frame. The contestants take turns frame by frame, so that anything else
// that slows the machine slows all of them. Prints each ratio beside its target; exit status 1 if a
// target is missed.
//
//   record_ratios [KIND [ROUNDS [BODIES]]]
//
// KIND: one of those listed below, or all. BODIES: only so many instead of several sizes.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "benchmarks/contest.h"
#include "torture/inputs.h"

namespace {

using namespace broadmark;
using namespace broadmark::inputs;
using broadmark::benchmarks::caseOf;
using broadmark::benchmarks::Contest;

float sideFor(std::size_t n) { return cubeRoot(10.0 * static_cast<double>(n)); }

/// Edges 0.1 to 1.9, every 200th box with one of 5 to 15.
std::vector<Aabb> sizes(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  return generate(n, frame, seed, [side = sideFor(n)](Random& random, std::size_t i) {
    Vec3 edges;
    for (float& edge : edges) edge = random.uniform(0.1F, 1.9F);
    if (i % 200 == 7) edges[i / 200 % 3] = random.uniform(5, 15);
    return boxAt(random.inCube(side), edges);
  });
}

/// Ten boxes of half the world's side among unit cubes, and one over all.
std::vector<Aabb> giants(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  return generate(n, frame, seed, [side = sideFor(n), n](Random& random, std::size_t i) {
    if (i == 0) return boxAt({-1, -1, -1}, {side + 3, side + 3, side + 3});
    const float edge = i % (n / 10 + 1) == 5 ? side / 2 : 1;
    return boxAt(random.inCube(side - edge), {edge, edge, edge});
  });
}

/// Edges by a power law, up to the world's side.
std::vector<Aabb> powerLaw(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  return generate(n, frame, seed, [side = sideFor(n)](Random& random, std::size_t) {
    const float edge = std::min(side, 0.3F / std::sqrt(random.uniform(1e-6F, 1)));
    return boxAt(random.inCube(side), {edge, edge, edge});
  });
}

/// A hundred dense clusters in an empty world.
std::vector<Aabb> clusters(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  const float spread = cubeRoot(static_cast<double>(n) / 200);
  return generate(n, frame, seed, [=, side = 6 * sideFor(n)](Random& random, std::size_t i) {
    Random of_cluster(i % 100, frame);
    const Vec3 centre = of_cluster.inCube(side);
    Vec3 corner = random.inCube(spread);
    for (std::size_t axis = 0; axis < 3; ++axis) corner[axis] += centre[axis];
    return boxAt(corner, {1, 1, 1});
  });
}

std::vector<Aabb> line(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  return generate(n, frame, seed, [n](Random& random, std::size_t) {
    return boxAt({random.uniform(0, 2 * static_cast<float>(n)), 0, 0}, {1, 1, 1});
  });
}

/// All boxes overlap.
std::vector<Aabb> spot(std::size_t n, std::uint32_t frame, std::uint64_t seed) {
  return generate(n, frame, seed, [](Random& random, std::size_t) {
    return boxAt(random.inCube(0.5F), {1, 1, 1});
  });
}

struct Kind {
  std::string_view name;
  Generator boxes;
  std::vector<std::size_t> counts;
  double target = 1 / 1.2;  ///< how many times faster than the best other one
};

std::vector<Kind> kinds() {
  const std::vector<std::size_t> all = {8'000, 64'000, 1'000'000};
  const std::vector<std::size_t> some = {64'000, 1'000'000};
  return {{"uniform", uniform, all, 5},  {"clustered", clustered, all},
          {"clusters", clusters, some},  {"assorted", sizes, some},
          {"power law", powerLaw, some}, {"giants", giants, {8'000, 64'000}},
          {"plane", onePlane, some},     {"line", line, some},
          {"spot", spot, {1'000, 4'000}}};
}

constexpr std::array kOthers = {"grid2d-sap", "grid-sap", "sap-simd", "kd"};

bool measure(const Kind& kind, std::size_t count, int rounds) {
  const std::vector<std::vector<Aabb>> frames = {kind.boxes(count, 0, 1), kind.boxes(count, 1, 1)};
  Contest contest(std::string(kind.name), frames);
  const auto add = [&](const std::string& id, int threads) {
    contest.add(id, caseOf(id, AnswerKind::pairs, threads));
  };
  const bool two_threads = std::thread::hardware_concurrency() >= 2;
  add("columns", 1);
  if (two_threads) add("columns-mt", 2);
  for (const char* const other : kOthers) add(other, 1);
  contest.run(rounds);

  const auto best = std::ranges::min_element(
      kOthers, {}, [&](const char* id) { return contest.ratio(id, "columns"); });
  const double ratio = contest.ratio(*best, "columns");
  bool met = ratio >= kind.target;
  fmt::print("{:10} {:>8}  columns {:8.3f} ms {:6.1f} ns a body  {:10} {:8.3f} ms {:6.2f}x {}",
             kind.name, count, contest.find("columns").median(),
             contest.find("columns").median() * 1e6 / static_cast<double>(count), *best,
             contest.find(*best).median(), ratio,
             met ? "ok" : fmt::format("MISSED {:.2f}", kind.target));
  if (two_threads) {
    const double gain = contest.ratio("columns", "columns-mt");
    const bool wanted = kind.name == "uniform" && count >= 1'000'000;
    fmt::print("  two threads {:5.2f}x{}", gain, !wanted || gain >= 1.85 ? "" : " MISSED 1.85");
    met &= !wanted || gain >= 1.85;
  }
  fmt::print("\n");
  return met;
}

int run(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const std::string_view wanted = argc > 1 ? argv[1] : "all";
  const int rounds = argc > 2 ? std::max(1, std::atoi(argv[2])) : 9;
  bool met = true;
  bool known = false;
  for (const Kind& kind : kinds()) {
    if (wanted != "all" && wanted != kind.name) continue;
    known = true;
    std::vector<std::size_t> counts = kind.counts;
    if (argc > 3) counts = {static_cast<std::size_t>(std::max(1, std::atoi(argv[3])))};
    for (const std::size_t count : counts) met &= measure(kind, count, rounds);
  }
  if (!known) {
    fmt::print(stderr, "record_ratios: no kind '{}': all or one of", wanted);
    for (const Kind& kind : kinds()) fmt::print(stderr, " '{}'", kind.name);
    fmt::print(stderr, "\n");
    return 2;
  }
  return met ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) {
  return broadmark::benchmarks::runMain("record_ratios", run, argc, argv);
}
