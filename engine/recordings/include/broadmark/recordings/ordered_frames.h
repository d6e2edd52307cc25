// Frames with their bodies numbered in another order: the order of ids decides how far apart
// neighbours are in memory.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "broadmark/recordings/adapted_frames.h"

namespace broadmark {

enum class BodyOrder {
  random,  ///< the same for every source with as many bodies
  morton   ///< along a Morton curve through the centres in the initial pose; absent bodies last
};

/// Suffix of the name of a scene with another order.
inline constexpr std::string_view kOrderedSuffix = " reordered";
/// The scene with another name; its filter depends on the order.
SceneInfo orderedScene(SceneInfo);

/// A source's frames and collision filters, with other ids.
class OrderedFrames final : public AdaptedFrames {
 public:
  OrderedFrames(std::unique_ptr<IndexedFrames> frames, BodyOrder order);

 private:
  std::span<const Aabb> readBoxes(std::uint32_t index) override;
  /// The new ids of these bodies, ascending.
  void rename(std::span<const std::uint32_t> bodies, std::vector<std::uint32_t>& ids) const;

  std::vector<std::uint32_t> source_ids_;  ///< by new id
  std::vector<std::uint32_t> new_ids_;     ///< by the source's id
  // If filters change.
  CollisionFilter ordered_filter_;
  std::vector<std::uint32_t> ordered_filter_changes_;
};

}  // namespace broadmark
