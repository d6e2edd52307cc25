// Accumulates events into a set of pairs.
//
// Example:
//
//   const std::vector<Pair> pairs = {{0, 1}, {2, 5}};
//   const PairRun run = pairs;
//   EventAccumulator accumulator;
//   accumulator.apply({.began = {&run, 1}, .ended = {}}, 6);  // both pairs are present
//   accumulator.apply({.began = {}, .ended = {&run, 1}}, 6);  // none is
//   accumulator.apply({.began = {}, .ended = {&run, 1}}, 6);
//   const std::size_t faults = accumulator.impossible().size();  // 2
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "broadmark/pair.h"

namespace broadmark {

/// Reconstructs the pair set from begin and end events; used by the checker.
class EventAccumulator {
 public:
  EventAccumulator() = default;
  EventAccumulator(EventAccumulator&&) = default;
  EventAccumulator& operator=(EventAccumulator&&) = default;

  /// Removes all pairs, and those of impossible events. Retains the memory.
  void clear();
  /// Applies the events of the next frame of a scene with `bodies` bodies, in any order. Impossible
  /// events do not fail. O(k + e log ek) for k pairs and e events; O(1) without events. A steady
  /// state allocates nothing.
  void apply(const PairEvents& events, std::size_t bodies);

  /// All present pairs, ascending. Valid until the next call of clear() or apply(), or a move.
  [[nodiscard]] PairRuns pairs() const { return {&run_, 1}; }
  /// The pairs of impossible events of the last frame, each once, ascending: a pair that began
  /// though present, ended though absent, occurred repeatedly, or is invalid (a >= b, or a
  /// nonexistent body). A pair that ended and began in one frame retains its state. Valid as
  /// pairs().
  [[nodiscard]] PairRun impossible() const { return impossible_; }

 private:
  std::vector<Pair> pairs_;  ///< ascending
  PairRun run_;              ///< view of pairs_
  std::vector<Pair> impossible_;
  // For the present frame, ascending.
  std::vector<Pair> began_;
  std::vector<Pair> ended_;
  std::vector<Pair> next_;
  std::vector<std::pair<Pair, bool>> events_;  ///< true: an end event
};

}  // namespace broadmark
