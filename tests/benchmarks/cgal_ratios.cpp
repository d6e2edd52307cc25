// Measures algorithms against CGAL's box intersection and prints time / time(cgal) beside the
// targets. CGAL is the same library everywhere, so these ratios are comparable between machines.
// Each algorithm alternates with `cgal`, frame by frame, on smoothly moving unit cubes. Exit status
// 1 if a target is missed or an algorithm's pairs are wrong.
//
//   cgal_ratios [ALGORITHM[:KEY=VALUE]...] [--scene NAME,...] [--objects N] [--rounds R]

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "benchmarks/contest.h"
#include "broadmark/error.h"
#include "torture/inputs.h"

namespace {

using namespace broadmark;
using broadmark::benchmarks::Contest;
using broadmark::benchmarks::Contestant;
using broadmark::benchmarks::findAlgorithm;
using broadmark::inputs::Random;
using broadmark::inputs::Vec3;

constexpr std::size_t kFrames = 12;
constexpr std::uint64_t kSeed = 1;
/// Maximum velocity per axis, in units per frame: the root mean square speed is then 0.2.
constexpr float kSpeed = 0.2F;

using Frames = std::vector<std::vector<Aabb>>;

std::vector<Aabb> boxesAt(const std::vector<Vec3>& corners) {
  std::vector<Aabb> boxes;
  boxes.reserve(corners.size());
  for (const Vec3& corner : corners) boxes.push_back(inputs::boxAt(corner, {1, 1, 1}));
  return boxes;
}

Vec3 randomVector(Random& random, float max) {
  return {random.uniform(-max, max), random.uniform(-max, max), random.uniform(-max, max)};
}

/// Unit cubes in a closed cube of volume 10 n. Every `stride`-th cube moves in a straight line and
/// is reflected by the walls.
Frames bouncing(std::size_t n, std::size_t stride) {
  const float side = inputs::cubeRoot(10.0 * static_cast<double>(n));
  Random random(kSeed, 0);
  std::vector<Vec3> corners(n);
  std::vector<Vec3> velocities(n);
  for (std::size_t i = 0; i < n; ++i) {
    corners[i] = random.inCube(side - 1);
    if (i % stride == 0) velocities[i] = randomVector(random, kSpeed);
  }
  Frames frames = {boxesAt(corners)};
  while (frames.size() < kFrames) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        float& x = corners[i][axis];
        float& v = velocities[i][axis];
        if (x + v < 0 || x + v > side - 1) v = -v;
        x += v;
      }
    }
    frames.push_back(boxesAt(corners));
  }
  return frames;
}

Frames brownian(std::size_t n) { return bouncing(n, 1); }
Frames mostlyStill(std::size_t n) { return bouncing(n, 20); }

/// Unit cubes in a ball of volume n that moves as a whole, each with some random motion.
Frames clustered(std::size_t n) {
  const std::vector<Aabb> first = inputs::clustered(n, 0, kSeed);
  std::vector<Vec3> corners;
  for (const Aabb& box : first) corners.push_back({box.min[0], box.min[1], box.min[2]});
  Frames frames = {first};
  Random random(kSeed, 1);
  while (frames.size() < kFrames) {
    for (Vec3& corner : corners) {
      const Vec3 jostle = randomVector(random, kSpeed / 2);
      for (std::size_t axis = 0; axis < 3; ++axis) corner[axis] += kSpeed / 2 + jostle[axis];
    }
    frames.push_back(boxesAt(corners));
  }
  return frames;
}

/// Time limits of an algorithm as ratios to CGAL's time, for kTargetObjects bodies.
struct Target {
  std::string_view algorithm;
  double most = 0;
  double goal = 0;  ///< stricter than `most`; 0: none
};
constexpr std::size_t kTargetObjects = 131'072;

struct Scene {
  std::string_view name;
  Frames (*frames)(std::size_t n);
  std::vector<Target> targets;
};

std::vector<Scene> allScenes() {
  return {{"brownian",
           brownian,
           {{"sap", 2.3},
            {"sap-simd", 0.29},
            {"sap-simd-mt", 0.17},
            {"grid2d-sap", 0.096},
            {"grid2d-sap-mt", 0.078},
            {"grid-bf", 0.50},
            {"grid-sap", 0.157, 0.08},
            {"grid-sap-mt", 0.098},
            {"tracy", 4.0},
            {"tracy-mt", 2.3},
            {"dbvt-d", 1.08},
            {"dbvt-f", 1.7},
            {"kd", 0.178, 0.09},
            {"kd-mt", 0.111, 0.056}}},
          {"static", mostlyStill, {{"kd", 0.128, 0.064}, {"tracy", 0.46}}},
          {"clustered", clustered, {{"kd", 0.26, 0.13}, {"grid2d-sap", 0.18}}}};
}

/// An algorithm with parameters, as on the command line: "kd", "cgal:cutoff=100".
struct Candidate {
  std::string name;
  Algorithm algorithm;
  ParameterValues parameters;
};

