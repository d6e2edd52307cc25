// Running any listed algorithm over given boxes, in every way it can be run.
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

/// How GoogleTest shows an algorithm.
inline void PrintTo(const Algorithm& algorithm, std::ostream* out) { *out << algorithm.id; }

}  // namespace broadmark

namespace broadmark::tests {

using inputs::sceneOf;

/// One way to run an algorithm.
struct Configuration {
  Isa isa = Isa::scalar;
  int threads = 1;
  AnswerKind answer = AnswerKind::pairs;
  ParameterValues parameters = {};
};

/// All instruction sets of this processor if the algorithm heeds them, and these teams if it is
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

/// Those for events, with the widest instruction set. Other teams than for pairs: more threads than
/// there are cores are slow, and five and three divide hardly any number of bodies.
inline std::vector<Configuration> eventConfigurations(const Algorithm& algorithm) {
  std::vector<Configuration> ways = configurations(algorithm, {1, 3});
  const Isa widest = std::ranges::max_element(ways, {}, &Configuration::isa)->isa;
  std::erase_if(ways, [&](const Configuration& way) { return way.isa != widest; });
  for (Configuration& way : ways) way.answer = AnswerKind::events;
  return ways;
}

/// All of both, and with the algorithm's rare parameters.
inline std::vector<Configuration> everyConfiguration(const Algorithm& algorithm) {
  std::vector<Configuration> all = configurations(algorithm);
  const std::vector<Configuration> of_events = eventConfigurations(algorithm);
  all.insert(all.end(), of_events.begin(), of_events.end());
  if (algorithm.traits.rare_parameters.empty()) return all;
  for (std::size_t i = all.size(); i-- > 0;) {
    all.push_back(all[i]);
    all.back().parameters = algorithm.traits.rare_parameters;
  }
  return all;
}

inline Case caseOf(const Algorithm& algorithm, const Configuration& way,
                   ParameterValues parameters = {}) {
  parameters.insert(way.parameters.begin(), way.parameters.end());
  return makeCase(algorithm, way.isa, way.threads, "", parameters, way.answer);
}

inline std::string describe(const Algorithm& algorithm, const Configuration& way) {
  return caseName(caseOf(algorithm, way));
}

/// The listed algorithms that report pairs.
inline std::vector<Algorithm> pairFinders() {
  std::vector<Algorithm> all = builtinAlgorithms();
  std::erase_if(all, [](const Algorithm& algorithm) { return !algorithm.traits.finds_pairs; });
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

/// The answer as one ascending list.
inline std::vector<Pair> sorted(PairRuns runs) {
  std::vector<Pair> pairs;
  for (const PairRun run : runs) pairs.insert(pairs.end(), run.begin(), run.end());
  std::ranges::sort(pairs);
  return pairs;
}

/// The right pairs, ascending: by definition where that is quick enough.
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

/// What the algorithm draws now, and tells of so many bodies.
inline RecordedDrawing drawingOf(const BroadPhase& algorithm, std::size_t bodies = 0) {
  RecordedDrawing drawing(bodies);
  algorithm.drawStructure(drawing);
  return drawing;
}

/// How many bodies all cells together hold, as far as they tell.
inline std::uint64_t populationOf(const RecordedDrawing& drawing) {
  std::uint64_t sum = 0;
  for (const RecordedDrawing::Box& box : drawing.boxes()) sum += box.population;
  return sum;
}

/// An algorithm on boxes in memory, without limits or checks. Throws what it throws.
class TestRun {
 public:
  explicit TestRun(const Algorithm& algorithm, const Configuration& way = {},
                   const ParameterValues& parameters = {})
      : run_(caseOf(algorithm, way, parameters)),
        host_(std::make_unique<InProcessExecutor>(run_)),
        changed_bodies_(std::make_unique<ChangeDetector>()) {}

  /// Begins a pass. Throws UnsupportedError.
  TestRun& start(const SceneInfo& scene, const std::vector<Aabb>& first) {
    index_ = 0;
    host_->start(scene, changed_bodies_->complete({0, first}));
    followed_.clear();
    if (run_.answer == AnswerKind::events) follow(first.size());
    return *this;
  }
  TestRun& start(const std::vector<Aabb>& first) { return start(sceneOf({first}), first); }

  /// Runs the four phases on the next frame. Returns the pairs, those that events have led to; then
  /// also throws std::logic_error for one that cannot be.
  PairRuns step(const std::vector<Aabb>& boxes) {
    times_ = host_->step(changed_bodies_->complete({++index_, boxes})).times;
    if (run_.answer == AnswerKind::pairs) return broadPhase().overlaps();
    follow(boxes.size());
    return followed_.pairs();
  }

  /// The instance: between start() and the next one.
  BroadPhase& broadPhase() { return host_->instance(); }
  /// Of the last frame.
  [[nodiscard]] const FrameTimes& times() const { return times_; }
  [[nodiscard]] float margin() const { return makeInstance(run_)->margin(); }

 private:
  void follow(std::size_t bodies) {
    followed_.apply(host_->events(), bodies);
    for (const Pair pair : followed_.impossible()) {
      throw std::logic_error(fmt::format("frame {}: {}-{} cannot be: {} began, {} ended", index_,
                                         pair.a, pair.b, pairCount(host_->events().began),
                                         pairCount(host_->events().ended)));
    }
  }

  Case run_;
  std::unique_ptr<InProcessExecutor> host_;
  std::unique_ptr<ChangeDetector> changed_bodies_;
  EventAccumulator followed_;
  FrameTimes times_;
  std::uint32_t index_ = 0;
};

/// Whether an answer has all the right pairs, and no false ones.
inline testing::AssertionResult isRight(PairRuns answer, const std::vector<Pair>& right,
                                        const Frame& frame, float margin = 0,
                                        const CollisionFilter& filter = {}) {
  const PairRun right_run = right;
  // Much quicker, and enough where no extra pair is allowed.
  if (margin == 0 && digest(answer) == digest({&right_run, 1})) return testing::AssertionSuccess();
  const FrameDifference difference = findDifference(answer, right, frame, margin, filter);
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
