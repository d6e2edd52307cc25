// Predicts the cost of frames from counts of operations: when a full search is cheaper than the
// grid, and when a rebuild of the grid pays. Nothing is timed, so decisions are deterministic.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "columns.h"
#include "sample.h"
#include "tide/loose_grid.h"

namespace broadmark::tide {

/// In nanoseconds, fitted to the measurements in docs/columns-and-tide.md. Only ratios matter.
struct Costs {
  // In the grid.
  double build = 100;  ///< per body
  double move = 35;    ///< per moving body, plus its cell queries and tests
  double cell_query = 36;
  double test = 13;
  double change = 0;  ///< per pair inserted into or erased from the pair set
  // In a full search.
  double body = 12;
  double pair = 22;
  double layout = 3000;
  double sampled = 17;      ///< per body of the sample
  double pair_test = 0.11;  ///< in brute force, instead of layout and sample
  double compaction = 15;   ///< per body of a changing world
  // With candidate pairs.
  double fat_box = 6;    ///< per body, of new candidates
  double check = 2;      ///< per moving body
  double candidate = 3;  ///< per candidate
  double candidates_frame = 1000;
};
/// The costs of a full search are 0.88 times those fitted: on other processors it is cheaper, in
/// relation to moves (docs/columns-and-tide.md).
inline constexpr Costs kEventCosts = {.body = 10.5, .pair = 19.5};
inline constexpr Costs kPairCosts = {.change = 80, .pair = 5};

class CostModel {
 public:
  /// The mean cost of a move is trusted from this number of moves on.
  static constexpr std::size_t kCalibrationMoves = 256;
  static constexpr std::size_t kCalibrationBatches = 8;

  CostModel() = default;
  CostModel(const Costs& costs, double full_search_scale, std::size_t bodies,
            bool is_changing_world = false, double candidates_scale = 1)
      : costs_(costs),
        full_search_scale_(full_search_scale),
        candidates_scale_(candidates_scale),
        bodies_(bodies) {
    if (is_changing_world) costs_.body += costs_.compaction;
  }

  /// To be called in each frame.
  void setPairs(std::uint64_t pairs) { pairs_ = static_cast<double>(pairs); }
  [[nodiscard]] double pairs() const { return pairs_; }

  [[nodiscard]] bool fullSearchIsCheaper(std::size_t moves) const {
    return gridCost(moves) > fullSearchCost();
  }

  /// To be called after a full search, or another frame without the grid at this cost; `moves`
  /// bodies moved. Whether a grid pays: since the last one, frames have cost as much more than in
  /// the grid as it takes to build one.
  bool gridPays(std::size_t moves) { return gridPays(moves, fullSearchCost()); }
  bool gridPays(std::size_t moves, double cost) {
    move_cost_ = std::lerp(move_cost_, costs_.move + costs_.cell_query, kDecayRate);
    regret_ = std::max(0.0, regret_ + cost - gridCost(moves));
    return regret_ >= buildCost() + costs_.change * pairs_;
  }

  [[nodiscard]] double fullSearchCost() const { return searchCost(costs_.body, costs_.pair); }
  /// The cost of a frame whose moves stay within their fat boxes.
  [[nodiscard]] double candidatesCost(std::size_t moves, double candidates) const {
    return candidates_scale_ *
           (costs_.candidates_frame + costs_.check * static_cast<double>(moves) +
            costs_.candidate * candidates);
  }
  /// Whether this number of candidates, serving `frames` frames, is clearly cheaper than both the
  /// grid and full searches.
  [[nodiscard]] bool candidatesPay(std::size_t moves, double candidates, double frames) const {
    constexpr double kClearly = 0.8;
    const double in_grid = kClearly * gridCost(moves);
    const double cost = candidatesCost(moves, candidates);
    if (cost >= in_grid) return false;  // mostly
    const double search = searchCost(kPairCosts.body, kPairCosts.pair) +
                          costs_.fat_box * static_cast<double>(bodies_);
    return cost + candidates_scale_ * search / frames <
           std::min(in_grid, kClearly * fullSearchCost());
  }

  /// Starts over with a new grid, in which each calibration batch of `moves` moves took this work.
  void calibrate(std::array<WorkCounts, kCalibrationBatches> batches, std::size_t moves) {
    usual_cost_ = excess_ = regret_ = 0;
    // If all bodies moved, about as many pairs would begin or end as there are.
    const double share = static_cast<double>(moves) / std::max(1.0, static_cast<double>(bodies_));
    std::array<double, kCalibrationBatches> costs{};
    std::ranges::transform(batches, costs.begin(), [&](const WorkCounts& work) {
      return moveCost(work, share * pairs_, moves);
    });
    // Median, so one very large body does not dominate.
    std::ranges::nth_element(costs, costs.begin() + kCalibrationBatches / 2);
    move_cost_ = costs[kCalibrationBatches / 2];
  }
  /// To be called after a frame in the grid with at least one move. Whether a rebuild pays: bodies
  /// crowd in too few cells, and the excess cost of their moves has reached the cost of a build.
  bool rebuildPays(const WorkCounts& work, std::size_t changes, std::size_t moves) {
    constexpr double kMinUsualCost = 170;  // a rebuild does not get below
    const double cost = moveCost(work, static_cast<double>(changes), moves);
    if (moves >= kCalibrationMoves) move_cost_ = std::lerp(move_cost_, cost, kLearningRate);
    if (usual_cost_ == 0) usual_cost_ = 2 * std::max(cost, kMinUsualCost);
    excess_ += static_cast<double>(moves) * std::max(0.0, cost - usual_cost_);
    return excess_ >= buildCost();
  }

 private:
  /// Low enough that a single move of a very large body has no effect.
  static constexpr double kLearningRate = 1.0 / 8;
  /// Full searches do not measure moves: their estimate decays, so that a grid is tried again. If
  /// moves are as expensive as before, that build is wasted, but rarely.
  static constexpr double kDecayRate = 1.0 / 256;

  [[nodiscard]] double gridCost(std::size_t moves) const {
    return move_cost_ * static_cast<double>(moves);
  }
  [[nodiscard]] double searchCost(double per_body, double per_pair) const {
    const auto bodies = static_cast<double>(bodies_);
    const double layout =
        bodies_ <= columns::kMaxBruteForce
            ? costs_.pair_test * bodies * bodies / 2
            : costs_.layout + costs_.sampled * static_cast<double>(sampleSize(bodies_));
    return full_search_scale_ * (layout + per_body * bodies + per_pair * pairs_);
  }
  [[nodiscard]] double buildCost() const { return costs_.build * static_cast<double>(bodies_); }
  /// Mean cost of a move.
  [[nodiscard]] double moveCost(const WorkCounts& work, double changes, std::size_t moves) const {
    const double sum = costs_.cell_query * static_cast<double>(work.cell_queries) +
                       costs_.test * static_cast<double>(work.tests) + costs_.change * changes;
    return costs_.move + sum / static_cast<double>(std::max<std::size_t>(moves, 1));
  }

  Costs costs_;
  double full_search_scale_ = 1;
  double candidates_scale_ = 1;
  std::size_t bodies_ = 0;
  double pairs_ = 0;
  double move_cost_ = 0;   ///< estimate
  double regret_ = 0;      ///< cost of full searches beyond that of the grid
  double usual_cost_ = 0;  ///< twice the cost of a move in the grid's first frame; 0: not set
  double excess_ = 0;      ///< cost of moves beyond the usual cost
};

}  // namespace broadmark::tide
