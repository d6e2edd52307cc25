// Pairs in ascending order: sorting them, and applying events to them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "broadmark/large_array.h"
#include "broadmark/pair.h"

namespace broadmark {

/// An array of pairs that keeps its memory.
class PairArray {
 public:
  void clear() { pairs_.resize(0); }
  [[nodiscard]] std::size_t size() const { return pairs_.size(); }
  [[nodiscard]] PairRun run() const { return {pairs_.data(), pairs_.size()}; }

  /// Becomes the runs, one after another.
  void assign(PairRuns runs);
  /// Becomes the runs' pairs in ascending order; they are of bodies below `bodies`.
  void assignSorted(PairRuns runs, std::size_t bodies);
  /// Applies events, both ascending, to ascending pairs. Copies only if there are events.
  void apply(PairRun began, PairRun ended);
  /// Becomes the pairs of `from` that are not in `without`, both ascending.
  void assignDifference(PairRun from, PairRun without);

 private:
  void append(PairRun pairs);

  LargeArray<Pair> pairs_;
  LargeArray<Pair> spare_;
  LargeArray<std::uint32_t> begins_;  ///< by lower body: where its next pair goes
};

}  // namespace broadmark
