// What is to be known of a wrong pair: which pairs are wrong and how, how two boxes lie to each
// other on every axis, and since when they overlap.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "inspector/run_thread.h"

namespace broadmark {

struct WrongPair {
  /// `allowed`: reported though apart, within the algorithm's margin; no mismatch.
  enum class Kind { missed, extra, invalid, allowed };
  Kind kind = Kind::missed;
  Pair pair;
};
/// "missed", "extra", "invalid", "allowed".
const char* wrongPairName(WrongPair::Kind kind);
/// "3-17".
std::string pairName(Pair pair);

/// All that are listed, kind by kind in the order above.
std::vector<WrongPair> wrongPairs(const FrameDifference& difference, const std::vector<Aabb>& boxes,
                                  float margin);

/// How two boxes lie to each other on one axis.
struct AxisRelation {
  enum class Kind { overlap, touch, gap };
  Kind kind = Kind::gap;
  /// The distance between the intervals; below 0: by how much they overlap.
  double gap = 0;
};
/// "overlap", "touch", "gap".
const char* relationName(AxisRelation::Kind kind);
AxisRelation relationOn(std::size_t axis, const Aabb& a, const Aabb& b);
/// The axis that decides whether they overlap: the one with the widest gap, or, if there is none,
/// with the least overlap.
std::size_t decidingAxis(const Aabb& a, const Aabb& b);

/// Two tracked bodies, side by side; both tracks span the same frames.
struct PairTrack {
  const Track& a;
  const Track& b;

  [[nodiscard]] std::size_t size() const { return std::min(a.boxes.size(), b.boxes.size()); }
  [[nodiscard]] bool overlapsAt(std::size_t i) const { return overlaps(a.boxes[i], b.boxes[i]); }
  /// The frame since which they have overlapped up to the last one without a break; nothing when
  /// they do not overlap there.
  [[nodiscard]] std::optional<std::uint32_t> overlapBegan() const;
};

/// Whether a body's box differs from that of the frame before.
inline bool movedAt(const Track& track, std::size_t i) {
  return i > 0 && track.boxes[i] != track.boxes[i - 1];
}

/// The next frame after `frame` in which a lane is known to be wrong.
std::optional<RunProgress::Stop> nextKnownMismatch(const std::vector<LaneReport>& lanes,
                                                   std::uint32_t frame);

}  // namespace broadmark
