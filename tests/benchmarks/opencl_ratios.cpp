// Measures the project's OpenCL algorithms against Bullet's of the same kind, on the same device,
// and prints the speed-ups beside the targets, which are for PoCL. The algorithms alternate frame
// by frame, on unit cubes uniform in a cube of volume 10 n, at new positions in every frame. Exit
// status 1 if a target is missed or pairs are wrong.
//
//   opencl_ratios [KIND...] [--objects N,...] [--rounds R] [--threads T] [--device NAME]

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "benchmarks/contest.h"
#include "broadmark/error.h"
#include "torture/inputs.h"

namespace {

using namespace broadmark;
using broadmark::benchmarks::Contest;

/// Minimum speed-up over Bullet's algorithm, for kTargetObjects bodies.
struct Target {
  std::string_view kind;
  double min = 0;
};
constexpr Target kTargets[] = {{"grid", 8}, {"lbvh", 1.3}, {"sap", 15}};
constexpr std::size_t kTargetObjects = 512'000;

struct Options {
  std::vector<std::string> kinds;  ///< empty: all
  std::vector<std::size_t> objects = {kTargetObjects};
  int rounds = 7;
  int threads = 2;
  std::string device;
};

/// Adds the algorithm; if it cannot run here, prints the reason and returns false.
bool enter(Contest& contest, const std::string& id, const Options& options) {
  const std::optional<Algorithm> algorithm = benchmarks::findAlgorithm(id);
  if (!algorithm) throw InputError("built without OpenCL");
  try {
    contest.add(id, makeCase(*algorithm, bestIsa(), options.threads, options.device, {}));
    return true;
  } catch (const UnsupportedError& error) {
    fmt::print("  {} skipped: {}\n", id, error.what());
    return false;
  }
}

std::string line(const Contest& contest, const std::string& id) {
  return fmt::format("{:8} {:8.2f} ms", id, contest.find(id).median());
}

/// Prints a line of results; false if the target is missed or pairs are wrong.
bool measure(const Target& target, std::span<const std::vector<Aabb>> frames,
             const Options& options) {
  const std::string own = fmt::format("gpu-{}", target.kind);
  const std::string bullets = fmt::format("b3-{}", target.kind);
  Contest contest("Uniform", frames);
  const bool has_own = enter(contest, own, options);
  const bool has_bullets = enter(contest, bullets, options);
  contest.run(options.rounds);
  fmt::print("{:>8}", contest.scene().objects);
  if (has_own) fmt::print("  {}", line(contest, own));
  if (has_bullets) fmt::print("  {}", line(contest, bullets));
  if (!has_own || !has_bullets) {
    fmt::print("\n");
    return true;
  }
  const bool same = digest(contest.find(own).answer()) == digest(contest.find(bullets).answer());
  const double ratio = contest.ratio(bullets, own);
  fmt::print("  {:6.2f}x{}", ratio, same ? "" : "  WRONG PAIRS");
  const bool counts = contest.scene().objects == kTargetObjects;
  const bool met = ratio >= target.min;
  if (counts) fmt::print("  target {:.1f}x  {}", target.min, met ? "ok" : "MISSED");
  fmt::print("\n");
  std::fflush(stdout);
  return same && (met || !counts);
}

int run(int argc, char** argv) {
  Options options;
  std::vector<std::string> kinds;
  for (const Target& target : kTargets) kinds.emplace_back(target.kind);
  CLI::App app("How many times faster our algorithms on a device are than Bullet's");
  app.add_option("kinds", options.kinds, "default: all")->check(CLI::IsMember(kinds));
  app.add_option("--objects", options.objects)
      ->delimiter(',')
      ->check(CLI::Range(2, 10'000'000))
      ->capture_default_str();
  app.add_option("--rounds", options.rounds)
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  app.add_option("--threads", options.threads)->check(CLI::Range(1, 4096))->capture_default_str();
  app.add_option("--device", options.device, "its number or a part of its name");
  CLI11_PARSE(app, argc, argv);

  bool met = true;
  for (const std::size_t objects : options.objects) {
    std::vector<std::vector<Aabb>> frames;
    for (std::uint32_t frame = 0; frame < 3; ++frame) {
      frames.push_back(inputs::uniform(objects, frame, 1));
    }
    for (const Target& target : kTargets) {
      const bool wanted =
          options.kinds.empty() || std::ranges::count(options.kinds, target.kind) > 0;
      if (wanted) met &= measure(target, frames, options);
    }
  }
  return met ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) { return benchmarks::runMain("opencl_ratios", run, argc, argv); }
