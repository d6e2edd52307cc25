// Running any listed algorithm over given boxes, in every way it can be run.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "broadmark/algorithms.h"
#include "broadmark/error.h"
#include "broadmark/oracle.h"
#include "support/inputs.h"

namespace broadmark {

/// How GoogleTest shows an algorithm.
inline void PrintTo(const Algorithm& algorithm, std::ostream* out) { *out << algorithm.id; }

}  // namespace broadmark

namespace broadmark::tests {

/// One way to run an algorithm.
struct Configuration {
  Isa isa = Isa::scalar;
  int threads = 1;
};

/// All instruction sets of this processor if the algorithm heeds them, and several team sizes if it
/// is parallel: among them ones that divide hardly any number of bodies. A compute device divides
/// the work by itself.
inline std::vector<Configuration> configurations(const Algorithm& algorithm) {
  std::vector<int> teams = {1};
  if (algorithm.parallel) teams = {1, 2, 3, 5};
  if (algorithm.on_device) teams = {2};
  std::vector<Configuration> all;
  for (const Isa isa : kAllIsas) {
    if (!isaSupported(isa) || (isa != Isa::scalar && !algorithm.vectorised)) continue;
    for (const int threads : teams) all.push_back({isa, threads});
  }
  return all;
}

inline std::string describe(const Algorithm& algorithm, const Configuration& configuration) {
  return algorithm.id + "/" + std::string(isaName(configuration.isa)) + "/t" +
         std::to_string(configuration.threads);
}

/// The listed algorithms that report pairs.
inline std::vector<Algorithm> pairFinders() {
  std::vector<Algorithm> all = builtinAlgorithms();
  std::erase_if(all, [](const Algorithm& algorithm) { return !algorithm.finds_pairs; });
  return all;
}

/// The listed algorithm of that id, which must be there.
inline Algorithm algorithmOf(const std::string& id) {
  const std::vector<Algorithm> all = builtinAlgorithms();
  return *std::ranges::find(all, id, &Algorithm::id);
}

/// "sap-simd" as a name that GoogleTest accepts.
inline std::string testName(const Algorithm& algorithm) {
  std::string name = algorithm.id;
  std::ranges::replace_if(
      name, [](char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

/// Frames 0…count-1 of an input.
inline std::vector<std::vector<Aabb>> framesOf(const inputs::Input& input, std::size_t n,
                                               std::uint32_t count) {
  std::vector<std::vector<Aabb>> frames;
  for (std::uint32_t frame = 0; frame < count; ++frame) {
    frames.push_back(input.boxes(n, frame, 1 + n));
  }
  return frames;
}

/// What the header of a recording of these frames would say.
inline SceneInfo sceneOf(const std::vector<std::vector<Aabb>>& frames) {
  SceneInfo scene;
  scene.name = "Test";
  scene.object_type = "Boxes";
  scene.objects = static_cast<std::uint32_t>(frames.front().size());
  scene.frames = static_cast<std::uint32_t>(frames.size() - 1);
  scene.world = {{-1, -1, -1, 0}, {1, 1, 1, 0}};
  for (const std::vector<Aabb>& boxes : frames) {
    for (const Aabb& box : boxes) scene.world = merged(scene.world, box);
  }
  return scene;
}

/// The answer as one ascending list.
inline std::vector<Pair> sorted(PairRuns runs) {
  std::vector<Pair> pairs;
  for (const PairRun run : runs) pairs.insert(pairs.end(), run.begin(), run.end());
  std::ranges::sort(pairs);
  return pairs;
}

/// The work counters of the last frame.
inline std::map<std::string, std::uint64_t, std::less<>> countersOf(const BroadPhase& algorithm) {
  std::map<std::string, std::uint64_t, std::less<>> counters;
  algorithm.visitCounters(
      [&](std::string_view name, std::uint64_t count) { counters.emplace(name, count); });
  return counters;
}

/// An instance at work.
class Instance {
 public:
  /// Throws UnsupportedError.
  Instance(const Algorithm& algorithm, Execution& execution, const SceneInfo& scene,
           const std::vector<Aabb>& first, const ParameterValues& parameters = {})
      : broad_phase_(algorithm.create()) {
    setParameters(*broad_phase_, parameters);
    broad_phase_->initialize(scene, {0, first}, execution);
  }

  /// Runs the four phases on the next frame.
  PairRuns step(const std::vector<Aabb>& boxes) {
    broad_phase_->updateObjects({++index_, boxes});
    search();
    return broad_phase_->overlaps();
  }

  /// The phases after updateObjects.
  void search() {
    broad_phase_->cleanCache();
    broad_phase_->updateStructures();
    broad_phase_->searchOverlaps();
  }

  BroadPhase& broadPhase() { return *broad_phase_; }

 private:
  std::unique_ptr<BroadPhase> broad_phase_;
  std::uint32_t index_ = 0;
};

/// Whether an answer has all the right pairs, and none that the margin does not excuse.
inline testing::AssertionResult isRight(PairRuns answer, const std::vector<Pair>& right,
                                        const Frame& frame, float margin) {
  // The digest suffices to tell that an exact answer is right, and is much quicker.
  const PairRun right_run = right;
  if (margin == 0 && digest(answer) == digest({&right_run, 1})) return testing::AssertionSuccess();
  const FrameDifference difference = findDifference(answer, right, frame, margin);
  if (!difference.isMismatch()) return testing::AssertionSuccess();
  auto failure = testing::AssertionFailure()
                 << "of " << right.size() << " pairs missed " << difference.missed_count
                 << ", extra " << difference.extra_count << ", invalid "
                 << difference.invalid_count;
  if (!difference.missed.empty()) {
    failure << "; first missed " << difference.missed[0].a << "-" << difference.missed[0].b;
  }
  return failure;
}

}  // namespace broadmark::tests
