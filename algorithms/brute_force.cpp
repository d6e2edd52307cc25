// Brute force: every box against every other. O(n²) tests, no structure: the definition of the
// answer, and the baseline for all other algorithms.
//
// The triangle of pairs i < j is divided into tiles of columns that fit in L1; all rows are tested
// against one tile before the next. Workers get bands of rows with equally many pairs.
//
// Paper: Y. R. Serpa and M. A. F. Rodrigues, "Broadmark: A Testing Framework for Broad-Phase
// Collision Detection Algorithms", Computer Graphics Forum, 2019.

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "simd/overlap_kernels.h"
#include "variants.h"

namespace broadmark::brute_force {
namespace {

/// Columns of a tile: 24 KiB of boxes.
constexpr std::size_t kTile = 1024;

/// The rows of one worker. Rows [0, r) have about n·r − r²/2 pairs: solved for a share of n²/2.
Range rowsOf(int worker, int workers, std::size_t count) {
  const auto first_row = [&](int k) {
    if (k == workers) return count;
    const double done = static_cast<double>(k) / workers;
    return static_cast<std::size_t>(static_cast<double>(count) * (1 - std::sqrt(1 - done)));
  };
  return {first_row(worker), first_row(worker + 1)};
}

class BruteForce final : public SimdBroadPhase {
 public:
  void initialize(const SceneInfo& scene, const Frame& first,
                  ExecutionContext& execution) override {
    SimdBroadPhase::initialize(scene, first, execution);
    kernels_ = &overlapKernels(execution.isa());
  }

  /// Every body was tested against every other.
  void drawStructure(DebugDraw& draw) const override {
    const auto bodies = static_cast<std::uint32_t>(arrays().size());
    for (std::uint32_t body = 0; body < bodies; ++body) draw.tests(body, bodies - 1);
  }

 private:
  void findPairs() override {
    team().run([this](int worker) {
      const std::size_t count = arrays().size();
      const Range rows = rowsOf(worker, team().size(), count);
      for (std::size_t begin = rows.begin; begin < count; begin += kTile) {
        const std::size_t end = std::min(begin + kTile, count);
        kernels_->test_tile(arrays(), {rows.begin, std::min(rows.end, end)}, {begin, end},
                            pairs(worker));
      }
    });
  }

  void findHits(const QueryBatch& batch) override {
    team().run(batch.queries.size(), [&](int worker, Range range) {
      for (std::size_t i = range.begin; i < range.end; ++i) {
        const auto index = static_cast<std::uint32_t>(i);
        if (batch.kind == AnswerKind::nearest) {
          findNearest(index, batch.queries[i], pairs(worker));
          continue;
        }
        for (std::uint32_t body = 0; body < arrays().size(); ++body) {
          if (hits(batch.kind, batch.queries[i], arrays().box(body))) {
            pairs(worker).addHit(index, body);
          }
        }
      }
    });
  }

  void findNearest(std::uint32_t index, const Query& query, PairBuffer& found) const {
    std::vector<std::pair<double, std::uint32_t>> distances;
    for (std::uint32_t body = 0; body < arrays().size(); ++body) {
      const Aabb box = arrays().box(body);
      if (!isEmpty(box)) distances.emplace_back(distanceTo(query, box), body);
    }
    const std::size_t count = std::min(kNearestBodies, distances.size());
    std::ranges::partial_sort(distances, distances.begin() + static_cast<std::ptrdiff_t>(count));
    for (std::size_t k = 0; k < count; ++k) found.addHit(index, distances[k].second);
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
  Algorithm scalar = variantOf<BruteForce>(family, "bf", "tests every box against every other");
  Algorithm threads =
      variantOf<BruteForce>(family, "bf-mt", "brute force, on several threads", {.parallel = true});
  scalar.traits.queries = threads.traits.queries = {AnswerKind::boxes, AnswerKind::rays,
                                                    AnswerKind::sweeps, AnswerKind::nearest};
  return {
      scalar,
      variantOf<BruteForce>(family, "bf-simd", "brute force, one box against a vector of boxes",
                            {.vectorised = true}),
      threads,
      variantOf<BruteForce>(family, "bf-simd-mt", "brute force, vectorised and on several threads",
                            {.parallel = true, .vectorised = true})};
}

}  // namespace broadmark::brute_force
