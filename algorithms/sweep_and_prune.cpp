// Sweep and prune: the boxes sorted by their lower bound on one axis, each tested on the other two
// axes against the boxes that begin before it ends. O(n log n + w) with comparison sorts, here
// O(n + w), w the pairs that overlap on the sort axis: about n^(5/3) for evenly spread boxes.
//
// The axis of the largest variance of the box centres is chosen anew every frame, and everything is
// sorted from scratch, by a radix sort. (To sort from last frame's order instead gains little: the
// sweep takes nearly all of the time.) Bodies keep their own ids throughout; only an order of ids
// is sorted.
//
// Papers: D. Baraff, "Dynamic Simulation of Non-Penetrating Rigid Bodies", PhD thesis, Cornell,
// 1992 (the sweep); J. D. Cohen, M. C. Lin, D. Manocha, M. K. Ponamgi, "I-COLLIDE", I3D 1995 (the
// name); C. Ericson, "Real-Time Collision Detection", 2005, 7.5 (the axis); Y. R. Serpa and M. A.
// F. Rodrigues, "Broadmark", Computer Graphics Forum, 2019 (these variants).

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "axis_overlap.h"
#include "boundary_near.h"
#include "moments.h"
#include "radix_sort.h"
#include "row_shares.h"
#include "simd/overlap_kernels.h"
#include "test_counts.h"
#include "variants.h"

namespace broadmark::sweep_and_prune {
namespace {

Aabb withAxes(const Aabb& box, const AxisOrder& axes) {
  return {{box.min[axes[0]], box.min[axes[1]], box.min[axes[2]], 0},
          {box.max[axes[0]], box.max[axes[1]], box.max[axes[2]], 0}};
}

/// The sorted boxes as structs, and the plain sweep over them.
class PlainSweeper {
 public:
  void initialize(const Execution&) {}
  void resize(std::size_t count) { boxes_.resize(count); }
  void set(std::size_t i, const Aabb& box) { boxes_[i] = box; }
  [[nodiscard]] float min(std::size_t i) const { return boxes_[i].min[0]; }
  [[nodiscard]] float max(std::size_t i) const { return boxes_[i].max[0]; }

  void sweep(const std::uint32_t* ends, const std::uint32_t* bodies, Range rows,
             PairBuffer& pairs) const {
    for (std::size_t i = rows.begin; i < rows.end; ++i) {
      const Aabb row = boxes_[i];
      const Aabb* const end = boxes_.data() + ends[i];
      for (const Aabb* column = boxes_.data() + i + 1; column != end; ++column) {
        // One axis rules most pairs out, so this branch is predicted well.
        if (overlapsOnAxis(row, *column, 1)) [[unlikely]] {
          if (overlapsOnAxis(row, *column, 2)) pairs.add(bodies[i], bodies[column - boxes_.data()]);
        }
      }
    }
  }

 private:
  std::vector<Aabb> boxes_;
};

/// The sorted boxes as arrays, and the vectorised sweep over them.
class SimdSweeper {
 public:
  void initialize(const Execution& execution) { kernels_ = &overlapKernels(execution.isa()); }
  void resize(std::size_t count) { boxes_.resize(count); }
  void set(std::size_t i, const Aabb& box) { boxes_.set(i, box); }
  [[nodiscard]] float min(std::size_t i) const { return boxes_.min(0)[i]; }
  [[nodiscard]] float max(std::size_t i) const { return boxes_.max(0)[i]; }

  void sweep(const std::uint32_t* ends, const std::uint32_t* bodies, Range rows,
             PairBuffer& pairs) const {
    kernels_->sweep(boxes_, ends, bodies, rows, pairs);
  }

 private:
  BoxArrays boxes_;
  const OverlapKernels* kernels_ = nullptr;
};

/// Every step is shared out over the team; one thread is a team of one.
template <class Sweeper>
class SweepAndPrune final : public PairBroadPhase {
 public:
  void initialize(const SceneInfo& scene, const Frame& first, Execution& execution) override {
    PairBroadPhase::initialize(scene, first, execution);
    world_ = scene.world;
    sweeper_.initialize(execution);
    moments_.resize(static_cast<std::size_t>(team().size()));
    updateObjects(first);
    updateStructures();
  }

  void updateObjects(const Frame& frame) override {
    boxes_.resize(frame.boxes.size());
    team().run(frame.boxes.size(), [&](int, Range part) {
      std::copy(frame.boxes.begin() + static_cast<std::ptrdiff_t>(part.begin),
                frame.boxes.begin() + static_cast<std::ptrdiff_t>(part.end),
                boxes_.begin() + static_cast<std::ptrdiff_t>(part.begin));
    });
  }

  void updateStructures() override {
    chooseAxes();
    sortBodies();
    gatherBoxes();
    findWindows();
  }

  void drawStructure(DebugDraw& draw) const override {
    std::array<float, 3> from{};
    for (int axis = 0; axis < 3; ++axis) from[axis] = (world_.min[axis] + world_.max[axis]) / 2;
    std::array<float, 3> to = from;
    from[axes_[0]] = world_.min[axes_[0]];
    to[axes_[0]] = world_.max[axes_[0]];
    draw.line(from, to, StructureRole::split);
    TestCounts tests(ends_.size());
    tests.addWindows(ends_);
    tests.tell(draw, [this](std::size_t i) { return bodies_[i]; });
  }

