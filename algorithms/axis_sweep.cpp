// Bullet's incremental sweep and prune (bt32BitAxisSweep3): a sorted array of endpoints per axis.
// The endpoints of a moved body are re-sorted by insertion; each swap of a lower with an upper
// endpoint may begin or end an overlap, stored in a hash table. O(n + s + k) a frame, s the number
// of swaps: few for small moves, O(n²) if all bodies move far. O(n + k) space.
//
// Two differences from Bullet:
// - Positions. Bullet's are 31-bit integers that divide a given world evenly; beyond it all bodies
// have the same position. Here they are the floats' own bits without the last one, which sort as
// the floats do, so no world bounds are needed. The missing bit and the integers' strict order add
// pairs; a test of the boxes removes them, so the answer is exact.
// - Initialisation. Bullet inserts bodies one by one, O(n²) swaps; here all are sorted at once and
// swept once along the best axis.
//
// Events need no hash table: a pair that begins or ends is added or removed by Bullet, or two
// endpoints have become equal or unequal within the missing bit. The old and new boxes decide.
//
// Papers: D. Baraff, "Dynamic Simulation of Non-Penetrating Rigid Bodies", PhD thesis, Cornell,
// 1992; P. Terdiman, "Sweep-and-prune", 2007. Library: Bullet 3, btAxisSweep3.

#include <BulletCollision/BroadphaseCollision/btAxisSweep3.h>

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/algorithm.h"
#include "bullet_broad_phase.h"
#include "radix_sort.h"

namespace broadmark::axis_sweep {
namespace {

/// Handles are 31-bit integers; Bullet uses one itself, and their number must be below the largest.
constexpr std::uint64_t kMaxObjects = 0x7FFF'FFFD;

/// The position of an endpoint. The lowest bit distinguishes upper from lower endpoints (as in
/// Bullet), so that touching intervals overlap. -0 becomes +0: they are equal.
unsigned position(float value, bool is_max) {
  return (sortKey(value + 0.0F) & ~1U) | static_cast<unsigned>(is_max);
}

/// The position on every axis of an absent body: above all floats, and unique per body as far as
/// there are positions.
unsigned absentPosition(std::uint32_t body, bool is_max) {
  constexpr unsigned kAboveInfinity = 0xFF80'0002;
  constexpr unsigned kPlaces = 0x003F'0000;
  return (kAboveInfinity + 2 * (body % kPlaces)) | static_cast<unsigned>(is_max);
}

unsigned position(const Aabb& box, std::uint32_t body, int axis, bool is_max) {
  if (isEmpty(box)) return absentPosition(body, is_max);
  return position((is_max ? box.max : box.min)[axis], is_max);
}

/// Bullet's sweep with different positions and initialisation. The handle of a body is its id + 1;
/// handle 0 is Bullet's sentinel at both ends of each axis.
class Sweep final : public bt32BitAxisSweep3 {
 public:
  /// Finds no pairs yet. They go into `pairs`, or, if that is null, into Bullet's hash table.
  Sweep(std::span<const Aabb> boxes, btOverlappingPairCache* pairs)
      : bt32BitAxisSweep3({0, 0, 0}, {1, 1, 1}, static_cast<unsigned>(boxes.size()), pairs,
                          /*disableRaycastAccelerator=*/true) {
    m_numHandles = static_cast<unsigned>(boxes.size());
    m_firstFreeHandle = 0;
    for (unsigned i = 1; i <= m_numHandles; ++i) {
      Handle& handle = *getHandle(i);
      handle.m_uniqueId = static_cast<int>(i);
      handle.m_collisionFilterGroup = btBroadphaseProxy::DefaultFilter;
      handle.m_collisionFilterMask = btBroadphaseProxy::AllFilter;
    }
    for (int axis = 0; axis < 3; ++axis) placeEdges(boxes, axis);
  }

  /// Updates a body.
  void move(std::uint32_t body, const Aabb& box) {
    Handle& handle = *getHandle(body + 1);
    for (int axis = 0; axis < 3; ++axis) {
      unsigned& min_edge = handle.m_minEdges[axis];
      unsigned& max_edge = handle.m_maxEdges[axis];
      const unsigned min_edge_before = min_edge;
      const unsigned max_edge_before = max_edge;
      const unsigned min = position(box, body, axis, false);
      const unsigned max = position(box, body, axis, true);
      const unsigned min_before = std::exchange(m_pEdges[axis][min_edge].m_pos, min);
      const unsigned max_before = std::exchange(m_pEdges[axis][max_edge].m_pos, max);
      // Growth before shrinkage: an endpoint never passes the body's own other endpoint.
      if (min < min_before) sortMinDown(axis, min_edge, nullptr, true);
      if (max > max_before) sortMaxUp(axis, max_edge, nullptr, true);
      if (min > min_before) sortMinUp(axis, min_edge, nullptr, true);
      if (max < max_before) sortMaxDown(axis, max_edge, nullptr, true);
      swaps_ += distance(min_edge, min_edge_before) + distance(max_edge, max_edge_before);
    }
  }

