// The right pairs of any boxes, what every answer is compared with, and fingerprints of pairs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "broadmark/aabb.h"
#include "broadmark/collision_filter.h"
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

/// All overlapping pairs that are wanted, ascending, by testing each body against each: O(n²). The
/// definition.
std::vector<Pair> bruteForcePairs(std::span<const Aabb>, const CollisionFilter& = {});

/// As many pairs as memory holds.
inline constexpr std::size_t kAnyNumberOfPairs = std::numeric_limits<std::size_t>::max();

/// The same by an exact sweep within strips of the second axis: O(n log n + candidates). Tested
/// against bruteForcePairs. Throws InputError if there are more than `most`.
std::vector<Pair> sweptPairs(std::span<const Aabb>, const CollisionFilter& = {},
                             std::size_t most = kAnyNumberOfPairs);

}  // namespace broadmark