  [[nodiscard]] std::string validate() const override {
    for (std::size_t i = 0; i < ends_.size(); ++i) {
      if (i > 0 && sweeper_.min(i) < sweeper_.min(i - 1)) return "boxes not sorted";
      if (ends_[i] <= i || ends_[i] > ends_.size()) return "window out of range";
      if (sweeper_.min(ends_[i] - 1) > sweeper_.max(i)) return "window too long";
      if (ends_[i] < ends_.size() && sweeper_.min(ends_[i]) <= sweeper_.max(i)) {
        return "window too short";
      }
    }
    return {};
  }

 private:
  void findPairs() override {
    team().run([this](int worker) {
      sweeper_.sweep(ends_.data(), bodies_.data(), shares_.rowsOf(worker), pairs(worker));
    });
  }

  void chooseAxes() {
    if (boxes_.empty()) return;
    const std::array<double, 3> origin = Moments::centre(boxes_[0]);
    team().run(boxes_.size(), [&](int worker, Range part) {
      Moments moments;
      for (std::size_t i = part.begin; i < part.end; ++i) moments.add(boxes_[i], origin);
      moments_[static_cast<std::size_t>(worker)] = moments;
    });
    Moments all;
    for (const Moments& moments : moments_) all.add(moments);
    axes_ = all.axes(static_cast<double>(boxes_.size()));
  }

  void sortBodies() {
    sorter_.resize(boxes_.size(), team().size());
    team().run(boxes_.size(), [&](int, Range part) {
      const std::span<SortEntry> entries = sorter_.entries();
      for (std::size_t i = part.begin; i < part.end; ++i) {
        entries[i] = {sortKey(boxes_[i].min[axes_[0]]), static_cast<std::uint32_t>(i)};
      }
    });
    sorter_.sort(team());
  }

  void gatherBoxes() {
    sweeper_.resize(boxes_.size());
    bodies_.resize(boxes_.size());
    team().run(boxes_.size(), [&](int, Range part) {
      const std::span<const SortEntry> entries = sorter_.entries();
      for (std::size_t i = part.begin; i < part.end; ++i) {
        bodies_[i] = entries[i].body;
        sweeper_.set(i, withAxes(boxes_[entries[i].body], axes_));
      }
    });
  }

  /// Box i's window is (i, ends_[i]). Compares floats, not sort keys: -0 and +0 touch.
  void findWindows() {
    const std::size_t count = boxes_.size();
    ends_.resize(count);
    team().run(count, [&](int, Range part) {
      std::size_t end = part.begin;
      for (std::size_t i = part.begin; i < part.end; ++i) {
        const float limit = sweeper_.max(i);
        end = boundaryNear(std::max(end, i + 1), i + 1, count,
                           [&](std::size_t j) { return sweeper_.min(j) <= limit; });
        ends_[i] = static_cast<std::uint32_t>(end);
      }
    });
    shares_.measure(ends_, team());
  }

  Aabb world_;
  std::vector<Aabb> boxes_;
  std::vector<Moments> moments_;  ///< one per worker
  AxisOrder axes_ = {0, 1, 2};    ///< [0] is the sort axis
  RadixSorter sorter_;
  std::vector<std::uint32_t> bodies_;  ///< of sorted box i
  Sweeper sweeper_;                    ///< the sorted boxes, axes in the order of axes_
  std::vector<std::uint32_t> ends_;    ///< of sorted box i's window
  RowShares shares_;
};

}  // namespace

std::vector<Algorithm> variants() {
  const Algorithm family = {
      .family = "SAP",
      .traits = {.changing_worlds = ChangingWorlds::compacted},
      .description = {
          .principle = "sorting",
          .optimisations = "axis by variance, radix sort",
          .time = "O(n + w), w pairs that overlap on the sort axis",
          .space = "O(n + k)",
          .source = "Serpa and Rodrigues 2019; Baraff 1992; Cohen et al. 1995; Ericson 2005, 7.5"}};
  Algorithm plain_family = family;
  // Side by side, bodies share the sort axis with those of other worlds.
  plain_family.traits.side_by_side_below = 40;
  const auto plain = [] { return std::make_unique<SweepAndPrune<PlainSweeper>>(); };
  const auto simd = [] { return std::make_unique<SweepAndPrune<SimdSweeper>>(); };
  return {
      variantOf(plain_family, plain, "sap", "sorts along the axis of largest variance and sweeps"),
      variantOf(family, simd, "sap-simd", "sweep and prune, one box against a vector of boxes",
                {.vectorised = true}),
      variantOf(plain_family, plain, "sap-mt", "sweep and prune, on several threads",
                {.parallel = true}),
      variantOf(family, simd, "sap-simd-mt", "sweep and prune, vectorised and on several threads",
                {.parallel = true, .vectorised = true})};
}

}  // namespace broadmark::sweep_and_prune