  /// Calls visit(other) for each body with an upper endpoint at the position of this one's lower
  /// endpoint, or vice versa.
  template <class Visit>
  void forEachTouching(std::uint32_t body, int axis, bool is_max, Visit visit) const {
    const Handle& handle = *getHandle(body + 1);
    const Edge* const edges = m_pEdges[axis];
    const unsigned own = (is_max ? handle.m_maxEdges : handle.m_minEdges)[axis];
    const auto meets = [&](unsigned e) {
      return edges[e].m_handle != 0 && (edges[e].m_pos | 1U) == (edges[own].m_pos | 1U);
    };
    const auto show = [&](unsigned e) {
      if ((edges[e].IsMax() != 0) != is_max && edges[e].m_handle != body + 1) {
        visit(static_cast<std::uint32_t>(edges[e].m_handle) - 1);
      }
    };
    for (unsigned e = own; meets(e - 1); --e) show(e - 1);
    for (unsigned e = own; meets(e + 1); ++e) show(e + 1);
  }

  /// A single sweep: two intervals overlap if one contains the start of the other.
  void findFirstPairs() {
    const int axis = bestAxis();
    for (unsigned i = 1; i <= m_numHandles; ++i) {
      Handle* const handle = getHandle(i);
      for (unsigned e = handle->m_minEdges[axis] + 1; e < handle->m_maxEdges[axis]; ++e) {
        const Edge& edge = m_pEdges[axis][e];
        if (edge.IsMax() != 0) continue;
        ++tests_;
        Handle* const other = getHandle(edge.m_handle);
        if (testOverlap2D(handle, other, (axis + 1) % 3, (axis + 2) % 3)) {
          m_pairCache->addOverlappingPair(handle, other);
        }
      }
    }
  }

  /// Pairs tested by findFirstPairs().
  [[nodiscard]] std::uint64_t tests() const { return tests_; }
  /// Swaps in all moves so far.
  [[nodiscard]] std::uint64_t swaps() const { return swaps_; }

  /// The axis with the fewest overlapping intervals.
  [[nodiscard]] int bestAxis() const {
    const std::array<std::uint64_t, 3> lengths = {length(0), length(1), length(2)};
    return static_cast<int>(std::ranges::min_element(lengths) - lengths.begin());
  }

  [[nodiscard]] std::string validate(std::span<const Aabb> boxes) const {
    for (int axis = 0; axis < 3; ++axis) {
      for (unsigned i = 1; i <= 2 * m_numHandles; ++i) {
        const Edge& edge = m_pEdges[axis][i];
        if (i > 1 && edge.m_pos < m_pEdges[axis][i - 1].m_pos) return "edges not sorted";
        const bool is_max = edge.IsMax() != 0;
        if (edgeOf(edge, axis) != i) return "a body has a wrong edge index";
        const Aabb& box = boxes[edge.m_handle - 1];
        if (edge.m_pos != position(box, edge.m_handle - 1, axis, is_max)) {
          return "an edge is not where its box ends";
        }
      }
    }
    return {};
  }

 private:
  static std::uint64_t distance(unsigned a, unsigned b) { return a < b ? b - a : a - b; }

  [[nodiscard]] unsigned& edgeOf(const Edge& edge, int axis) const {
    Handle& handle = *getHandle(edge.m_handle);
    return (edge.IsMax() != 0 ? handle.m_maxEdges : handle.m_minEdges)[axis];
  }

  void placeEdges(std::span<const Aabb> boxes, int axis) {
    Edge* const first = m_pEdges[axis] + 1;
    Edge* end = first;
    const Edge sentinel = *first;
    for (unsigned i = 1; i <= m_numHandles; ++i) {
      *end++ = {position(boxes[i - 1], i - 1, axis, false), i};
      *end++ = {position(boxes[i - 1], i - 1, axis, true), i};
    }
    std::sort(first, end, [](const Edge& a, const Edge& b) { return a.m_pos < b.m_pos; });
    *end = sentinel;
    for (const Edge* edge = first; edge <= end; ++edge) {
      edgeOf(*edge, axis) = static_cast<unsigned>(edge - m_pEdges[axis]);
    }
  }

  /// The number of edges between the two edges of a body, summed over the bodies.
  [[nodiscard]] std::uint64_t length(int axis) const {
    std::uint64_t sum = 0;
    for (unsigned i = 1; i <= m_numHandles; ++i) {
      sum += getHandle(i)->m_maxEdges[axis] - getHandle(i)->m_minEdges[axis];
    }
    return sum;
  }

