// Reference pairs for arbitrary boxes, and digests of pairs.
//
// Example:
//
//   const std::vector<Aabb> boxes = {{{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}};
//   const std::vector<Pair> correct = sweptPairs(boxes);  // (0, 1)
//   const PairRun run = correct;
//   const PairDigest digest_of_all = digest({&run, 1});  // compares answers in any order
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "broadmark/aabb.h"
#include "broadmark/collision_filter.h"
#include "broadmark/pair.h"
#include "broadmark/periodic_box.h"

namespace broadmark {

/// Order-independent digest of a set of pairs. Different sets have equal digests with a probability
/// of about 2^-64 (a duplicate changes the digest).
struct PairDigest {
  std::uint64_t count = 0;  ///< pairs, duplicates included
  std::uint64_t hash = 0;   ///< the sum of the pairs' own hashes, modulo 2^64

  friend bool operator==(const PairDigest&, const PairDigest&) = default;
};
/// The digest of all pairs of an answer. O(pairs); allocates nothing.
PairDigest digest(PairRuns);

/// All overlapping wanted pairs, ascending, by testing all pairs of bodies: O(n²). Boxes are by
/// body id. In a periodic world they must be wrapped().
std::vector<Pair> bruteForcePairs(std::span<const Aabb>, const CollisionFilter& = {},
                                  const PeriodicBox& = {});

/// No limit.
inline constexpr std::size_t kUnlimitedPairs = std::numeric_limits<std::size_t>::max();

/// The same pairs by an exact sweep within strips of the second axis: O(n log n + candidates).
/// Tested against bruteForcePairs. No box may have NaN. Throws InputError if there are more than
/// `max_pairs` pairs, before it stores more, except in a periodic world; and Cancelled soon after
/// `cancelled`, called once in 64 bodies, returns true.
std::vector<Pair> sweptPairs(std::span<const Aabb>, const CollisionFilter& = {},
                             const PeriodicBox& = {}, std::size_t max_pairs = kUnlimitedPairs,
                             const std::function<bool()>& cancelled = {});

}  // namespace broadmark
