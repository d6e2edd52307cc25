// Sets of layers that never collide with each other, such as those of static geometry.
//
// Example:
//
//   std::vector<BodyGroups> groups(1000);  // of static geometry
//   groups[0].layer = 1;                   // a player
//   const CollisionFilter filter(groups, LayerMatrix().set(0, 1));
//   const std::vector<std::uint32_t> present = {0, 1, 2};
//   const NonCollidingLayers layers(filter, present);
//   const bool is_static = layers.contains(filter.layerOf(2));  // layer 0: 2 of these bodies
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "broadmark/collision_filter.h"

namespace broadmark {

/// A set of layers that collide neither with themselves nor with each other: pairs of their bodies
/// are never wanted, so no algorithm need look for them. By default empty. Copyable; does not refer
/// to the filter.
class NonCollidingLayers {
 public:
  NonCollidingLayers() = default;
  /// Greedy: adds layers in descending order of population. Counts only `bodies`, by id; without
  /// any of them a layer is not added. O(bodies).
  NonCollidingLayers(const CollisionFilter& filter, std::span<const std::uint32_t> bodies) {
    const LayerMatrix matrix = filter.matrix();
    std::array<std::size_t, LayerMatrix::kLayers> population{};
    for (const std::uint32_t body : bodies) ++population[filter.layerOf(body)];
    while (true) {
      const auto fullest = std::ranges::max_element(population);
      const std::size_t members = std::exchange(*fullest, 0);
      if (members == 0) return;
      const auto layer = static_cast<std::size_t>(fullest - population.begin());
      if (matrix.collide(layer, layer) || collides_[layer]) continue;
      members_[layer] = true;
      body_count_ += members;
      for (std::size_t other = 0; other < collides_.size(); ++other) {
        collides_[other] |= matrix.collide(layer, other);
      }
    }
  }

  /// How many of `bodies` are in these layers.
  [[nodiscard]] std::size_t bodyCount() const { return body_count_; }
  /// Whether the layer, below LayerMatrix::kLayers, is one of the set.
  [[nodiscard]] bool contains(std::size_t layer) const { return members_[layer]; }
  /// Whether any layer of the set collides with this one, which is then not in the set.
  [[nodiscard]] bool collideWith(std::size_t layer) const { return collides_[layer]; }

 private:
  std::size_t body_count_ = 0;
  std::array<bool, LayerMatrix::kLayers> members_{};
  std::array<bool, LayerMatrix::kLayers> collides_{};
};

}  // namespace broadmark
