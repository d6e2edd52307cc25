// What a scene is like: how dense, how crowded, how much of it moves, comes and goes, how large its
// bodies are, which of them collide at all. These decide which broad phase suits it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "broadmark/frame.h"
#include "broadmark/recordings/recording.h"

namespace broadmark {

/// What is not as in the frame before, in bodies.
struct Changes {
  double appeared = 0;
  double vanished = 0;
  double changed = 0;  ///< these two, and those that moved
};

/// Of frames of the same scene.
Changes changesBetween(std::span<const Aabb> before, std::span<const Aabb> boxes);

/// Figures of one frame, of the bodies that are present. The extent of a body is the longest edge
/// of its box. With no bodies, all are 0.
struct FrameStatistics {
  std::uint32_t frame = 0;
  std::uint32_t bodies = 0;
  double density = 0;  ///< sum of all boxes' volumes / volume of the world (0 if that is 0)
  double pairs_per_body = 0;
  std::optional<Changes> changes;  ///< frame 0 has none before
  /// Of the bodies that were there in the frame before, too: the share of those whose box differs.
  /// Nothing if there are none.
  std::optional<double> moving_share;
  std::uint64_t outside = 0;  ///< bodies whose centre is outside the world
  double min_extent = 0;
  double median_extent = 0;
  double max_extent = 0;
};

/// Of a frame with that many pairs, `before` being the boxes of the frame before it (as many; or
/// none).
FrameStatistics frameStatistics(const SceneInfo&, const Frame& frame, std::span<const Aabb> before,
                                std::size_t pairs);

/// Figures of successive frames together: means over the frames, unless stated otherwise.
struct RangeStatistics {
  std::uint32_t first = 0;
  std::uint32_t last = 0;  ///< inclusive
  std::uint32_t min_bodies = 0;
  double mean_bodies = 0;
  std::uint32_t max_bodies = 0;
  double density = 0;
  double pairs_per_body = 0;
  std::optional<Changes> changes;      ///< of the frames that have them
  std::optional<double> moving_share;  ///< of the frames that have one
  std::uint64_t max_outside = 0;       ///< most bodies outside in one frame
  double min_extent = 0;               ///< of all frames
  double median_extent = 0;            ///< the median of the frames' medians
  double max_extent = 0;               ///< of all frames

  /// Extent of the largest body divided by that of the smallest; nothing if the latter is 0.
  [[nodiscard]] std::optional<double> sizeRatio() const;
};

/// Of at least one frame.
RangeStatistics rangeStatistics(std::span<const FrameStatistics> frames);

/// What a collision filter makes of the bodies.
struct FilterStatistics {
  struct Layer {
    std::size_t layer = 0;
    double bodies = 0;  ///< present; mean per frame
  };
  /// Two layers that collide, or one that collides with itself.
  struct LayerPair {
    std::size_t a = 0;
    std::size_t b = 0;  ///< >= a
    double pairs = 0;   ///< mean per frame
  };
  std::vector<Layer> layers;           ///< those that any body is in
  std::vector<LayerPair> layer_pairs;  ///< of these layers all that collide
  std::uint32_t worlds = 1;
  std::uint32_t largest_world = 0;  ///< its number of bodies, present or not
  std::uint32_t tagged = 0;         ///< bodies with tags
};

/// A whole scene.
struct SceneDescription {
  RangeStatistics initial;  ///< frame 0
  /// Frames 1…F in successive parts whose lengths differ by 1 at most; none if F = 0.
  std::vector<RangeStatistics> parts;
  std::optional<RangeStatistics> overall;  ///< frames 1…F
  /// Of frames 1…F, or of frame 0 if there is no other; nothing where every pair is wanted.
  std::optional<FilterStatistics> filter = {};
};

/// Goes through all frames, with the memory of two of them. Frames 1…F are shown in `parts` parts,
/// or one for each frame if there are fewer. Nothing if `progress` stopped it.
std::optional<SceneDescription> describe(FrameSource&, int parts = 10,
                                         const FrameProgress& progress = {});

/// A description with what it describes.
struct DescribedRecording {
  std::string path;
  std::string hash;
  SceneInfo scene;
  SceneDescription description;
};

/// As JSON ("schema": "broadmark-descriptions/1"). What comes and goes, and the filter, are told
/// only of scenes that have them.
std::string formatDescriptions(std::span<const DescribedRecording>);

}  // namespace broadmark
