// Correct answers, and the differences of an algorithm's answers from them.
//
// Example:
//
//   const auto missed = [](const Frame& frame, PairRuns answer) {
//     Oracle oracle;
//     const FrameDifference difference = findDifference(answer, oracle.pairs(frame.boxes), frame);
//     return difference.missed_count;  // and missed_pairs, false_pairs, invalid_pairs
//   };
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/frame.h"
#include "broadmark/hasher.h"
#include "broadmark/pair.h"
#include "broadmark/queries.h"
#include "broadmark/reference_pairs.h"

namespace broadmark {

/// Polled during long work; true ends the work.
using CancelQuery = std::function<bool()>;

/// Computes correct answers, and caches them within a budget. The key is the hash of boxes, filter
/// and periodic box: two scenes may share an oracle, and equal frames share an answer.
class Oracle {
 public:
  static constexpr std::size_t kBudgetBytes = std::size_t{1} << 30;

  /// `max_pairs`: the limit of pairs per frame.
  explicit Oracle(std::size_t budget_bytes = kBudgetBytes, std::size_t max_pairs = kUnlimitedPairs,
                  CancelQuery cancelled = {})
      : budget_bytes_(budget_bytes), max_pairs_(max_pairs), cancelled_(std::move(cancelled)) {}

  // These throw InputError beyond the limit of pairs, and Cancelled.

  /// The overlapping wanted pairs of these boxes, ascending; valid until the next call.
  std::span<const Pair> pairs(std::span<const Aabb> boxes, const CollisionFilter& filter = {},
                              const PeriodicBox& periodic = {});
  /// The hits of the queries that a case with this answer gets in the frame; valid until the next
  /// call.
  const HitBounds& hits(Answer, const Frame&);
  PairDigest pairDigest(std::span<const Aabb> boxes, const CollisionFilter& filter = {},
                        const PeriodicBox& periodic = {});

 private:
  struct PairAnswer {
    PairDigest digest;
    std::optional<std::vector<Pair>> pairs;  ///< nullopt if beyond the budget
  };
  /// With `with_pairs`, the pairs are in the answer, or else in scratch_.
  PairAnswer& find(std::span<const Aabb> boxes, const CollisionFilter& filter,
                   const PeriodicBox& periodic, bool with_pairs);

  std::map<HashValue, PairAnswer> answers_;
  std::map<std::pair<HashValue, std::string>, HitBounds> hits_;  ///< by frame and answer
  HitBounds hit_scratch_;
  std::vector<Pair> scratch_;
  std::size_t budget_bytes_;
  std::size_t max_pairs_;
  CancelQuery cancelled_;
};

/// The differences of an answer from the correct one in one frame.
///
/// An extra pair is reported although its boxes do not overlap, or although it is unwanted: it is
/// *allowed* if wanted and overlapping once enlarged by the algorithm's margin, else *false*. An
/// invalid pair is a duplicate, has a >= b, or names a nonexistent body; for events also
/// a pair of an impossible event (see EventAccumulator).
struct FrameDifference {
  /// The maximum number of pairs listed of each kind; the counts are always complete.
  static constexpr std::size_t kMaxListed = 1000;

  int repetition = 0;
  std::uint32_t frame = 0;
  std::uint64_t missed_count = 0;
  std::uint64_t false_count = 0;
  std::uint64_t allowed_extra_count = 0;
  std::uint64_t invalid_count = 0;
  std::uint64_t duplicate_count = 0;  ///< of the invalid pairs
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

/// Compares an answer to queries with what is certain and possible. If it has too few of the
/// nearest bodies, it misses that many.
FrameDifference findDifference(PairRuns answer, const HitBounds& hits, const Frame& frame);

/// Compares an answer with the correct pairs (ascending) of these boxes. `margin` as in
/// BroadPhase::margin().
FrameDifference findDifference(PairRuns answer, std::span<const Pair> correct, const Frame& frame,
                               float margin = 0, const CollisionFilter& = {},
                               const PeriodicBox& = {});

}  // namespace broadmark
