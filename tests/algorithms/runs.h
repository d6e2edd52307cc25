// Runs listed algorithms on given boxes, in all configurations.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <map>
#include <memory>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "broadmark/algorithms.h"
#include "broadmark/change_detector.h"
#include "broadmark/error.h"
#include "broadmark/harness/case_executor.h"
#include "broadmark/harness/event_accumulator.h"
#include "broadmark/harness/oracle.h"
#include "broadmark/recorded_drawing.h"
#include "torture/given_frames.h"
#include "torture/inputs.h"

namespace broadmark {

/// Prints an algorithm in GoogleTest.
inline void PrintTo(const Algorithm& algorithm, std::ostream* out) { *out << algorithm.id; }

}  // namespace broadmark

namespace broadmark::tests {

using inputs::sceneOf;

struct Configuration {
  Isa isa = Isa::scalar;
  int threads = 1;
  AnswerKind answer = AnswerKind::pairs;
  ParameterValues parameters = {};
};

/// All instruction sets of this processor if the algorithm is vectorised, and these teams if it is
/// parallel. A compute device divides the work by itself.
inline std::vector<Configuration> configurations(const Algorithm& algorithm,
                                                 std::vector<int> teams = {1, 2, 5}) {
  const AlgorithmTraits& traits = algorithm.traits;
  if (!traits.parallel) teams = {1};
  if (traits.on_device) teams = {2};
  std::vector<Configuration> all;
  for (const Isa isa : supportedIsas()) {
    if (isa != Isa::scalar && !traits.vectorised) continue;
    for (const int threads : teams) all.push_back({isa, threads});
  }
  return all;
}

/// The configurations for events, with the widest instruction set. Other teams than for pairs: more
/// threads than cores are slow, and few numbers of bodies are divisible by five or three.
inline std::vector<Configuration> eventConfigurations(const Algorithm& algorithm) {
  std::vector<Configuration> selected = configurations(algorithm, {1, 3});
  const Isa widest = std::ranges::max_element(selected, {}, &Configuration::isa)->isa;
  std::erase_if(selected, [&](const Configuration& c) { return c.isa != widest; });
  for (Configuration& config : selected) config.answer = AnswerKind::events;
  return selected;
}

/// All configurations for pairs and events, also with the algorithm's rare parameters.
inline std::vector<Configuration> allConfigurations(const Algorithm& algorithm) {
  std::vector<Configuration> all = configurations(algorithm);
  const std::vector<Configuration> for_events = eventConfigurations(algorithm);
  all.insert(all.end(), for_events.begin(), for_events.end());
  const std::vector<Configuration> usual = all;
  for (const ParameterValues& rare : algorithm.traits.rare_parameters) {
    for (Configuration configuration : usual) {
      configuration.parameters = rare;
      all.push_back(configuration);
    }
  }
  return all;
}

inline Case caseOf(const Algorithm& algorithm, const Configuration& config,
                   ParameterValues parameters = {}) {
  parameters.insert(config.parameters.begin(), config.parameters.end());
  return makeCase(algorithm, config.isa, config.threads, "", parameters, config.answer);
}

inline std::string describe(const Algorithm& algorithm, const Configuration& config) {
  return caseName(caseOf(algorithm, config));
}

/// The listed algorithms that report pairs.
inline std::vector<Algorithm> pairFinders() {
  std::vector<Algorithm> all = builtinAlgorithms();
  std::erase_if(all, [](const Algorithm& algorithm) { return !algorithm.traits.finds_pairs; });
  return all;
}

/// The listed algorithm with this id; it must exist.
inline Algorithm algorithmOf(const std::string& id) {
  const std::vector<Algorithm> all = builtinAlgorithms();
  return *std::ranges::find(all, id, &Algorithm::id);
}

/// The id as a name that GoogleTest accepts, such as "sap_simd".
inline std::string testName(const Algorithm& algorithm) {
  std::string name = algorithm.id;
  std::ranges::replace_if(name, [](char c) { return std::isalnum(c) == 0; }, '_');
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

/// The answer as an ascending list.
inline std::vector<Pair> sorted(PairRuns runs) {
  std::vector<Pair> pairs;
  for (const PairRun pair_run : runs) pairs.insert(pairs.end(), pair_run.begin(), pair_run.end());
  std::ranges::sort(pairs);
  return pairs;
}

/// The right pairs, ascending; by brute force if that is quick enough.
inline std::vector<Pair> rightPairs(const std::vector<Aabb>& boxes) {
  return boxes.size() <= 1000 ? bruteForcePairs(boxes) : sweptPairs(boxes);
}

using Counters = std::map<std::string, std::uint64_t, std::less<>>;

/// The work counters of the last frame.
inline Counters countersOf(const BroadPhase& algorithm) {
  Counters counters;
  algorithm.visitCounters(
      [&](std::string_view name, std::uint64_t count) { counters.emplace(name, count); });
  return counters;
}

/// The drawing of the algorithm's structure, with tests of up to `bodies` bodies.
inline RecordedDrawing drawingOf(const BroadPhase& algorithm, std::size_t bodies = 0) {
  RecordedDrawing drawing(bodies);
  algorithm.drawStructure(drawing);
  return drawing;
}

/// Sum of the reported populations of all cells.
inline std::uint64_t populationOf(const RecordedDrawing& drawing) {
  std::uint64_t sum = 0;
  for (const RecordedDrawing::Box& box : drawing.boxes()) sum += box.population;
  return sum;
}

/// Runs an algorithm on boxes in memory, without limits or checks. Propagates its exceptions.
class TestRun {
 public:
  explicit TestRun(const Algorithm& algorithm, const Configuration& config = {},
                   const ParameterValues& parameters = {})
      : test_case_(caseOf(algorithm, config, parameters)),
        host_(std::make_unique<InProcessExecutor>(test_case_)),
        changed_bodies_(std::make_unique<ChangeDetector>()) {}

  /// Starts a pass. Throws UnsupportedError.
  TestRun& start(const SceneInfo& scene, const std::vector<Aabb>& first) {
    index_ = 0;
    const CollisionFilter* filter = scene.filter_changes ? &scene.filter : nullptr;
    host_->start(scene, changed_bodies_->complete({0, first, {}, filter}));
    accumulator_.clear();
    if (test_case_.answer == AnswerKind::events) accumulateEvents(first.size());
    return *this;
  }
  TestRun& start(const std::vector<Aabb>& first) { return start(sceneOf({first}), first); }

  /// Runs the four phases on the next frame. Returns the pairs; of events, those accumulated so
  /// far, and then throws std::logic_error for an impossible event. `filter`: if filters change.
  PairRuns step(const std::vector<Aabb>& boxes, const CollisionFilter* filter = nullptr) {
    times_ = host_->step(changed_bodies_->complete({++index_, boxes, {}, filter})).times;
    if (test_case_.answer == AnswerKind::pairs) return broadPhase().overlaps();
    accumulateEvents(boxes.size());
    return accumulator_.pairs();
  }

  /// The instance; valid from start() to the next start().
  BroadPhase& broadPhase() { return host_->instance(); }
  /// The times of the last frame.
  [[nodiscard]] const FrameTimes& times() const { return times_; }
  [[nodiscard]] float margin() const { return makeInstance(test_case_)->margin(); }

 private:
  void accumulateEvents(std::size_t bodies) {
    accumulator_.apply(host_->events(), bodies);
    for (const Pair pair : accumulator_.impossible()) {
      throw std::logic_error(fmt::format("frame {}: {}-{} cannot be: {} began, {} ended", index_,
                                         pair.a, pair.b, pairCount(host_->events().began),
                                         pairCount(host_->events().ended)));
    }
  }

  Case test_case_;
  std::unique_ptr<InProcessExecutor> host_;
  std::unique_ptr<ChangeDetector> changed_bodies_;
  EventAccumulator accumulator_;
  FrameTimes times_;
  std::uint32_t index_ = 0;
};

/// Whether an answer has all right pairs, and no false pairs.
inline testing::AssertionResult isRight(PairRuns answer, const std::vector<Pair>& right,
                                        const Frame& frame, float margin = 0,
                                        const CollisionFilter& filter = {},
                                        const PeriodicBox& periodic = {}) {
  const PairRun right_run = right;
  // The digest is much quicker, and sufficient if no extra pairs are allowed.
  if (margin == 0 && digest(answer) == digest({&right_run, 1})) return testing::AssertionSuccess();
  const FrameDifference difference = findDifference(answer, right, frame, margin, filter, periodic);
  if (!difference.isMismatch()) return testing::AssertionSuccess();
  auto failure = testing::AssertionFailure()
                 << mismatchText(difference) << " of " << right.size() << " pairs";
  if (!difference.missed_pairs.empty()) {
    failure << "; first missed " << difference.missed_pairs[0].a << "-"
            << difference.missed_pairs[0].b;
  }
  return failure;
}

}  // namespace broadmark::tests
