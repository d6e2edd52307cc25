// Details of a wrong pair: the kind of mismatch, the relation of its boxes on each axis, and the
// start of their overlap.
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

/// A kind of wrong pair in FrameDifference.
struct WrongKind {
  std::string_view name;
  std::vector<Pair> FrameDifference::* pairs;
  std::uint64_t FrameDifference::* count;
  Rgb Palette::* colour;
};
/// The last kind is not a mismatch.
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

/// Returns all pairs of a difference, in the order of kWrongKinds.
std::vector<WrongPair> wrongPairs(const FrameDifference& difference);

inline constexpr std::array kAxes = {"x", "y", "z"};

/// The relation of two boxes on an axis.
struct AxisRelation {
  enum class Type { overlap, touch, gap };
  Type type = Type::gap;
  /// Distance between the intervals; negative: depth of the overlap.
  double gap = 0;
};
inline constexpr NameTable kRelations{{NamedValue{AxisRelation::Type::overlap, "overlap"},
                                       {AxisRelation::Type::touch, "touch"},
                                       {AxisRelation::Type::gap, "gap"}}};
AxisRelation axisRelation(std::size_t axis, const Aabb& a, const Aabb& b);
/// The colour of a relation.
inline Rgb relationColour(const Palette& theme, AxisRelation::Type type) {
  constexpr Rgb Palette::* kColours[] = {&Palette::good, &Palette::warning, &Palette::bad};
  return theme.*kColours[static_cast<std::size_t>(type)];
}
/// Returns on each axis the overlap of the intervals or the gap between them.
Aabb relationBox(const Aabb& a, const Aabb& b);
/// Returns the axis with the widest gap or, if the boxes overlap, with the smallest overlap.
std::size_t maxSeparationAxis(const Aabb& a, const Aabb& b);

/// Describes a body that is absent at the end of its trail: "absent: vanished in frame 41".
std::string absenceText(const Trail& trail);

/// Explains why the collision filter excludes a pair: "filtered: layers 1 and 2 do not collide"; ""
/// if it does not.
std::string filterText(const CollisionFilter& filter, Pair pair);

/// The trails of two bodies over the same frames.
struct PairTrails {
  const Trail& a;
  const Trail& b;
  const PeriodicBox& periodic;

  [[nodiscard]] std::size_t size() const { return std::min(a.boxes.size(), b.boxes.size()); }
  [[nodiscard]] bool overlapsAt(std::size_t i) const {
    return overlaps(a.boxes[i], b.boxes[i], periodic);
  }
  /// The relation of their nearest images.
  [[nodiscard]] AxisRelation relationAt(std::size_t i, std::size_t axis) const {
    const auto [near_a, near_b] = nearestImages(a.boxes[i], b.boxes[i], periodic);
    return axisRelation(axis, near_a, near_b);
  }
  /// First frame of the overlap that lasts up to the last frame; nothing if the boxes do not
  /// overlap there.
  [[nodiscard]] std::optional<std::uint32_t> overlapStart() const;
};

/// Whether a body's box differs from the previous frame's.
inline bool movedAt(const Trail& trail, std::size_t i) {
  return i > 0 && trail.boxes[i] != trail.boxes[i - 1];
}

}  // namespace broadmark
