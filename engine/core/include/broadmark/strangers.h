// Bodies that never meet each other, such as those of a level that stands still.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>

#include "broadmark/collision_filter.h"

namespace broadmark {

/// Layers no two bodies of which are wanted as a pair, and which layers meet any of these.
class Strangers {
 public:
  /// None.
  Strangers() = default;
  /// Of the layers that do not meet themselves the most populous one, then each next one that meets
  /// none before it. `bodies`: those that count.
  Strangers(const CollisionFilter& filter, std::span<const std::uint32_t> bodies)
      : filter_(filter) {
    const LayerMatrix matrix = filter.matrix();
    std::array<std::size_t, LayerMatrix::kLayers> population{};
    for (const std::uint32_t body : bodies) ++population[filter.layerOf(body)];
    std::array<std::size_t, LayerMatrix::kLayers> order{};
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, std::ranges::greater{},
                             [&](std::size_t layer) { return population[layer]; });
    for (const std::size_t layer : order) {
      if (population[layer] == 0 || matrix.collide(layer, layer) || met_[layer]) continue;
      is_one_[layer] = true;
      count_ += population[layer];
      for (const std::size_t other : order) met_[other] |= matrix.collide(layer, other);
    }
  }

  /// How many of the bodies are.
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] bool contains(std::uint32_t body) const { return is_one_[filter_.layerOf(body)]; }
  /// Whether the body may be wanted as a pair with one of them.
  [[nodiscard]] bool meet(std::uint32_t body) const { return met_[filter_.layerOf(body)]; }

 private:
  CollisionFilter filter_;
  std::size_t count_ = 0;
  std::array<bool, LayerMatrix::kLayers> is_one_{};
  std::array<bool, LayerMatrix::kLayers> met_{};
};

}  // namespace broadmark
