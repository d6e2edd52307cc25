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
///
/// A call hashes the boxes, O(bodies). An answer that is not cached takes O(n²) for up to 100
/// bodies, else a sweep, O(n log n + candidates); for queries O(queries · n). Answers beyond the
/// budget are computed by each call. Used by one thread at a time.
class Oracle {
 public:
  /// The default budget: 1 GiB.
  static constexpr std::size_t kBudgetBytes = std::size_t{1} << 30;

  /// `budget_bytes`: the limit of all cached pairs and hits; digests of pairs are always cached.
  /// `max_pairs`: the limit of pairs per frame.
  explicit Oracle(std::size_t budget_bytes = kBudgetBytes, std::size_t max_pairs = kUnlimitedPairs,
                  CancelQuery cancelled = {})
      : budget_bytes_(budget_bytes), max_pairs_(max_pairs), cancelled_(std::move(cancelled)) {}

  // pairs() and pairDigest() of more than 100 bodies throw InputError beyond the limit of pairs,
  // and Cancelled. In a periodic world the boxes must be wrapped().

  /// The overlapping wanted pairs of these boxes, ascending; valid until the next call.
  std::span<const Pair> pairs(std::span<const Aabb> boxes, const CollisionFilter& filter = {},
                              const PeriodicBox& periodic = {});
  /// The hits of the queries that a case with this answer gets in the frame, without the collision
  /// filter; valid until the next call. Neither limited nor cancelled.
  const HitBounds& hits(Answer, const Frame&);
  /// The digest of pairs(). Cached even if the pairs are beyond the budget.
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
/// a pair of an impossible event (see EventAccumulator). For queries, extra hits are false, and
/// only duplicates are invalid.
struct FrameDifference {
  /// The maximum number of pairs listed of each kind; the counts are always complete.
  static constexpr std::size_t kMaxListed = 1000;

  int repetition = 0;       ///< from 1; a warm-up has the number of the next one
  std::uint32_t frame = 0;  ///< as Frame::index
  std::uint64_t missed_count = 0;
  std::uint64_t false_count = 0;
  std::uint64_t allowed_extra_count = 0;
  std::uint64_t invalid_count = 0;
  std::uint64_t duplicate_count = 0;  ///< of the invalid pairs; 0 for queries
  // The first of each kind; invalid ones in the order of the answer, duplicates after them; the
  // others ascending.
  std::vector<Pair> missed_pairs;
  std::vector<Pair> false_pairs;
  std::vector<Pair> allowed_extra_pairs;
  std::vector<Pair> invalid_pairs;

  /// Counts and lists these pairs as invalid.
  void addInvalid(PairRun pairs);
  /// Allowed extra pairs are no mismatch.
  [[nodiscard]] bool isMismatch() const { return missed_count + false_count + invalid_count > 0; }
};

/// "12 missed, 0 false, 1 invalid"
std::string mismatchText(const FrameDifference&);

/// Compares an answer to queries with the certain and the possible hits. An answer with too few of
/// the nearest bodies misses that many, which `missed_pairs` may not list. O(h log h) for h hits.
FrameDifference findDifference(PairRuns answer, const HitBounds& hits, const Frame& frame);

/// Compares an answer with the correct pairs (ascending) of the frame's boxes, under the filter and
/// in the periodic box that these pairs were computed for. `margin` as in BroadPhase::margin(), in
/// world units. O(k log k) for k pairs.
FrameDifference findDifference(PairRuns answer, std::span<const Pair> correct, const Frame& frame,
                               float margin = 0, const CollisionFilter& = {},
                               const PeriodicBox& = {});

}  // namespace broadmark
