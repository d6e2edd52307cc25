// What the right answer is, and how a given one differs from it.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "broadmark/frame.h"
#include "broadmark/pair.h"

namespace broadmark {

/// Order-independent fingerprint of a set of pairs. Two answers with equal digests are the same set
/// but for a chance of about 2^-64 (a duplicate changes it).
struct PairDigest {
  std::uint64_t count = 0;
  std::uint64_t hash = 0;

  friend bool operator==(const PairDigest&, const PairDigest&) = default;
};
PairDigest digest(PairRuns);

/// All overlapping pairs, ascending, by testing each body against each: O(n²). The definition.
std::vector<Pair> bruteForcePairs(std::span<const Aabb>);

/// All overlapping pairs, ascending, by an exact sweep within strips of the second axis:
/// O(n log n + candidates). Tested against bruteForcePairs.
std::vector<Pair> sweptPairs(std::span<const Aabb>);

/// The right answers of one scene's frames, computed once and kept while they fit in a budget.
class Oracle {
 public:
  explicit Oracle(std::size_t budget_bytes = std::size_t{1} << 30) : budget_bytes_(budget_bytes) {}

  /// The pairs of this frame, ascending; valid until the next call.
  std::span<const Pair> pairs(const Frame&);
  PairDigest pairDigest(const Frame&);

 private:
  std::map<std::uint32_t, std::vector<Pair>> kept_;
  std::map<std::uint32_t, PairDigest> digests_;
  std::vector<Pair> scratch_;
  std::size_t budget_bytes_;
};

/// How an answer differs from the right one in one frame.
struct FrameDifference {
  /// At most this many pairs of each kind are listed; the counts are always complete.
  static constexpr std::size_t kListed = 1000;

  int repetition = 0;
  std::uint32_t frame = 0;
  std::uint64_t missed_count = 0;
  std::uint64_t extra_count = 0;      ///< false pairs, allowed ones included
  std::uint64_t forbidden_count = 0;  ///< of these, pairs beyond the algorithm's margin
  std::uint64_t invalid_count = 0;    ///< duplicates, a >= b, or bodies that do not exist
  std::vector<Pair> missed;
  std::vector<Pair> extra;
  std::vector<Pair> invalid;

  [[nodiscard]] bool any() const { return missed_count + extra_count + invalid_count > 0; }
  [[nodiscard]] bool isMismatch() const {
    return missed_count + forbidden_count + invalid_count > 0;
  }
};

/// Compares an answer with the right pairs (ascending). `margin` as in Capabilities.
FrameDifference findDifference(PairRuns answer, std::span<const Pair> right, const Frame& frame,
                               float margin = 0);

}  // namespace broadmark
