// What is known of a wrong pair: how it is wrong, how its two boxes lie on every axis, and since
// when they overlap.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "broadmark/aabb.h"
#include "broadmark/harness/oracle.h"
#include "broadmark/names.h"
#include "broadmark/render/palette.h"
#include "inspector/run/run_thread.h"

namespace broadmark {

/// How a pair of an answer can be wrong, as in FrameDifference.
struct WrongKind {
  std::string_view name;
  std::vector<Pair> FrameDifference::*pairs;
  std::uint64_t FrameDifference::*count;
  Rgb Palette::*colour;
};
/// The last one is no mismatch.
inline constexpr std::array<WrongKind, 4> kWrongKinds = {
    {{"missed", &FrameDifference::missed_pairs, &FrameDifference::missed_count, &Palette::missed},
     {"false", &FrameDifference::false_pairs, &FrameDifference::false_count, &Palette::false_pair},
     {"invalid", &FrameDifference::invalid_pairs, &FrameDifference::invalid_count,
      &Palette::invalid},
     {"allowed extra", &FrameDifference::allowed_extra_pairs, &FrameDifference::allowed_extra_count,
      &Palette::allowed_extra}}};

struct WrongPair {
  const WrongKind* kind;
  Pair pair;
};
/// "3-17".
std::string pairName(Pair pair);

/// All that are listed, kind by kind in the order above.
std::vector<WrongPair> wrongPairs(const FrameDifference& difference);

inline constexpr std::array kAxes = {"x", "y", "z"};

/// The relation of two boxes on an axis.
struct AxisRelation {
  enum class Type { overlap, touch, gap };
  Type type = Type::gap;
  /// The distance between the intervals; below 0: by how much they overlap.
  double gap = 0;
};
inline constexpr NameTable kRelations{{NamedValue{AxisRelation::Type::overlap, "overlap"},
                                       {AxisRelation::Type::touch, "touch"},
                                       {AxisRelation::Type::gap, "gap"}}};
AxisRelation relationOn(std::size_t axis, const Aabb& a, const Aabb& b);
/// The axis that decides whether they overlap: the one with the widest gap, or, if there is none,
/// with the least overlap.
std::size_t decidingAxis(const Aabb& a, const Aabb& b);

/// Of a body that is absent at the end of its trail: "absent: vanished in frame 41".
std::string absenceText(const Trail& trail);

/// Why the overlap of two bodies would not count: "not wanted: layers 1 and 2 do not collide". ""
/// if it would.
std::string unwantedText(const CollisionFilter& filter, Pair pair);

/// Two trail_bodies bodies, side by side; both trails span the same frames.
struct PairTrails {
  const Trail& a;
  const Trail& b;

  [[nodiscard]] std::size_t size() const { return std::min(a.boxes.size(), b.boxes.size()); }
  [[nodiscard]] bool overlapsAt(std::size_t i) const { return overlaps(a.boxes[i], b.boxes[i]); }
  /// The frame since which they have overlapped up to the last one without a break; nothing when
  /// they do not overlap there.
  [[nodiscard]] std::optional<std::uint32_t> overlapBegan() const;
};

/// Whether a body's box differs from that of the frame before.
inline bool movedAt(const Trail& trail, std::size_t i) {
  return i > 0 && trail.boxes[i] != trail.boxes[i - 1];
}

}  // namespace broadmark
