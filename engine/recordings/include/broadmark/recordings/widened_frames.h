// Boxes grown on every side, for pairs that are closer than a distance.
#pragma once

#include <memory>
#include <string_view>

#include "broadmark/frame.h"

namespace broadmark {

/// The smallest box of floats around `box` grown by half of `distance` on every side; kEmptyBox if
/// absent. Bounds beyond the largest float are the largest float, which changes no pair. Two such
/// boxes overlap if the gap between the original ones is at most `distance` on every axis; beyond
/// it only if the gap is larger by no more than the rounding of the bounds. `distance` >= 0.
Aabb widenedBox(const Aabb& box, double distance);

/// The largest distance: far beyond any world, and far from overflow.
inline constexpr double kMaxWidening = 1e30;

/// Suffix of the name of a scene with widened boxes.
inline constexpr std::string_view kWidenedSuffix = " widened";
/// The scene with widened boxes: "FreeFall widened", with its world widened alike.
SceneInfo widenedScene(SceneInfo, double distance);

/// A source with widened boxes.
std::unique_ptr<IndexedFrames> widened(std::unique_ptr<IndexedFrames> frames, double distance);

}  // namespace broadmark
