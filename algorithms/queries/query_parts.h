// Bodies, divided into parts that become the nodes of a query tree.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "broadmark/aabb.h"
#include "corner.h"
#include "queries/query_kernels.h"

namespace broadmark::broadphase {

inline Corner minCorner(const Aabb& box) { return cornerOf(box.min); }
inline Corner maxCorner(const Aabb& box) { return cornerOf(box.max); }

/// The bounds of some boxes.
struct Bounds {
  Corner min = Corner{} + QueryNode::kMax;
  Corner max = Corner{} - QueryNode::kMax;

  void add(Corner other_min, Corner other_max) {
    min = smaller(min, other_min);
    max = larger(max, other_max);
  }
  void add(const Bounds& other) { add(other.min, other.max); }
};

/// Half the surface.
inline double areaOf(const Bounds& bounds) {
  std::array<double, 3> edges;
  for (int axis = 0; axis < 3; ++axis) {
    edges[axis] = static_cast<double>(bounds.max[axis]) - static_cast<double>(bounds.min[axis]);
  }
  return edges[0] * edges[1] + edges[1] * edges[2] + edges[2] * edges[0];
}

/// Twice the centre may overflow.
inline Corner centreOf(const Aabb& box) { return minCorner(box) * 0.5F + maxCorner(box) * 0.5F; }

/// A body while the tree is built.
struct QueryItem {
  Aabb box;
  std::uint32_t body;
};

/// Some items, with the bounds of their boxes and of the centres of these.
struct QueryPart {
  std::span<QueryItem> items;
  Bounds bounds;
  Bounds centres;

  void add(const QueryItem& item) {
    const Corner centre = centreOf(item.box);
    bounds.add(minCorner(item.box), maxCorner(item.box));
    centres.add(centre, centre);
  }
  void add(const QueryPart& other) {
    bounds.add(other.bounds);
    centres.add(other.centres);
  }
};

QueryPart partOf(std::span<QueryItem> items);

/// Divides a part into up to eight, until they fit in nodes; returns their number. `by_area`: else
/// into halves, in any order.
std::size_t divide(const QueryPart& whole, bool by_area,
                   std::array<QueryPart, QueryNode::kWidth>& parts);

}  // namespace broadmark::broadphase