  std::uint64_t tests_ = 0;
  std::uint64_t swaps_ = 0;
};

class AxisSweep final : public BulletBroadPhase {
 public:
  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    BulletBroadPhase::initialize(scene, first, execution);
    world_ = scene.world;
    sweep_ = std::make_unique<Sweep>(boxes(), reportsEvents() ? &changes_ : nullptr);
    filterPairs(*sweep_->getOverlappingPairCache());
    sweep_->findFirstPairs();
    if (!reportsEvents()) return;
    before_.assign(boxes().size(), kEmptyBox);
    gatherEvents();
  }

  void updateObjects(const Frame& frame) override {
    if (reportsEvents()) {
      for (const std::uint32_t body : moved()) before_[body] = boxes()[body];
    }
    BulletBroadPhase::updateObjects(frame);
  }

  void updateStructures() override {
    swaps_before_ = sweep_->swaps();
    if (reportsEvents()) addTouching();
    for (const std::uint32_t body : moved()) sweep_->move(body, boxes()[body]);
    if (reportsEvents()) addTouching();
  }

  /// Each axis of the world; the chosen one is the axis with the fewest overlaps.
  void drawStructure(DebugDraw& draw) const override {
    for (int axis = 0; axis < 3; ++axis) {
      std::array<float, 3> from = {world_.min[0], world_.min[1], world_.min[2]};
      std::array<float, 3> to = from;
      to[axis] = world_.max[axis];
      draw.line(from, to,
                axis == sweep_->bestAxis() ? StructureRole::best_split : StructureRole::split);
    }
  }

  void visitCounters(const CounterVisitor& visit) const override {
    visit("moves", moved().size());
    visit("swaps", sweep_->swaps() - swaps_before_);
    visit("first tests", sweep_->tests());
  }

  [[nodiscard]] std::string validate() const override { return sweep_->validate(boxes()); }

 private:
  /// Adds the bodies that moved bodies now touch according to the positions. Only on axes of
  /// motion: overlaps on other axes are unchanged.
  void addTouching() {
    for (const std::uint32_t body : moved()) {
      const auto add = [&](std::uint32_t other) {
        changes_.added.push_back(orderedPair(body, other));
      };
      for (int axis = 0; axis < 3; ++axis) {
        const auto moved_at = [&](auto side) {
          return (before_[body].*side)[axis] != (boxes()[body].*side)[axis];
        };
        if (moved_at(&Aabb::min)) sweep_->forEachTouching(body, axis, false, add);
        if (moved_at(&Aabb::max)) sweep_->forEachTouching(body, axis, true, add);
      }
    }
  }

  void gatherEvents() {
    findEvents([this](std::vector<Pair>& began, std::vector<Pair>& ended) {
      for (std::vector<Pair>* const candidates : {&changes_.added, &changes_.removed}) {
        for (const Pair pair : *candidates) {
          const bool before = broadmark::overlaps(before_[pair.a], before_[pair.b]);
          const bool now = broadmark::overlaps(boxes()[pair.a], boxes()[pair.b]);
          if (before != now && isWanted(pair)) (now ? began : ended).push_back(pair);
        }
        candidates->clear();
      }
      for (std::vector<Pair>* const pairs : {&began, &ended}) {
        std::ranges::sort(*pairs);
        pairs->erase(std::unique(pairs->begin(), pairs->end()), pairs->end());
      }
    });
  }

  void findPairs() override {
    if (reportsEvents()) return gatherEvents();
    addPairs(*sweep_->getOverlappingPairCache(), [this](std::uint32_t a, std::uint32_t b) {
      return broadmark::overlaps(boxes()[a], boxes()[b]);
    });
  }

  Aabb world_;
  // For events only.
  std::vector<Aabb> before_;  ///< in the previous frame
  Changes changes_;           ///< candidate events, by either list

  std::unique_ptr<Sweep> sweep_;
  std::uint64_t swaps_before_ = 0;  ///< swaps of this frame
};

}  // namespace

std::vector<Algorithm> variants() {
  return {{.id = "axis-sweep",
           .family = "AxisSweep",
           .summary = "Bullet's incremental sweep and prune on three axes",
           .traits = {.incremental = true,
                      .events = true,
                      .library_aborts = true,
                      .changing_worlds = ChangingWorlds::native,
                      .instance_per_world = true,
                      .max_objects = kMaxObjects},
           .description = {.principle = "sorting",
                           .optimisations = "incremental, pairs in a hash table",
                           .time = "O(n + s + k), s swaps of interval ends",
                           .space = "O(n + k)",
                           .source = "Bullet, bt32BitAxisSweep3; Baraff 1992; Terdiman 2007"},
           .create = [] { return std::make_unique<AxisSweep>(); }}};
}

}  // namespace broadmark::axis_sweep
