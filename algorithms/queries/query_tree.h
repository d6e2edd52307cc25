// The tree that answers queries: see query_tree.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "broadmark/aabb.h"
#include "broadmark/broadphase.hpp"
#include "broadmark/collision_filter.h"
#include "broadmark/execution.h"
#include "broadmark/large_array.h"
#include "broadmark/range.h"
#include "queries/query_kernels.h"
#include "queries/query_parts.h"

namespace broadmark::broadphase {

/// The bodies that a query tree is made of.
struct QueryWorld {
  std::span<const Aabb> boxes;  ///< by body; kEmptyBox: absent
  const CollisionFilter& filter;
};

class QueryTree {
 public:
  explicit QueryTree(Isa isa) : kernels_(queryKernels(isa)) {}

  /// The bodies' boxes have changed since the last refresh().
  void markDirty(std::span<const std::uint32_t> bodies);
  /// Boxes, layers or the number of bodies have changed.
  void markAllDirty() { all_dirty_ = true; }

  /// Must precede queries. Builds or refits the tree if anything is dirty. If it throws, the next
  /// call builds.
  void refresh(const QueryWorld& world, ThreadTeam& team);

  /// Answers to queries as BroadPhase requires them.
  void overlapping(std::span<const BoxQuery> queries, QueryResults<std::uint32_t>& results,
                   ThreadTeam& team);
  void cast(std::span<const Cast> casts, Hits hits, QueryResults<CastHit>& results,
            ThreadTeam& team);
  void nearest(std::span<const NearestQuery> queries, QueryResults<Neighbour>& results,
               ThreadTeam& team);

 private:
  using Body = std::uint32_t;
  using NodeIndex = std::uint32_t;
  /// A slot of a node: the node times QueryNode::kWidth, plus the slot.
  using SlotIndex = std::uint32_t;
  using Nodes = LargeVector<QueryNode>;

  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// The union of the boxes and layers of a node's slots.
  struct Extent {
    float bounds[6];
    std::uint32_t layers;
  };
  /// The memory of one worker.
  struct Worker {
    Nodes nodes;                       ///< of a subtree
    std::vector<NodeIndex> postponed;  ///< nodes with parents of another worker
    std::int64_t loosened = 0;
    std::vector<std::uint32_t> bodies;  ///< answers of a batch
    std::vector<CastHit> hits;
    std::vector<Neighbour> neighbours;
  };

  void build(const QueryWorld& world, ThreadTeam& team);
  static NodeIndex buildNode(Nodes& nodes, const QueryPart& part, std::uint32_t depth);
  void buildSubtrees(ThreadTeam& team);
  void linkNodes();

  void refitDirty(const QueryWorld& world);
  void refitAll(const QueryWorld& world, ThreadTeam& team);
  void refitNodes(const QueryWorld& world, bool evicts, Range range, Worker& worker);
  void refitParents(NodeIndex node);
  [[nodiscard]] bool isDegraded(std::size_t bodies) const;

  [[nodiscard]] Extent extentOf(NodeIndex node) const;
  [[nodiscard]] Extent extentIn(SlotIndex slot) const;
  int storeExtent(NodeIndex node, const Extent& extent);
  [[nodiscard]] bool isLoose(NodeIndex node, const Extent& extent) const;
  [[nodiscard]] bool hasEscaped(const Aabb& box, NodeIndex node) const;
  void setSlot(SlotIndex slot, const Aabb& box, std::uint32_t layers);
  void placeBody(SlotIndex slot, Body body, const QueryWorld& world);
  void clearSlot(SlotIndex slot);
  void insert(Body body, const QueryWorld& world);

  template <class Query, class T, class Answer>
  void answerAll(std::span<const Query> queries, QueryResults<T>& results,
                 std::vector<T> Worker::* found, ThreadTeam& team, Answer answer);

  const QueryKernels& kernels_;
  bool is_built_ = false;

  bool all_dirty_ = false;
  std::size_t dirty_limit_ = 0;  ///< more are all
  std::vector<Body> dirty_;      ///< since the last refresh; may contain one twice

  Nodes nodes_;                          ///< parents precede their children; 0 is the root
  std::vector<SlotIndex> parent_slots_;  ///< by node
  std::vector<float> built_sizes_;       ///< by node: sizeOf() when it was built
  std::vector<SlotIndex> slot_of_;       ///< by body; kNone: absent
  std::vector<QueryItem> items_;
  std::vector<Worker> workers_ = std::vector<Worker>(1);
  std::size_t built_nodes_ = 0;
  std::size_t inserted_ = 0;  ///< bodies since the build
  std::int64_t loose_nodes_ = 0;
  bool too_deep_ = false;
};

}  // namespace broadmark::broadphase
