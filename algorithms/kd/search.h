// Finding the pairs of an adaptive KD tree.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadmark/box_arrays.h"
#include "broadmark/execution.h"
#include "broadmark/pair.h"
#include "kd/tree.h"
#include "simd/overlap_kernels.h"
#include "sorted_windows.h"

namespace broadmark::kd {

/// One worker's search. Keeps its memory from frame to frame.
class Searcher {
 public:
  explicit Searcher(Isa isa);

  /// What is searched. All borrowed.
  struct Scene {
    const Tree& tree;
    std::span<const Aabb> boxes;              ///< one per body
    std::span<const std::uint8_t> moving;     ///< one per body: 1 if its pairs are searched for
    const CollisionFilter* filter = nullptr;  ///< null: all pairs are wanted
  };

  /// Adds every pair of overlapping bodies at least one of which moves, in the part-th of `parts`
  /// nearly equal shares of the work.
  void search(const Scene& scene, int part, int parts, PairBuffer& pairs);

  /// Subtrees that the last search had no need to enter.
  [[nodiscard]] std::uint64_t skippedSubtrees() const { return skipped_; }
  /// Boxes that it looked at.
  [[nodiscard]] std::uint64_t boxesTested() const { return boxes_tested_; }

 private:
  /// Vector tests that cost as much as to sort a box and find its window.
  static constexpr std::size_t kVectorsPerSorted = 16;

  /// Bodies kept further up that reach into a cell: a stretch of lists_, the moving ones first.
  struct List {
    std::size_t begin = 0;
    std::size_t still = 0;
    std::size_t end = 0;
  };
  /// Where each kind begins among the bodies arranged for a node.
  struct Sections {
    std::size_t listed_still = 0;  ///< own moving ones come first
    std::size_t listed_moving = 0;
    std::size_t own_still = 0;
    std::size_t end = 0;
  };

  void enter(const Node& node, std::size_t begin, std::uint64_t work_before, List list);
  void visit(const Node& node, std::size_t begin, std::uint64_t work_before, List list);
  [[nodiscard]] bool isMine(std::uint64_t work_before) const;
  void arrange(std::span<const std::uint32_t> own, List list);
  void gatherBoxes();
  [[nodiscard]] std::size_t testsWanted() const;
  void test();
  void sweep();
  void addPairs();
  template <class Reaches>
  List push(bool child_touched, Reaches reaches);
  template <class Reaches>
  void pushSection(std::size_t begin, std::size_t end, Reaches reaches);

  const OverlapKernels* kernels_;
  std::size_t tests_per_sorted_;

  const Scene* scene_ = nullptr;
  PairBuffer* pairs_ = nullptr;
  /// Nodes whose work begins in here are this worker's.
  std::uint64_t work_begin_ = 0;
  std::uint64_t work_end_ = 0;
  std::uint64_t skipped_ = 0;
  std::uint64_t boxes_tested_ = 0;

  std::vector<std::uint32_t> lists_;  ///< a stack

  // The present node's bodies and their boxes, in sections.
  Sections sections_;
  std::vector<std::uint32_t> arranged_;
  std::vector<std::uint32_t> own_still_;
  BoxArrays boxes_;

  ThreadTeam alone_{1};
  SortedWindows sorted_;  ///< of positions among the arranged bodies, for the sweep

  PairBuffer hits_;  ///< by position among the arranged bodies
};

}  // namespace broadmark::kd