/// Parses the names; skips unknown algorithms with a message.
std::vector<Candidate> candidates(const std::vector<std::string>& names) {
  std::vector<Candidate> found;
  for (const std::string& name : names) {
    const std::vector<std::string> parts = CLI::detail::split(name, ':');
    const std::optional<Algorithm> algorithm = findAlgorithm(parts[0]);
    if (!algorithm) {
      fmt::print("  {:22} skipped: no such algorithm here\n", name);
      continue;
    }
    Candidate candidate = {name, *algorithm, {}};
    for (std::size_t i = 1; i < parts.size(); ++i) {
      const std::size_t equals = parts[i].find('=');
      if (equals == std::string::npos) throw InputError(name + ": not of the form ID:KEY=VALUE");
      candidate.parameters[parts[i].substr(0, equals)] = parts[i].substr(equals + 1);
    }
    found.push_back(std::move(candidate));
  }
  return found;
}

/// Whether the last frame's answers agree; with a margin, the candidate may report more pairs.
bool sameAnswer(const Contestant& candidate, const Contestant& cgal) {
  if (candidate.margin > 0) return pairCount(candidate.answer()) >= pairCount(cgal.answer());
  return digest(candidate.answer()) == digest(cgal.answer());
}

std::string verdict(double ratio, const Target& target) {
  if (target.goal > 0 && ratio <= target.goal) return "goal met";
  return ratio <= target.most ? "ok" : "MISSED";
}

/// Prints a line of results; false if the target is missed or the answer wrong.
bool measure(const Candidate& candidate, const Algorithm& cgal, const Frames& frames,
             const Target* target, int rounds) {
  // Only two contestants: with more, each would have less of its memory in the caches.
  Contest contest("Benchmark", frames);
  contest.add("cgal", makeCase(cgal, Isa::scalar, 1, "", {}));
  contest.add("candidate", makeCase(candidate.algorithm, bestIsa(), 2, "", candidate.parameters));
  contest.run(rounds);

  const double ratio = contest.ratio("candidate", "cgal");
  const bool same = sameAnswer(contest.find("candidate"), contest.find("cgal"));
  std::string remark;
  if (target != nullptr) {
    remark = fmt::format("at most {:.3f}", target->most);
    if (target->goal > 0) remark += fmt::format(", goal {:.3f}", target->goal);
    remark += "  " + verdict(ratio, *target);
  }
  if (!same) remark += "  WRONG PAIRS";
  fmt::print("  {:22} {:9.2f} ms  cgal {:9.2f} ms  ratio {:7.4f}  {}\n", candidate.name,
             contest.find("candidate").median(), contest.find("cgal").median(), ratio, remark);
  std::fflush(stdout);
  return same && (target == nullptr || ratio <= target->most);
}

struct Options {
  std::vector<std::string> algorithms;  ///< empty: all with targets
  std::vector<std::string> scenes;      ///< empty: all
  std::size_t objects = kTargetObjects;
  int rounds = 7;
};

bool measure(const Scene& scene, const Options& options) {
  std::vector<std::string> names = options.algorithms;
  if (names.empty()) {
    for (const Target& target : scene.targets) names.emplace_back(target.algorithm);
  }
  fmt::print("{}, {} bodies, {} rounds\n", scene.name, options.objects, options.rounds);
  const std::vector<Candidate> found = candidates(names);
  const std::vector<Candidate> yardstick = candidates({"cgal"});
  if (yardstick.empty()) throw InputError("built without CGAL: nothing to compare with");
  const Frames frames = scene.frames(options.objects);
  bool met = true;
  for (const Candidate& candidate : found) {
    const auto target = std::ranges::find(scene.targets, candidate.name, &Target::algorithm);
    const bool counts = target != scene.targets.end() && options.objects == kTargetObjects;
    try {
      met &= measure(candidate, yardstick[0].algorithm, frames, counts ? &*target : nullptr,
                     options.rounds);
    } catch (const UnsupportedError& error) {
      fmt::print("  {:22} skipped: {}\n", candidate.name, error.what());
    }
  }
  return met;
}

int run(int argc, char** argv) {
  const std::vector<Scene> scenes = allScenes();
  std::vector<std::string> scene_names;
  for (const Scene& scene : scenes) scene_names.emplace_back(scene.name);

  Options options;
  CLI::App app("Times of algorithms in parts of CGAL's");
  app.add_option("algorithms", options.algorithms, "ID or ID:KEY=VALUE; else all with targets");
  app.add_option("--scene", options.scenes, "default: all")
      ->delimiter(',')
      ->check(CLI::IsMember(scene_names));
  app.add_option("--objects", options.objects)
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
  app.add_option("--rounds", options.rounds)
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  bool met = true;
  for (const Scene& scene : scenes) {
    const bool wanted =
        options.scenes.empty() || std::ranges::count(options.scenes, scene.name) > 0;
    if (wanted) met &= measure(scene, options);
  }
  return met ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) { return benchmarks::runMain("cgal_ratios", run, argc, argv); }
