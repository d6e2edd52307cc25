// What frames cost, by what is counted in them: when it is quicker to find all pairs anew, and when
// a new grid pays. Nothing is timed, so that the same frames always lead to the same decisions.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "sample.h"
#include "tide/loose_grid.h"

namespace broadmark::tide {

/// Costs in nanoseconds on the machine of docs/columns-and-tide.md ("When `tide` falls back to a
/// full search"). Only their ratios matter.
struct Costs {
  // In the grid.
  double build = 100;  ///< for each body there is
  double move = 35;    ///< for each body that moves, and for each of its looks and tests
  double look = 36;
  double test = 13;
  double change = 0;  ///< of the set of pairs, for each that begins or ends
  // From scratch.
  double sampled = 17;  ///< for each body of a sample
  double body = 12;
  double pair = 22;
};
inline constexpr Costs kCostsOfEvents;
inline constexpr Costs kCostsOfPairs = {.change = 80, .pair = 5};

/// Of a world, frame by frame.
class CostModel {
 public:
  /// So many moves tell what one costs.
  static constexpr std::size_t kEnoughMoves = 256;
  static constexpr std::size_t kTries = 8;

  CostModel() = default;
  /// The factor is for what is found from scratch.
  CostModel(const Costs& costs, double factor, std::size_t bodies)
      : costs_(costs), factor_(factor), bodies_(bodies) {}

  /// To be told in each frame.
  void setPairs(std::uint64_t pairs) { pairs_ = static_cast<double>(pairs); }

  /// Whether finding all pairs anew promises to be quicker than to move so many bodies.
  [[nodiscard]] bool scratchIsQuicker(std::size_t moves) const {
    return costOf(moves) > costFromScratch();
  }

  /// A frame was found from scratch in which so many bodies moved. Whether a grid would have paid
  /// by now.
  bool gridPays(std::size_t moves) {
    move_ = std::lerp(move_, costs_.move + costs_.look, kForgotten);
    wasted_ = std::max(0.0, wasted_ + costFromScratch() - costOf(moves));
    return wasted_ >= costOfGrid() + costs_.change * pairs_;
  }

  /// There is a new grid, and this is what so many moves took in it, in each of some tries.
  void setGrid(std::array<Work, kTries> tries, std::size_t moves) {
    usual_ = excess_ = wasted_ = 0;
    // If all moved, about as many pairs would begin or end as there are.
    const double share = static_cast<double>(moves) / std::max(1.0, static_cast<double>(bodies_));
    std::array<double, kTries> costs{};
    std::ranges::transform(tries, costs.begin(), [&](const Work& work) {
      return costOfMove(work, share * pairs_, moves);
    });
    // Not the mean: a single giant may meet everybody.
    std::ranges::nth_element(costs, costs.begin() + kTries / 2);
    move_ = costs[kTries / 2];
  }
  /// A frame in the grid in which so many pairs began or ended, and so many bodies moved: some.
  /// Whether another grid would have paid by now, since bodies crowd where it has too few cells for
  /// them: then moves beyond the usual cost have come to as much as it takes.
  bool anotherGridPays(const Work& work, std::size_t changes, std::size_t moves) {
    constexpr double kLeast = 170;  // never worth it
    const double move = costOfMove(work, static_cast<double>(changes), moves);
    if (moves >= kEnoughMoves) move_ = std::lerp(move_, move, kLearnt);
    if (usual_ == 0) usual_ = 2 * std::max(move, kLeast);
    excess_ += static_cast<double>(moves) * std::max(0.0, move - usual_);
    return excess_ >= costOfGrid();
  }

 private:
  /// A giant that moves once makes no difference.
  static constexpr double kLearnt = 1.0 / 8;
  /// Nobody tells from scratch what moves would cost by now. If they are as dear as they were, a
  /// grid is built in vain, but seldom.
  static constexpr double kForgotten = 1.0 / 256;

  [[nodiscard]] double costOf(std::size_t moves) const {
    return move_ * static_cast<double>(moves);
  }
  [[nodiscard]] double costFromScratch() const {
    return factor_ * (costs_.sampled * static_cast<double>(sampleSize(bodies_)) +
                      costs_.body * static_cast<double>(bodies_) + costs_.pair * pairs_);
  }
  [[nodiscard]] double costOfGrid() const { return costs_.build * static_cast<double>(bodies_); }
  /// On average.
  [[nodiscard]] double costOfMove(const Work& work, double changes, std::size_t moves) const {
    const double sum = costs_.look * static_cast<double>(work.looks) +
                       costs_.test * static_cast<double>(work.tests) + costs_.change * changes;
    return costs_.move + sum / static_cast<double>(std::max<std::size_t>(moves, 1));
  }

  Costs costs_;
  double factor_ = 1;
  std::size_t bodies_ = 0;
  double pairs_ = 0;
  double move_ = 0;    ///< what one is expected to take
  double wasted_ = 0;  ///< by finding all pairs anew, since there was a grid
  double usual_ = 0;   ///< for a move, twice that in the grid's first frame; 0: not known yet
  double excess_ = 0;  ///< of moves beyond that
};

}  // namespace broadmark::tide
