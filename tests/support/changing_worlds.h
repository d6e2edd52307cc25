// Test worlds with bodies that appear and vanish, and with collision filters.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "broadmark/collision_filter.h"
#include "broadmark/frame.h"
#include "torture/changing.h"
#include "torture/given_frames.h"
#include "torture/inputs.h"

namespace broadmark::tests {

using inputs::filterOf;
using inputs::filters;
using inputs::NamedFilter;
using inputs::Presence;
namespace presences = inputs::presences;

/// A named sequence of frames and the filter of its pairs.
struct ChangingWorld {
  std::string name;
  CollisionFilter filter;
  std::vector<std::vector<Aabb>> frames;
  std::optional<Aabb> bounds = {};  ///< world bounds of the scene; by default of all boxes
  std::vector<CollisionFilter> filters = {};  ///< of each frame, if they change
  PeriodicBox periodic = {};

  [[nodiscard]] const CollisionFilter& filterOf(std::size_t frame) const {
    return filters.empty() ? filter : filters[frame];
  }
};

/// The frames of an input; absent bodies have empty boxes.
inline std::vector<std::vector<Aabb>> framesWith(const inputs::Input& input, std::size_t n,
                                                 std::uint32_t count, const Presence& present) {
  std::vector<std::vector<Aabb>> frames;
  for (std::uint32_t frame = 0; frame < count; ++frame) {
    frames.push_back(input.boxes(n, frame, 1 + n));
    for (std::uint32_t body = 0; body < n; ++body) {
      if (!present(body, frame)) frames.back()[body] = kEmptyBox;
    }
  }
  return frames;
}

/// A scene of given frames, with the filter of each if they change.
inline FrameList listed(SceneInfo scene, std::vector<std::vector<Aabb>> frames,
                        std::vector<CollisionFilter> filters = {}) {
  inputs::GivenFrames given(std::move(scene), std::move(frames), std::move(filters));
  return FrameList(given);
}

/// The frames of a scene; absent bodies have empty boxes.
inline FrameList changing(FrameSource& source, const Presence& present,
                          const CollisionFilter& filter = {}) {
  SceneInfo scene = source.scene();
  scene.all_present = false;
  scene.filter = filter;
  std::vector<std::vector<Aabb>> frames;
  for (std::optional<Frame> frame = source.rewind(); frame; frame = source.next()) {
    frames.emplace_back(frame->boxes.begin(), frame->boxes.end());
    for (std::uint32_t body = 0; body < scene.objects; ++body) {
      if (!present(body, frame->index)) frames.back()[body] = kEmptyBox;
    }
  }
  return listed(std::move(scene), std::move(frames));
}

}  // namespace broadmark::tests
