// Sweep and prune: the boxes sorted by their lower bound on one axis, each tested on the other two
// axes against the boxes that begin before it ends. O(n log n + w) with comparison sorts, here
// O(n + w), w the pairs that overlap on the sort axis: about n^(5/3) for evenly spread boxes.
//
// The axis of the largest variance of the box centres is chosen every frame, and everything is
// sorted from scratch, by a radix sort. (Sorting from last frame's order instead gains little: the
// sweep takes nearly all of the time.) Bodies keep their ids; only an order of ids is sorted.
//
// Papers: D. Baraff, "Dynamic Simulation of Non-Penetrating Rigid Bodies", PhD thesis, Cornell,
// 1992 (the sweep); J. D. Cohen, M. C. Lin, D. Manocha, M. K. Ponamgi, "I-COLLIDE", I3D 1995 (the
// name); C. Ericson, "Real-Time Collision Detection", 2005, 7.5 (the axis); Y. R. Serpa and M. A.
// F. Rodrigues, "Broadmark", Computer Graphics Forum, 2019 (these variants).

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "moments.h"
#include "simd/sweep_kernels.h"
#include "sorted_windows.h"
#include "test_counts.h"
#include "variants.h"
#include "work_shares.h"

namespace broadmark::sweep_and_prune {
namespace {

/// Every step is divided among the team; one thread is a team of one.
class SweepAndPrune final : public BoxBroadPhase {
 public:
  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    BoxBroadPhase::initialize(scene, first, execution);
    world_ = scene.world;
    kernels_ = &sweepKernels(execution.isa());
    moments_.resize(static_cast<std::size_t>(team().size()));
    updateStructures();
  }

  void updateStructures() override {
    chooseAxes();
    sorted_.build(
        boxes().size(), [this](std::size_t i) -> const Aabb& { return boxes()[i]; }, axes_, team());
    shares_.measureRows(sorted_.ends(), team());
  }

  void drawStructure(DebugDraw& draw) const override {
    std::array<float, 3> from{};
    for (int axis = 0; axis < 3; ++axis) from[axis] = (world_.min[axis] + world_.max[axis]) / 2;
    std::array<float, 3> to = from;
    from[axes_[0]] = world_.min[axes_[0]];
    to[axes_[0]] = world_.max[axes_[0]];
    draw.line(from, to, StructureRole::split);
    TestCounts tests(sorted_.ends().size());
    tests.addWindows(sorted_.ends());
    tests.report(draw, [this](std::size_t i) { return sorted_.bodies()[i]; });
  }

  [[nodiscard]] std::string validate() const override {
    const std::vector<std::uint32_t>& ends = sorted_.ends();
    const float* const min = sorted_.boxes().min(0);
    const float* const max = sorted_.boxes().max(0);
    for (std::size_t i = 0; i < ends.size(); ++i) {
      if (i > 0 && min[i] < min[i - 1]) return "boxes not sorted";
      if (ends[i] <= i || ends[i] > ends.size()) return "window out of range";
      if (min[ends[i] - 1] > max[i]) return "window too long";
      if (ends[i] < ends.size() && min[ends[i]] <= max[i]) return "window too short";
    }
    return {};
  }

 private:
  void findPairs() override {
    team().run([this](int worker) {
      kernels_->sweep(sorted_.boxes(), sorted_.ends().data(), sorted_.bodies().data(),
                      shares_.of(worker), pairs(worker));
    });
  }

  void chooseAxes() {
    if (boxes().empty()) return;
    const std::array<double, 3> origin = Moments::centre(boxes()[0]);
    team().run(boxes().size(), [&](int worker, Range part) {
      Moments moments;
      for (std::size_t i = part.begin; i < part.end; ++i) moments.add(boxes()[i], origin);
      moments_[static_cast<std::size_t>(worker)] = moments;
    });
    Moments all;
    for (const Moments& moments : moments_) all.add(moments);
    axes_ = all.axes(static_cast<double>(boxes().size()));
  }

  const SweepKernels* kernels_ = nullptr;
  Aabb world_;
  std::vector<Moments> moments_;  ///< one per worker
  AxisOrder axes_ = {0, 1, 2};    ///< [0] is the sort axis
  SortedWindows sorted_;
  WorkShares shares_;
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
  // Side by side, worlds overlap on the sort axis.
  plain_family.traits.side_by_side_below = 40;
  return {variantOf<SweepAndPrune>(plain_family, "sap",
                                   "sorts along the axis of largest variance and sweeps"),
          variantOf<SweepAndPrune>(family, "sap-simd",
                                   "sweep and prune, one box against a vector of boxes",
                                   {.vectorised = true}),
          variantOf<SweepAndPrune>(plain_family, "sap-mt", "sweep and prune, on several threads",
                                   {.parallel = true}),
          variantOf<SweepAndPrune>(family, "sap-simd-mt",
                                   "sweep and prune, vectorised and on several threads",
                                   {.parallel = true, .vectorised = true})};
}

}  // namespace broadmark::sweep_and_prune
