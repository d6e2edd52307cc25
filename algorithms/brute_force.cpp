// Brute force: every box against every other. O(n²) tests, no structure: the definition of the
// answer, and what every other algorithm has to beat.
//
// The triangle of pairs i < j is cut into tiles of columns that fit the first-level cache; all rows
// pass over one tile before the next is begun. Workers get bands of rows with equally many pairs.
//
// Paper: Y. R. Serpa and M. A. F. Rodrigues, "Broadmark: A Testing Framework for Broad-Phase
// Collision Detection Algorithms", Computer Graphics Forum, 2019.

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "axis_overlap.h"
#include "simd/overlap_kernels.h"
#include "variants.h"

namespace broadmark::brute_force {
namespace {

/// Columns of a tile: 24 or 32 KiB of boxes.
constexpr std::size_t kTile = 1024;

/// The rows of one worker. Rows [0, r) hold n·r − r²/2 pairs or so: solved for a share of n²/2.
Range rowsOf(int worker, int workers, std::size_t count) {
  const auto first_row = [&](int k) {
    if (k == workers) return count;
    const double done = static_cast<double>(k) / workers;
    return static_cast<std::size_t>(static_cast<double>(count) * (1 - std::sqrt(1 - done)));
  };
  return {first_row(worker), first_row(worker + 1)};
}

/// Calls test(rows, columns) for all tiles of the worker's part of the triangle.
template <class Test>
void forEachTile(int worker, int workers, std::size_t count, Test test) {
  const Range rows = rowsOf(worker, workers, count);
  for (std::size_t begin = rows.begin; begin < count; begin += kTile) {
    const std::size_t end = std::min(begin + kTile, count);
    test(Range{rows.begin, std::min(rows.end, end)}, Range{begin, end});
  }
}

/// Every body was tested against every other.
void tellTests(std::size_t bodies, DebugDraw& draw) {
  for (std::uint32_t body = 0; body < bodies; ++body) {
    draw.tests(body, static_cast<std::uint32_t>(bodies - 1));
  }
}

class Plain final : public BoxBroadPhase {
 public:
  void drawStructure(DebugDraw& draw) const override { tellTests(boxes().size(), draw); }

 private:
  void findPairs() override {
    team().run([this](int worker) {
      forEachTile(worker, team().size(), boxes().size(),
                  [&](Range rows, Range columns) { testTile(rows, columns, pairs(worker)); });
    });
  }

  void testTile(Range rows, Range columns, PairBuffer& found) const {
    const Aabb* const first = boxes().data();
    const Aabb* const end = first + columns.end;
    for (std::size_t i = rows.begin; i < rows.end; ++i) {
      const Aabb row = first[i];
      for (const Aabb* j = first + std::max(columns.begin, i + 1); j < end; ++j) {
        // One axis rules most pairs out, so this branch is predicted well; the others wait.
        if (overlapsOnAxis(row, *j, 0)) [[unlikely]] {
          if (overlapsOnAxis(row, *j, 1) && overlapsOnAxis(row, *j, 2)) {
            found.add(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j - first));
          }
        }
      }
    }
  }
};

class Simd final : public SimdBroadPhase {
 public:
  void initialize(const SceneInfo& scene, const Frame& first, Execution& execution) override {
    SimdBroadPhase::initialize(scene, first, execution);
    kernels_ = &overlapKernels(execution.isa());
  }

  void drawStructure(DebugDraw& draw) const override { tellTests(arrays().size(), draw); }

 private:
  void findPairs() override {
    team().run([this](int worker) {
      forEachTile(worker, team().size(), arrays().size(), [&](Range rows, Range columns) {
        kernels_->test_tile(arrays(), rows, columns, pairs(worker));
      });
    });
  }

  const OverlapKernels* kernels_ = nullptr;
};

}  // namespace

std::vector<Algorithm> variants() {
  const Algorithm family = {
      .family = "BF",
      .traits = {.changing_worlds = ChangingWorlds::compacted, .instance_per_world = true},
      .description = {
          .principle = "brute force",
          .time = "O(n²)",
          .space = "O(n + k)",
          .source = "Serpa and Rodrigues 2019; Ericson 2005, Real-Time Collision Detection, 7"}};
  const auto plain = [] { return std::make_unique<Plain>(); };
  const auto simd = [] { return std::make_unique<Simd>(); };
  return {variantOf(family, plain, "bf", "tests every box against every other"),
          variantOf(family, simd, "bf-simd", "brute force, one box against a vector of boxes",
                    {.vectorised = true}),
          variantOf(family, plain, "bf-mt", "brute force, on several threads", {.parallel = true}),
          variantOf(family, simd, "bf-simd-mt", "brute force, vectorised and on several threads",
                    {.parallel = true, .vectorised = true})};
}

}  // namespace broadmark::brute_force
