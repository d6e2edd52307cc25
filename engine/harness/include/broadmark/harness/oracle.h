// What the right answer is, and how a given one differs from it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/frame.h"
#include "broadmark/hasher.h"
#include "broadmark/pair.h"
#include "broadmark/reference_pairs.h"

namespace broadmark {

/// The right answer for any boxes, computed once and kept while it fits in a budget. An answer is
/// found again by the boxes' hash and the filter: two scenes may share an oracle, and equal frames
/// share an answer.
class Oracle {
 public:
  /// It finds at most so many pairs in a frame.
  explicit Oracle(std::size_t budget_bytes = std::size_t{1} << 30,
                  std::size_t most_pairs = kAnyNumberOfPairs)
      : budget_bytes_(budget_bytes), most_pairs_(most_pairs) {}

  // Both throw InputError if there are more than it may find.

  /// The overlapping pairs of these boxes that are wanted, ascending; valid until the next call.
  std::span<const Pair> pairs(std::span<const Aabb> boxes, const CollisionFilter& filter = {});
  PairDigest pairDigest(std::span<const Aabb> boxes, const CollisionFilter& filter = {});

 private:
  struct Answer {
    CollisionFilter filter;
    PairDigest digest;
    std::optional<std::vector<Pair>> pairs;  ///< nothing when they did not fit in the budget
  };
  /// The pairs asked for are in the answer, or else in scratch_.
  Answer& find(std::span<const Aabb> boxes, const CollisionFilter& filter, bool with_pairs);

  std::map<std::pair<HashValue, const void*>, Answer> answers_;
  std::vector<Pair> scratch_;
  std::size_t budget_bytes_;
  std::size_t most_pairs_;
};

/// How an answer differs from the right one in one frame.
///
/// An extra pair was reported though the two boxes do not overlap, or are not wanted: it is
/// *allowed* when they are wanted and overlap once enlarged by the algorithm's margin, else it is
/// *false*. An invalid pair is a duplicate, has
/// a >= b, or names a body that does not exist; of events also one that cannot be, as
/// EventAccumulator says.
struct FrameDifference {
  /// At most this many pairs of each kind are listed; the counts are always complete.
  static constexpr std::size_t kListed = 1000;

  int repetition = 0;
  std::uint32_t frame = 0;
  std::uint64_t missed_count = 0;
  std::uint64_t false_count = 0;
  std::uint64_t allowed_extra_count = 0;
  std::uint64_t invalid_count = 0;
  std::vector<Pair> missed_pairs;
  std::vector<Pair> false_pairs;
  std::vector<Pair> allowed_extra_pairs;
  std::vector<Pair> invalid_pairs;

  void addInvalid(PairRun pairs);
  /// Allowed extra pairs are no mismatch.
  [[nodiscard]] bool isMismatch() const { return missed_count + false_count + invalid_count > 0; }
};

/// "12 missed, 0 false, 1 invalid"
std::string mismatchText(const FrameDifference&);

/// Compares an answer with the right pairs (ascending) of these boxes. `margin` as in
/// BroadPhase::margin().
FrameDifference findDifference(PairRuns answer, std::span<const Pair> right, const Frame& frame,
                               float margin = 0, const CollisionFilter& = {});

}  // namespace broadmark
