// Queries: which bodies' boxes overlap a box, are crossed by a ray, are touched by a moving box, or
// are nearest to a point.
//
// Example:
//
//   const std::vector<Aabb> boxes = {{{0, 0, 0}, {1, 1, 1}}, {{4, 0, 0}, {5, 1, 1}}};
//   const Query ray{.box = {{-1, 0.5, 0.5}, {-1, 0.5, 0.5}}, .motion = {10, 0, 0}};
//   const bool is_hit = hits(AnswerKind::rays, ray, boxes[1]);
//   const HitBounds all = findHits({AnswerKind::rays, {&ray, 1}}, boxes);  // (0, 0), (0, 1)
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadmark/aabb.h"
#include "broadmark/answer.h"
#include "broadmark/pair.h"

namespace broadmark {

/// A query for the bodies nearest to a point has this many, or all if there are fewer.
inline constexpr std::size_t kNearestBodies = 8;

/// A box that moves by `motion`; a ray is a point that moves, a point a box without extent. Boxes
/// and points of AnswerKind::boxes and nearest do not move.
struct Query {
  Aabb box;
  std::array<float, 4> motion{};
};

/// The queries of a frame, borrowed.
struct QueryBatch {
  AnswerKind kind;
  std::span<const Query> queries;
};

/// Whether a body is hit by a query that is not for the nearest bodies. In double: rays and moving
/// boxes are subject to rounding.
bool hits(AnswerKind kind, const Query& query, const Aabb& body);
/// The distance of a body from a box or point at rest, in double.
double distanceTo(const Query& query, const Aabb& body);

/// The largest absolute value of the coordinates of present bodies.
float largestCoordinate(std::span<const Aabb> boxes);

/// Queries around the bodies of a frame: half start at the centre of a random body, half anywhere
/// within the bounds of all bodies. Boxes and moving boxes have four times and once the mean
/// edge of the bodies; rays are as long as a quarter of the diagonal of these bounds, motions of
/// boxes eight times the mean edge. The same for the same boxes, frame and answer. None without
/// bodies.
std::vector<Query> makeQueries(Answer answer, std::span<const Aabb> boxes, std::uint32_t frame);

/// Hits as pairs: a, the query; b, the body.
///
/// Algorithms compute rays, sweeps and distances with rounding errors. A hit is certain if it also
/// is one at a distance of 64 units in the last place of the largest coordinate; it is possible if
/// it is one within that distance.
struct HitBounds {
  std::vector<Pair> certain;  ///< ascending
  std::vector<Pair> possible;
  /// Hits that a complete answer has at least: the nearest bodies include some at equal distance.
  std::uint64_t min_count = 0;
};

/// By brute force.
HitBounds findHits(const QueryBatch& batch, std::span<const Aabb> boxes);

}  // namespace broadmark
