// The search for overlapping pairs in an adaptive KD tree.
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
#include "simd/sweep_kernels.h"
#include "sorted_windows.h"

namespace broadmark::kd {

/// The search of one worker. Retains its memory between frames.
class Searcher {
 public:
  explicit Searcher(Isa isa);

  struct Scene {
    const Tree& tree;
    std::span<const Aabb> boxes;              ///< one per body
    std::span<const std::uint8_t> moved;      ///< one per body: 1 if its pairs are searched for
    const CollisionFilter* filter = nullptr;  ///< null: all pairs are wanted
  };

  /// Adds the overlapping pairs with at least one moved body that are found in the part-th of
  /// `parts` nearly equal shares of the work.
  void search(const Scene& scene, int part, int parts, PairBuffer& pairs);

  [[nodiscard]] std::uint64_t skippedSubtrees() const { return skipped_subtrees_; }
  [[nodiscard]] std::uint64_t boxesTested() const { return boxes_tested_; }

 private:
  /// Sorting a box and finding its window costs about as much as this number of vector tests.
  static constexpr std::size_t kTestsPerSortedBox = 16;

  /// Own bodies of ancestors that reach into a cell: a range of lists_, moved bodies first.
  struct List {
    std::size_t begin = 0;
    std::size_t unchanged = 0;
    std::size_t end = 0;
  };
  /// Where the sections of arranged_ begin; the own moved bodies come first.
  struct Sections {
    std::size_t listed_unchanged = 0;
    std::size_t listed_moved = 0;
    std::size_t own_unchanged = 0;
    std::size_t end = 0;
  };

  void enter(const Node& node, std::size_t begin, std::uint64_t work_before, List list);
  void visit(const Node& node, std::size_t begin, std::uint64_t work_before, List list);
  [[nodiscard]] bool ownsNode(std::uint64_t work_before) const;
  void arrange(std::span<const std::uint32_t> own, List list);
  void gatherBoxes();
  [[nodiscard]] std::size_t requiredTests() const;
  void test();
  void sweep();
  void addPairs();
  template <class Reaches>
  List push(bool child_dirty, Reaches reaches);
  template <class Reaches>
  void pushSection(std::size_t begin, std::size_t end, Reaches reaches);

  const OverlapKernels* kernels_;
  const SweepKernels* sweep_kernels_;
  std::size_t min_tests_to_sort_;

  const Scene* scene_ = nullptr;
  PairBuffer* pairs_ = nullptr;
  /// The worker's share: nodes with their first work in this range.
  std::uint64_t work_begin_ = 0;
  std::uint64_t work_end_ = 0;
  std::uint64_t skipped_subtrees_ = 0;
  std::uint64_t boxes_tested_ = 0;

  std::vector<std::uint32_t> lists_;  ///< a stack

  // Of the current node.
  Sections sections_;
  std::vector<std::uint32_t> arranged_;
  std::vector<std::uint32_t> own_unchanged_;
  BoxArrays boxes_;

  ThreadTeam single_thread_{1};
  SortedWindows sorted_;  ///< indices into arranged_

  PairBuffer hits_;  ///< indices into arranged_
};

}  // namespace broadmark::kd
