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
/// and points of AnswerKind::boxes and nearest do not move. In world units; finite.
struct Query {
  Aabb box;                       ///< at the start
  std::array<float, 4> motion{};  ///< the whole way; the fourth component is padding
};

/// The queries of a frame, borrowed.
struct QueryBatch {
  AnswerKind kind;  ///< one of kQueryKinds
  std::span<const Query> queries;
};

/// Whether a body is hit by a query that is not for the nearest bodies: touching counts, an absent
/// body is never hit. In double: rays and moving boxes are subject to rounding; boxes at rest are
/// exact.
bool hits(AnswerKind kind, const Query& query, const Aabb& body);
/// The distance of a present body from a box or point at rest, in world units; 0 if they overlap.
/// In double.
double distanceTo(const Query& query, const Aabb& body);

/// The largest absolute value of the coordinates of present bodies; 0 without any.
float largestCoordinate(std::span<const Aabb> boxes);

/// Queries around the bodies of a frame: half start at the centre of a random body, half anywhere
/// within the bounds of all bodies. Boxes and moving boxes have four times and once the mean
/// edge of the bodies; rays are as long as a quarter of the diagonal of these bounds, motions of
/// boxes eight times the mean edge. The same for the same boxes, frame and answer. None without
/// bodies.
std::vector<Query> makeQueries(Answer answer, std::span<const Aabb> boxes, std::uint32_t frame);

/// Hits as pairs: a, the query; b, the body. An answer is right if it has all certain hits and none
/// but possible ones, at least `min_count`.
///
/// Algorithms compute rays, sweeps and distances with rounding errors. A hit is certain if the
/// query also hits the body's box once shrunk on every side by 64 units in the last place of the
/// largest coordinate, and possible if it hits the box once grown by as much. Hits of boxes at rest
/// are certain or impossible. Of the nearest bodies, those are certain that are nearer than the
/// last one by more than that, and possible that are farther by no more.
struct HitBounds {
  std::vector<Pair> certain;   ///< ascending
  std::vector<Pair> possible;  ///< ascending; includes the certain hits
  /// Hits that a complete answer has at least: the nearest bodies include some at equal distance.
  std::uint64_t min_count = 0;
};

/// The hits of all queries of one kind, by brute force: O(queries · bodies).
HitBounds findHits(const QueryBatch& batch, std::span<const Aabb> boxes);

}  // namespace broadmark
